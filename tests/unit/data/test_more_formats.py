"""Further formats: files that other libraries write give the numbers that were written."""

import json
from datetime import datetime, timedelta
from zipfile import ZipFile

import h5py
import numpy as np
import pytest
from scipy.io import savemat

from dalembert.data import opening, read
from dalembert.data.known_formats import known_formats
from dalembert.data.preview import preview
from dalembert.errors import DataError

TIMES = np.arange(8) * 0.125
ANGLE = np.array([0.5, -1.25, 2.0, 3.5, -4.0, 5.75, 6.0, 7.5])
RATE = 2 * ANGLE - 1


def _xlsx(path):
    import openpyxl

    book = openpyxl.Workbook()
    book.active.append(["A report about the rig"])
    sheet = book.create_sheet("run")
    sheet.append(["rig 7"])
    sheet.append(["t", "angle", "rate"])
    sheet.append(["s", "deg", "deg/s"])
    for row in zip(TIMES.tolist(), ANGLE.tolist(), RATE.tolist(), strict=True):
        sheet.append(list(row))
    book.save(path)


def _tdms(path):
    from nptdms import ChannelObject, TdmsWriter

    wave = {"wf_increment": 0.125, "wf_start_offset": 0.0}
    with TdmsWriter(path) as writer:
        writer.write_segment(
            [
                ChannelObject("run", "angle", ANGLE, properties={**wave, "unit_string": "deg"}),
                ChannelObject("run", "rate", RATE, properties={**wave, "unit_string": "deg/s"}),
            ]
        )


def _mdf(path):
    from asammdf import MDF, Signal

    with MDF(version="4.10") as file:
        file.append([Signal(ANGLE, TIMES, unit="deg", name="angle"), Signal(RATE, TIMES, unit="deg/s", name="rate")])
        file.save(path, overwrite=True)


def _mcap(path, encoding="json"):
    from mcap.writer import Writer

    with path.open("wb") as stream:
        writer = Writer(stream)
        writer.start()
        schema = writer.register_schema(name="joint", encoding="jsonschema", data=b"{}")
        channel = writer.register_channel(topic="/joint", message_encoding=encoding, schema_id=schema)
        for t, a, r in zip(TIMES.tolist(), ANGLE.tolist(), RATE.tolist(), strict=True):
            message = json.dumps({"t": t, "angle": a, "rate": r, "name": "elbow"}).encode()
            stamp = 10**18 + round(1e9 * t)
            writer.add_message(channel_id=channel, log_time=stamp, publish_time=stamp, data=message)
        writer.finish()


def _lvm(path):
    head = "LabVIEW Measurement\t\nWriter_Version\t2\nSeparator\tTab\nX_Columns\tOne\n***End_of_Header***\t\n\t\n"
    names = "X_Value\tangle\trate\tComment"
    segment = (
        "Channels\t2\t\t\nSamples\t4\t4\t\nX0\t0.0\t0.0\t\nDelta_X\t0.125\t0.125\t\n***End_of_Header***\t\t\t\n" + names
    )
    rows = [f"{t!r}\t{a!r}\t{r!r}\t" for t, a, r in zip(TIMES.tolist(), ANGLE.tolist(), RATE.tolist(), strict=True)]
    rows[1] += "the motor was switched on"
    path.write_text(head + "\n".join([segment, *rows[:4], segment, *rows[4:]]) + "\n")


def _h5(path):
    with h5py.File(path, "w") as file:
        file["t"], file["angle"], file["rate"] = TIMES, ANGLE, RATE
        file["angle"].attrs["units"], file["rate"].attrs["unit"] = "deg", "deg/s"
        file["title"] = "rig 7"


def _zip(path):
    rows = zip(TIMES.tolist(), ANGLE.tolist(), RATE.tolist(), strict=True)
    lines = [f"{t!r};{a!r};{r!r}" for t, a, r in rows]
    with ZipFile(path, "w") as archive:
        archive.writestr("run/data.csv", "\n".join(["t;angle [deg];rate [deg/s]", *lines]))
        archive.writestr("run/README.md", "rig 7")


