"""Files as they are shown before their columns are chosen."""

import gzip
import json

import numpy as np
import pytest

from dalembert.data import read
from dalembert.data.guesses import Unit, time_column, unit_of
from dalembert.data.preview import preview
from dalembert.data.text_numbers import BLOCK
from dalembert.errors import DataError

TEXTS = {
    "blanks": ("time_ms  angle_deg\n1500 20.5\n1510 20.25\n", ["time_ms", "angle_deg"], "time_ms", "ms", "deg"),
    "units in brackets behind blanks": ("t [ms]  angle [deg]\n 1500 20.5\n 1510 20.25\n", ["t [ms]", "angle [deg]"], "t [ms]", "ms", "deg"),
    "names with blanks": ("Time (ms)\tRod angle\n1500\t20.5\n1510\t20.25\n", ["Time (ms)", "Rod angle"], "Time (ms)", "ms", ""),
    "names with blanks above blanks": ("Time (ms)   Rod angle\n1500 20.5\n1510 20.25\n", ["Time (ms)", "Rod angle"], "Time (ms)", "ms", ""),
    "no header": ("1500 20.5\n1510 20.25\n", [1, 2], 1, "ms", ""),
    "decimal commas": ("Zeit;Winkel\ns;deg\n1500,0;20,5\n1500,1;20,25\n", ["Zeit", "Winkel"], "Zeit", "s", "deg"),
    "repeated names": ("t,a,a\n1500,20.5,1\n1510,20.25,1\n", ["t", 2, 3], "t", "ms", ""),
}  # fmt: skip


@pytest.mark.parametrize(("text", "keys", "time", "unit", "other"), TEXTS.values(), ids=TEXTS)
def test_columns_times_and_units_are_guessed(tmp_path, text, keys, time, unit, other):
    (tmp_path / "own.txt").write_text(text)
    found = preview(tmp_path / "own.txt")
    assert [column.key for column in found.columns] == keys
    assert found.columns[1].values.tolist() == [20.5, 20.25]
    assert time_column(found) == time
    assert unit_of(found.columns[0], times=True).name == unit
    assert unit_of(found.columns[1]).name == other


@pytest.mark.parametrize(("text", "keys", "time", "unit", "other"), TEXTS.values(), ids=TEXTS)
def test_what_is_guessed_can_be_read(tmp_path, text, keys, time, unit, other):
    (tmp_path / "own.txt").write_text(text)
    units = {str(key): one for key, one in zip(keys, (unit, other), strict=False) if one}
    data = read(tmp_path / "own.txt", time, {"angle": keys[1]}, units=units)
    scale = np.pi / 180 if other == "deg" else 1.0
    np.testing.assert_allclose(data.values[:, 0], scale * np.array([20.5, 20.25]))


def test_cells_without_numbers_are_kept_as_what_they_are(tmp_path):
    (tmp_path / "own.csv").write_text("t,x,y\n0,1,\n1,oops,2\n2,3,inf\n3,4,5,6\n4,5\n")
    found = preview(tmp_path / "own.csv")
    _, x, y = found.columns
    np.testing.assert_equal(x.values, [1, np.nan, 3, 4, 5])
    np.testing.assert_equal(y.values, [np.nan, 2, np.nan, 5, np.nan])
    assert (x.missing, x.wrong, y.missing, y.wrong) == (0, (3, "oops"), 2, (4, "inf"))
    assert found.uneven == (5, 4)
    assert found.first[1] == ("1", "oops", "2")


def test_a_separator_at_the_end_of_each_line_makes_no_column_and_no_uneven_line(tmp_path):
    (tmp_path / "own.csv").write_text("t;x;\n0;1;\n1;na;\n2;3;\n")
    found = preview(tmp_path / "own.csv")
    assert ([column.key for column in found.columns], found.uneven) == (["t", "x"], None)


def test_long_files_are_read_in_blocks_and_say_the_line_of_what_is_wrong(tmp_path):
    rows = [f"{row},{row % 7}.5" for row in range(BLOCK + 10)]
    rows[BLOCK + 3] = f"{BLOCK + 3},bad"
    (tmp_path / "long.csv").write_text("\n".join(["t,x", *rows]))
    times, x = preview(tmp_path / "long.csv").columns
    assert (len(times.values), times.values[-1], x.values[8]) == (BLOCK + 10, BLOCK + 9, 1.5)
    assert x.wrong == (BLOCK + 5, "bad")


def test_comments_among_the_numbers_are_passed_over(tmp_path):
    (tmp_path / "own.csv").write_text("t,x\n0,1\n# here\n1,2\n")
    assert preview(tmp_path / "own.csv").columns[1].values.tolist() == [1, 2]


def test_other_formats_are_previewed(tmp_path):
    import pyarrow
    import pyarrow.parquet
    import xarray
    from scipy.io import savemat

    t, x = np.arange(4) * 0.1, np.arange(4.0)
    (tmp_path / "a.json").write_text(json.dumps({"t": t.tolist(), "x": x.tolist(), "name": ["a"] * 4}))
    (tmp_path / "b.csv.gz").write_bytes(
        gzip.compress(b"t,x\n" + b"\n".join(b"%g,%g" % row for row in zip(t, x, strict=True)))
    )
    pyarrow.parquet.write_table(pyarrow.table({"t": t, "x": x}), tmp_path / "c.parquet")
    savemat(tmp_path / "d.mat", {"t": t, "x": x, "scalar": 3.0})
    xarray.Dataset({"x": ("t", x, {"units": "mm"})}, {"t": ("t", t, {"units": "ms"})}).to_netcdf(
        tmp_path / "e.nc", engine="h5netcdf"
    )
    for name in ("a.json", "b.csv.gz", "c.parquet", "d.mat", "e.nc"):
        found = preview(tmp_path / name)
        columns = {column.key: column for column in found.columns}
        np.testing.assert_allclose(columns["t"].values, t, err_msg=name)
        np.testing.assert_allclose(columns["x"].values, x, err_msg=name)
        assert (time_column(found), len(columns), found.samples) == ("t", 2, 4), name
        assert len(found.first) == 4
    assert unit_of(columns["t"], times=True) == Unit("ms", "file")


def test_a_file_without_numbers_is_refused(tmp_path):
    (tmp_path / "own.csv").write_text("a,b\nc,d\n")
    with pytest.raises(DataError, match="has no line of numbers; expected column names and then lines of numbers"):
        preview(tmp_path / "own.csv")
    (tmp_path / "own.json").write_text('{"a": ["x", "y"]}')
    with pytest.raises(DataError, match="has no column of numbers; expected one of times and one of each channel"):
        preview(tmp_path / "own.json")
