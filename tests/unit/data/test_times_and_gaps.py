"""Files without a column of times, with times of day, and with words for missing values."""

import json

import numpy as np
import pytest
from scipy.io import savemat

from dalembert.data import read, read_bands
from dalembert.data.preview import preview
from dalembert.errors import DataError
from dalembert.studio.data.choices import of_table, table_of
from dalembert.study.tables.data_table import DataTable
from dalembert.study.text.table import Context

CLOCKS = {
    "2024-03-01 23:59:59.5": "2024-03-02 00:00:00.25",
    "2024-03-01T23:59:59.500Z": "2024-03-02T00:00:00.250Z",
    "1.3.2024 23:59:59,5": "2.3.2024 00:00:00,25",
    "29/02/2024 23:59:59.5": "01/03/2024 00:00:00.25",
    "02/29/2024 11:59:59.5 PM": "03/01/2024 12:00:00.25 AM",
    "23:59:59.5": "00:00:00.25",
}


@pytest.mark.parametrize("first", CLOCKS)
def test_times_of_day_become_seconds_since_the_first(first, tmp_path):
    lines = ["when;x", f"{first};1", f"{CLOCKS[first]};2"]
    (tmp_path / "run.csv").write_text("\n".join(lines))
    assert read(tmp_path / "run.csv", "when").coordinate.values.tolist() == [0.0, 0.75]
    column = preview(tmp_path / "run.csv").column("when")
    assert (column.values.tolist(), column.unit, column.wrong) == ([0.0, 0.75], "s", None)


def test_a_time_of_day_that_is_none_is_refused(tmp_path):
    (tmp_path / "run.csv").write_text("t;x\n10:00:00;1\n10:00:61x;2\n10:00:02;3\n")
    with pytest.raises(DataError, match="line 2, column 't': '10:00:00' is not a number"):
        read(tmp_path / "run.csv")


VALUES = np.array([0.5, 1.5, -2.0, 4.0])


def _files(folder):
    (folder / "run.csv").write_text("x;y\n" + "".join(f"{value};{2 * value}\n" for value in VALUES))
    (folder / "run.json").write_text(json.dumps({"x": VALUES.tolist(), "y": (2 * VALUES).tolist()}))
    savemat(folder / "run.mat", {"x": VALUES, "y": 2 * VALUES})


@pytest.mark.parametrize("name", ["run.csv", "run.json", "run.mat"])
def test_a_rate_replaces_the_column_of_times(name, tmp_path):
    _files(tmp_path)
    for columns in (None, {"y": "y", "x": "x"}):
        data = read(tmp_path / name, columns=columns, sampling=200.0)
        assert data.coordinate.values.tolist() == [0.0, 0.005, 0.01, 0.015]
        np.testing.assert_array_equal(data.values[:, data.channels.index("y")], 2 * VALUES)
    table = DataTable.model_validate(
        {"file": name, "sampling": "0.2 kHz", "columns": {"a.y": "y"}}, context=Context(tmp_path)
    )
    assert table.read().coordinate.values[-1] == 0.015


@pytest.mark.parametrize("rate", [0.0, -1.0, np.inf, "200 Hz", True])
def test_a_rate_that_is_none_is_refused(rate, tmp_path):
    _files(tmp_path)
    with pytest.raises(DataError, match="expected a positive number of samples a second"):
        read(tmp_path / "run.csv", sampling=rate)


def test_bands_have_a_rate_too(tmp_path):
    (tmp_path / "bands.csv").write_text("x_lower,x_upper\n1,2\n2,3\n")
    assert read_bands(tmp_path / "bands.csv", sampling=4.0).coordinate.values.tolist() == [0.0, 0.25]


def test_the_studio_keeps_a_rate(tmp_path):
    _files(tmp_path)
    table = {"file": "run.csv", "sampling": "200 Hz", "columns": {"a.x": "x"}}
    choices = of_table(table)
    assert choices.time is None
    assert table_of(choices, preview(tmp_path / "run.csv")) == table


@pytest.mark.parametrize("word", ["N/A", "-", "null", "NULL", "#N/A", "nan", "", "--", "None", "?", "#DIV/0!"])
def test_common_spellings_of_missing_values_are_known(word, tmp_path):
    (tmp_path / "run.csv").write_text(f"t;x\n0;1.0\n1;{word}\n2;3.0\n3;4.0\n")
    data = read(tmp_path / "run.csv", missing="leave-out")
    np.testing.assert_array_equal(data.values[:, 0], [1.0, np.nan, 3.0, 4.0])
    assert data.missing == "leave-out"
    with pytest.raises(DataError, match="line 3, column 'x'"):
        read(tmp_path / "run.csv")


def test_further_words_and_numbers_may_stand_for_missing_values(tmp_path):
    (tmp_path / "run.csv").write_text("t;x\n0;1.0\n1;dropout\n2;-9999\n3;4.0\n-1e4;5\n".replace("-1e4;5", "4;n/a"))
    data = read(tmp_path / "run.csv", missing=["Dropout", -9999])
    np.testing.assert_array_equal(data.values[:, 0], [1.0, np.nan, np.nan, 4.0, np.nan])
    savemat(tmp_path / "run.mat", {"t": np.arange(3.0), "x": np.array([1.0, -9999.0, 2.0])})
    table = {"file": "run.mat", "columns": {"a.x": "x"}, "missing": [-9999]}
    data = DataTable.model_validate(table, context=Context(tmp_path)).read()
    np.testing.assert_array_equal(data.values[:, 0], [1.0, np.nan, 2.0])