FILES = {
    "run.xlsx": (_xlsx, "t", "angle", "rate", True),
    "run.tdms": (_tdms, "t", "angle", "rate", True),
    "run.mf4": (_mdf, "t", "angle", "rate", True),
    "run.mcap": (_mcap, "t", "angle", "rate", False),
    "run.lvm": (_lvm, "X_Value", "angle", "rate", False),
    "run.h5": (_h5, "t", "angle", "rate", True),
    "run.npz": (lambda path: np.savez(path, t=TIMES, angle=ANGLE, rate=RATE), "t", "angle", "rate", False),
    "run.zip": (_zip, "t", "angle [deg]", "rate [deg/s]", True),
}


SLOW_MDF = [pytest.param(name, marks=[pytest.mark.slow] * (name == "run.mf4")) for name in FILES]
"""asammdf takes seconds to import."""


@pytest.fixture
def case(request, tmp_path):
    write, *names, has_units = FILES[request.param]
    write(tmp_path / request.param)
    return tmp_path / request.param, names, has_units


@pytest.mark.parametrize("case", FILES, indirect=True)
def test_a_file_gives_the_numbers_that_were_written(case):
    path, (time, angle, rate), has_units = case
    units = None if has_units else {angle: "deg", rate: "deg/s"}
    data = read(path, time, {"bar.rate": rate, "bar.angle": angle}, units=units)
    np.testing.assert_allclose(data.coordinate.values, TIMES, rtol=0, atol=1e-12)
    np.testing.assert_allclose(data.values, np.deg2rad(np.stack([RATE, ANGLE], axis=1)), rtol=1e-14)
    assert data.source_units == {"bar.rate": "deg/s", "bar.angle": "deg"} | (
        {"time": "s"} if "time" in data.source_units else {}
    )


@pytest.mark.parametrize("case", SLOW_MDF, indirect=True)
def test_a_file_is_previewed_for_the_studio(case):
    path, (time, angle, _), has_units = case
    found = preview(path)
    np.testing.assert_allclose(found.column(time).values, TIMES, rtol=0, atol=1e-12)
    np.testing.assert_allclose(found.column(angle).values, ANGLE)
    assert found.column(angle).unit == ("deg" if has_units else "")


@pytest.mark.parametrize("case", SLOW_MDF, indirect=True)
def test_an_unknown_column_and_a_damaged_file_are_refused(case):
    path, (time, angle, _), _ = case
    with pytest.raises(DataError, match="unknown column 'angel'"):
        read(path, time, {"bar.angle": "angel"})
    path.write_bytes(path.read_bytes()[:97])
    with pytest.raises(DataError):
        read(path, time, {"bar.angle": angle})


@pytest.mark.parametrize(
    ("name", "module", "extra"),
    [
        ("run.xlsx", "openpyxl", "xlsx"),
        ("run.tdms", "nptdms", "tdms"),
        ("run.mf4", "asammdf", "mdf"),
        ("run.mcap", "mcap.reader", "mcap"),
    ],
)
def test_a_missing_library_is_named_with_what_to_install(name, module, extra, tmp_path, monkeypatch):
    def absent(wanted):
        raise ImportError(wanted)

    (tmp_path / name).write_bytes(b"x")
    monkeypatch.setattr(opening, "import_module", absent)
    monkeypatch.setattr(opening, "find_spec", lambda name: None)
    with pytest.raises(DataError, match=rf"is not installed; run: pip install 'dalembert\[{extra}\]'"):
        read(tmp_path / name)


def test_dates_and_durations_in_a_workbook_are_seconds(tmp_path):
    import openpyxl

    book = openpyxl.Workbook()
    book.active.append(["when", "x"])
    for k in range(4):
        book.active.append([datetime(2024, 2, 29, 23, 59, 59) + timedelta(seconds=0.5 * k), float(k)])
    book.save(tmp_path / "run.xlsx")
    assert read(tmp_path / "run.xlsx", "when").coordinate.values.tolist() == [0.0, 0.5, 1.0, 1.5]


def test_other_messages_than_json_are_named(tmp_path):
    _mcap(tmp_path / "run.mcap", "cdr")
    with pytest.raises(DataError, match="no message is JSON; the file has: cdr"):
        read(tmp_path / "run.mcap")


