"""Further formats: files that other libraries write give the numbers that were written."""

import json
import struct
from datetime import datetime, timedelta
from importlib import import_module
from zipfile import ZipFile

import h5py
import numpy as np
import pytest
from scipy.io import loadmat, savemat

from dalembert.data import opening, read
from dalembert.data.formats import mat
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


def test_messages_that_nothing_decodes_are_named(tmp_path):
    _mcap(tmp_path / "run.mcap", "cbor")
    with pytest.raises(DataError, match="no message can be decoded; the file has: cbor with jsonschema; expected JSON"):
        read(tmp_path / "run.mcap")


def _ros_messages(path, encoding, schema_encoding, schema, pack):
    """Messages with a stamp, which is 0.125 s late, an angle and a rate, written byte by byte."""
    from mcap.writer import Writer

    with path.open("wb") as stream:
        writer = Writer(stream)
        writer.start()
        name, data = schema
        number = writer.register_schema(name=name, encoding=schema_encoding, data=data)
        channel = writer.register_channel(topic="/joint", message_encoding=encoding, schema_id=number)
        for t, a, r in zip(TIMES.tolist(), ANGLE.tolist(), RATE.tolist(), strict=True):
            stamp = 10**18 + round(1e9 * t)
            message = pack(*divmod(stamp, 10**9), a, r)
            late = stamp + 125_000_000
            writer.add_message(channel_id=channel, log_time=late, publish_time=late, data=message)
        writer.finish()


def _definitions(integer):
    stamp = f"\n{'=' * 80}\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n" if integer else ""
    kind = "builtin_interfaces/Time" if integer else "time"
    return f"{kind} stamp\nfloat64 angle\nfloat64[2] rates\nstring name\n{stamp}".encode()


def _protobuf():
    """A message with a stamp, an angle and rates, and the bytes of one."""
    descriptor = pytest.importorskip("google.protobuf.descriptor_pb2")
    file = descriptor.FileDescriptorProto(name="joint.proto", package="rig", syntax="proto3")
    stamp, joint = file.message_type.add(name="Stamp"), file.message_type.add(name="Joint")
    for name, number in (("seconds", 1), ("nanos", 2)):
        stamp.field.add(name=name, number=number, type=3, label=1)
    joint.field.add(name="stamp", number=1, type=11, label=1, type_name=".rig.Stamp")
    joint.field.add(name="angle", number=2, type=1, label=1)
    joint.field.add(name="rates", number=3, type=1, label=3)
    joint.field.add(name="child", number=4, type=11, label=1, type_name=".rig.Joint")

    def varint(number):
        return bytes([number]) if number < 128 else bytes([number & 127 | 128]) + varint(number >> 7)

    def pack(seconds, nanos, angle, rate):
        inner = b"\x08" + varint(seconds) + b"\x10" + varint(nanos)
        first = b"\x0a" + bytes([len(inner)]) + inner
        return first + b"\x11" + struct.pack("<d", angle) + b"\x1a\x10" + struct.pack("<2d", rate, -rate)

    return ("rig.Joint", descriptor.FileDescriptorSet(file=[file]).SerializeToString()), pack


@pytest.mark.parametrize("kind", ["ros1", "ros2", "protobuf"])
def test_binary_messages_of_robots_are_decoded(kind, tmp_path):
    pytest.importorskip(f"mcap_{kind}")
    if kind == "ros1":
        # Numbers without padding, little-endian; a string is its length and its characters.
        schema, pack = (
            ("rig/Joint", _definitions(False)),
            lambda s, n, a, r: struct.pack("<II3dI1s", s, n, a, r, -r, 1, b"x"),
        )
        encodings = "ros1", "ros1msg"
    elif kind == "ros2":
        # CDR: a header of four bytes, numbers aligned to their sizes behind it; strings end with a zero.
        schema = ("rig/msg/Joint", _definitions(True))
        encodings = "cdr", "ros2msg"

        def pack(s, n, a, r):
            return b"\0\1\0\0" + struct.pack("<iI3dI2s", s, n, a, r, -r, 2, b"x\0")
    else:
        schema, pack = _protobuf()
        encodings = "protobuf", "protobuf"
    path = tmp_path / "run.mcap"
    _ros_messages(path, *encodings, schema, pack)
    data = read(path, "stamp", {"bar.angle": "angle", "bar.rate": "/joint:rates[0]", "other.rate": "rates[1]"})
    np.testing.assert_allclose(data.coordinate.values, TIMES, rtol=0, atol=1e-12)
    np.testing.assert_array_equal(data.values, np.stack([ANGLE, RATE, -RATE], axis=1))
    assert [column.key for column in preview(path).columns][:2] == ["log_time", "stamp"]


def test_the_package_that_decodes_messages_is_named(tmp_path, monkeypatch):
    def absent(wanted):
        if wanted == "mcap_ros2.decoder":
            raise ImportError(wanted)
        return import_module(wanted)

    _ros_messages(tmp_path / "run.mcap", "cdr", "ros2msg", ("rig/msg/Joint", _definitions(True)), lambda *numbers: b"")
    monkeypatch.setattr(opening, "import_module", absent)
    with pytest.raises(DataError, match=r"mcap-ros2-support is needed to .*; run: pip install 'dalembert\[mcap\]'"):
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


def _matlab_objects(path, version):
    """A table, a timetable, and a dataset of Simulink with an even timeseries, as MATLAB saves their properties."""
    matio, pandas = pytest.importorskip("matio"), pytest.importorskip("pandas")
    from matio.utils.matclass import MatlabOpaque

    table = pandas.DataFrame({"t": TIMES, "angle": ANGLE, "name": list("abcdefgh")})
    even = {
        "Units": np.array(["milliseconds"]),
        "Start_": np.array([[0.0]]),
        "Increment_": np.array([[125.0]]),
        "Length": np.array([[8.0]]),
        "Time_": np.zeros((0, 0)),
    }
    series = {"Data_": ANGLE[:, None], "TimeInfo": MatlabOpaque(even, "tsdata.timemetadata")}
    signal = MatlabOpaque({"Values": MatlabOpaque(series, "timeseries")}, "Simulink.SimulationData.Signal")
    elements = np.empty((1, 1), dtype=object)
    elements[0, 0] = signal
    storage = MatlabOpaque({"Elements": elements}, "Simulink.SimulationData.Storage.RamDatasetStorage")
    stamps = pandas.Index(np.round(1e3 * TIMES).astype("timedelta64[ms]"), name="Time")
    variables = {
        "x": RATE,
        "run": table,
        "log": pandas.DataFrame({"angle": ANGLE}, index=stamps),
        "logsout": MatlabOpaque({"Storage_": storage}, "Simulink.SimulationData.Dataset"),
    }
    matio.save_to_mat(str(path), variables, version=version)


@pytest.mark.filterwarnings("ignore:duration_to_mat")  # of the display format, which is not needed
@pytest.mark.parametrize("version", ["v7", "v7.3"])
def test_objects_of_matlab_are_read_by_the_names_of_matlab(version, tmp_path, monkeypatch):
    path = tmp_path / "run.mat"
    _matlab_objects(path, version)
    if version == "v7":
        data = read(path, "logsout{1}.Values.Time", {"bar.angle": "logsout{1}.Values.Data", "bar.rate": "x"})
        np.testing.assert_allclose(data.coordinate.values, TIMES, rtol=1e-14)
        np.testing.assert_array_equal(data.values, np.stack([ANGLE, RATE], axis=1))

    def in_this_process(path, what, module, function):  # where the library is imported already
        return getattr(import_module(module), function)(str(path))

    monkeypatch.setattr(mat, "guarded", in_this_process)
    monkeypatch.setattr(mat, "version_5", lambda path: loadmat(path, simplify_cells=True))
    columns = {column.key: column for column in preview(path).columns}
    for time, name in (("run.t", "run.angle"), ("log.Time", "log.angle"), ("logsout{1}.Values.Time",) * 2):
        np.testing.assert_allclose(columns[time].values, TIMES * (1e3 if columns[time].unit == "milliseconds" else 1))
        np.testing.assert_array_equal(columns[name.replace("Time", "Data")].values, ANGLE)
    assert columns["logsout{1}.Values.Time"].unit == "milliseconds"
    assert "run" not in columns
    monkeypatch.setattr(mat, "find_spec", lambda name: None)
    data = read(path, sampling=8.0, columns={"bar.rate": "x"})
    assert data.origin.endswith("run.mat: without its objects of MATLAB")
    with pytest.raises(
        DataError, match=r"no column 'run.t' outside of objects; .*pip install 'dalembert\[matlab\]'; or"
    ):
        read(path, "run.t", {"bar.angle": "run.angle"})


@pytest.mark.parametrize("comma", [False, True])
def test_times_without_a_column_in_a_labview_file_are_those_of_its_header(comma, tmp_path):
    head = "LabVIEW Measurement\nSeparator\tTab\nX_Columns\tNo\n***End_of_Header***\n\n"
    segment = (
        "Channels\t2\nSamples\t4\t4\nY_Unit_Label\tdeg\tdeg/s\nX_Dimension\tTime\tTime\nX0\t{0}\t{0}\n"
        "Delta_X\t0.125\t0.125\n***End_of_Header***\nX_Value\tangle\trate\tComment\n"
    )
    rows = [f"\t{a!r}\t{r!r}\t\n" for a, r in zip(ANGLE.tolist(), RATE.tolist(), strict=True)]
    text = head + "".join([segment.format("1.0E+0"), *rows[:4], segment.format("1.5E+0"), *rows[4:]])
    path = tmp_path / "run.lvm"
    path.write_text(text.replace(".", ",") if comma else text)
    data = read(path, "X_Value", {"bar.angle": "angle", "bar.rate": "rate"})
    np.testing.assert_allclose(data.coordinate.values, 1.0 + TIMES, rtol=1e-14)
    np.testing.assert_allclose(data.values, np.deg2rad(np.stack([ANGLE, RATE], axis=1)), rtol=1e-14)
    path.write_text(text.replace("Delta_X\t0.125\t0.125", "Delta_X\t0.125\t0.25"))
    with pytest.raises(DataError, match=r"its header has Delta_X 0.125, 0.25 and X0 1.0E\+0; expected one of each"):
        read(path, "X_Value", {"bar.angle": "angle"})


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