def test_nested_json_gives_columns_by_their_path(tmp_path):
    nested = {"rig": 7, "run": {"t": TIMES.tolist(), "imu": {"a": ANGLE.tolist()}}}
    rows = {"log": [{"t": t, "imu": {"a": a}} for t, a in zip(TIMES.tolist(), ANGLE.tolist(), strict=True)]}
    for content, front in ((nested, "run"), (rows, "log"), (rows["log"], "")):
        (tmp_path / "run.json").write_text(json.dumps(content))
        dot = f"{front}." if front else ""
        data = read(tmp_path / "run.json", f"{dot}t", {"bar.x": f"{dot}imu.a"})
        np.testing.assert_array_equal(data.values[:, 0], ANGLE)


def test_cells_and_arrays_of_structs_of_matlab_are_read(tmp_path):
    cell = np.empty((1, 2), dtype=object)
    cell[0, 0], cell[0, 1] = ANGLE, RATE
    signals = np.array([(ANGLE,), (RATE,)], dtype=[("values", object)])
    savemat(tmp_path / "run.mat", {"q": cell, "out": {"time": TIMES, "signals": signals}})
    columns = {"a.x": "q{2}", "a.y": "out.signals(1).values", "a.z": "out.signals(2).values"}
    data = read(tmp_path / "run.mat", "out.time", columns)
    np.testing.assert_array_equal(data.values, np.stack([RATE, ANGLE, RATE], axis=1))
    with h5py.File(tmp_path / "new.mat", "w") as file:
        refs = file.create_group("#refs#")
        refs["a"], refs["b"] = ANGLE[None], RATE[None]
        file["t"] = TIMES[None]
        file.create_dataset("q", data=np.array([[refs["a"].ref], [refs["b"].ref]], dtype=h5py.ref_dtype))
        file["q"].attrs["MATLAB_class"] = b"cell"
        file.create_group("s").create_dataset("v", data=np.array([[refs["b"].ref]], dtype=h5py.ref_dtype))
    data = read(tmp_path / "new.mat", "t", {"a.x": "q{2}", "a.y": "s(1).v", "a.z": "q{1}"})
    np.testing.assert_array_equal(data.values, np.stack([RATE, RATE, ANGLE], axis=1))


def test_an_archive_with_several_files_is_refused(tmp_path):
    with ZipFile(tmp_path / "run.zip", "w") as archive:
        archive.writestr("a.csv", "t,x\n0,1\n1,2\n")
        archive.writestr("b.csv", "t,x\n0,1\n1,2\n")
    with pytest.raises(DataError, match=r"expected one file of data in the archive; it has: a.csv, b.csv; unpack it"):
        read(tmp_path / "run.zip")


@pytest.mark.slow
def test_channels_with_other_times_are_refused_together(tmp_path):
    from asammdf import MDF, Signal

    with MDF(version="4.10") as file:
        file.append([Signal(ANGLE, TIMES, name="angle")])
        file.append([Signal(RATE, TIMES + 0.01, name="rate")])
        file.save(tmp_path / "run.mf4", overwrite=True)
    with pytest.raises(DataError, match="the channels 'angle' and 'rate' have different times"):
        read(tmp_path / "run.mf4", columns={"a.x": "angle", "a.y": "rate"})
    data = read(tmp_path / "run.mf4", columns={"a.y": "rate"})
    np.testing.assert_allclose(data.coordinate.values, TIMES + 0.01)


def test_matrices_and_records_have_columns(tmp_path):
    np.savez(
        tmp_path / "run.npz",
        t=TIMES,
        q=np.stack([ANGLE, RATE]),
        r=np.array(list(zip(TIMES, ANGLE, strict=True)), dtype=[("t", float), ("a", float)]),
    )
    data = read(tmp_path / "run.npz", columns={"a.x": "q[1,:]", "a.y": "r.a"})
    np.testing.assert_array_equal(data.values, np.stack([RATE, ANGLE], axis=1))


def test_every_format_has_a_test():
    assert {"csv", "json", "mat", "netcdf", "parquet", "uff"} | {
        "xlsx",
        "tdms",
        "mdf",
        "mcap",
        "lvm",
        "hdf5",
        "npz",
        "zip",
    } == set(known_formats())
