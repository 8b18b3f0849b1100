"""Measurements from files of every format."""

from datetime import datetime, timedelta

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from scipy.io import savemat
from xarray import Dataset

from dalembert.data import read, read_bands
from dalembert.errors import DataError
from dalembert.inverse import Fit, identify
from data_files import ANGLE, TIMES, WAY, WRITERS, function, universal
from small_models import DECAY, measured


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "motion.csv"
    path.write_text("t,case1_x,case1_y\n0.00,2.4392,-1.7071\n0.05, 2.4380 ,-1.7186\n\n0.10,2.4342,-1.7533\n")
    return path


def test_columns_are_named_as_the_channels_that_they_measure(file):
    data = read(file, columns={"AB.end.y": "case1_y", "AB.end.x": "case1_x"}, deviations=1e-4)
    assert data.channels == ("AB.end.y", "AB.end.x")
    assert data.coordinate.values.tolist() == [0.0, 0.05, 0.1]
    assert data.values.tolist() == [[-1.7071, 2.4392], [-1.7186, 2.438], [-1.7533, 2.4342]]
    assert data.deviations.tolist() == [1e-4, 1e-4]


def test_without_columns_all_but_the_time_are_read(file):
    assert read(file).channels == ("case1_x", "case1_y")


def test_another_separator_and_a_byte_order_mark_are_read(tmp_path):
    path = tmp_path / "motion.csv"
    path.write_bytes("zeit;x\n0;1\n1;2\n".encode("utf-8-sig"))
    assert read(path, format="csv", time="zeit", separator=";").values.tolist() == [[1.0], [2.0]]


def test_decimal_commas_are_read_where_they_are_said(tmp_path):
    path = tmp_path / "motion.csv"
    path.write_text("t;x_lower;x_upper\n0,0;-1,5;2\n0,25;;2,5e1\n")
    said = {"separator": ";", "decimal": ","}
    data = read(path, format="csv", missing="leave-out", **said)
    assert data.coordinate.values.tolist() == [0.0, 0.25]
    np.testing.assert_array_equal(data.values, [[-1.5, 2.0], [np.nan, 25.0]])
    path.write_text("t;x_lower;x_upper\n0,0;-1,5;2,5\n")
    bands = read_bands(path, **said)
    assert (bands.lower.tolist(), bands.upper.tolist()) == ([[-1.5]], [[2.5]])


def test_names_of_columns_may_be_numbers(tmp_path):
    path = tmp_path / "motion.csv"
    path.write_text("0,1\n0.0,2.0\n0.5,3.0\n")
    assert read(path, format="csv", time="0", columns={"x": "1"}).values.tolist() == [[2.0], [3.0]]


@pytest.mark.parametrize("name", WRITERS)
def test_every_format_gives_the_same_numbers(name, tmp_path):
    columns = WRITERS[name](tmp_path / name)
    data = read(tmp_path / name, columns=columns, deviations={"x": 1e-3, "y": 1e-3, "angle": 1e-2}, wraps=["angle"])
    assert data.channels == ("angle", "x", "y")
    np.testing.assert_allclose(data.coordinate.values, TIMES, rtol=1e-5 if name.endswith("uff") else 0)
    np.testing.assert_array_equal(data.values, np.column_stack([ANGLE, WAY]))
    assert (data.coordinate.name, data.coordinate.unit, data.wraps) == ("time", "s", ("angle",))
    assert data.deviations.tolist() == [1e-2, 1e-3, 1e-3]


@pytest.mark.parametrize(
    ("name", "channels"),
    [
        ("motion.csv", ("angle", "x", "y")),
        ("motion.parquet", ("angle", "x", "y")),
        ("motion.mat", ("run.angle", "run.place(:,1)", "run.place(:,2)")),
        ("motion73.mat", ("run.angle", "run.place(:,1)", "run.place(:,2)")),
        ("motion.uff", ("1:-RZ", "2:+X", "2:+Y")),
        ("motion.nc", ("angle", "place[x]", "place[y]")),
    ],
)
def test_without_columns_all_that_hold_numbers_are_read(name, channels, tmp_path):
    WRITERS[name](tmp_path / name)
    assert read(tmp_path / name).channels == channels


@pytest.mark.parametrize("name", WRITERS)
def test_units_are_converted_column_by_column(name, tmp_path):
    columns = WRITERS[name](tmp_path / name)
    data = read(tmp_path / name, columns=columns, units={"t": "ms", columns["angle"]: "deg", columns["x"]: "mm"})
    np.testing.assert_allclose(data.coordinate.values, TIMES / 1000, rtol=1e-5)
    np.testing.assert_allclose(
        data.values, np.column_stack([np.deg2rad(ANGLE), WAY[:, 0] / 1000, WAY[:, 1]]), rtol=1e-14
    )


def test_bands_are_read_from_every_format_too(tmp_path):
    savemat(tmp_path / "bounds.mat", {"t": [0.0, 1.0], "x": np.array([[1.0, 2.0], [3.0, 4.0]])})
    bands = read_bands(tmp_path / "bounds.mat", columns={"x": ("x(:,1)", "x(:,2)")}, units={"x(:,2)": "km"})
    assert (bands.lower.tolist(), bands.upper.tolist()) == ([[1.0], [3.0]], [[2000.0], [4000.0]])


def test_the_format_may_be_said_instead_of_the_suffix(tmp_path):
    columns = WRITERS["motion.parquet"](tmp_path / "motion.dat")
    assert read(tmp_path / "motion.dat", columns=columns, format="parquet").channels == ("angle", "x", "y")


@pytest.mark.parametrize("cell", ["", "nan", "NaN", "NA"])
def test_gaps_of_a_text_file_are_left_out_where_asked(cell, tmp_path):
    (tmp_path / "motion.csv").write_text(f"t,x,y\n0,1,2\n1,{cell},3\n")
    data = read(tmp_path / "motion.csv", missing="leave-out")
    assert data.missing == "leave-out"
    assert data.present.tolist() == [[True, True], [False, True]]


def test_nulls_of_a_parquet_file_are_left_out_where_asked(tmp_path):
    pq.write_table(pa.table({"t": [0.0, 1.0], "x": [1, None], "y": [1.5, None]}), tmp_path / "motion.parquet")
    data = read(tmp_path / "motion.parquet", missing="leave-out")
    assert data.present.tolist() == [[True, True], [False, False]]


def test_dates_become_seconds_since_the_first(tmp_path):
    begin = datetime(2024, 5, 1, 12)
    dates = [begin, begin + timedelta(milliseconds=20), begin + timedelta(milliseconds=50)]
    pq.write_table(pa.table({"when": dates, "x": [1.0, 2.0, 3.0]}), tmp_path / "motion.parquet")
    data = read(tmp_path / "motion.parquet", "when")
    np.testing.assert_allclose(data.coordinate.values, [0.0, 0.02, 0.05], rtol=1e-12)


def test_a_matrix_with_a_row_a_channel_is_read_by_rows(tmp_path):
    savemat(tmp_path / "run.mat", {"t": TIMES, "q": WAY.T})
    data = read(tmp_path / "run.mat", columns={"x": "q(1,:)", "y": "q(2,:)"})
    np.testing.assert_array_equal(data.values, WAY)


def test_an_evenly_spaced_function_and_single_precision_are_read(tmp_path):
    even = np.linspace(0, 0.5, 11)
    more = {"abscissa_spacing": 1, "abscissa_inc": 0.05}
    single = function(7, 3, np.sin(even), x=even, ord_data_type=2, **more)
    universal(tmp_path / "a.unv", [single, function(7, 3, np.cos(even), x=even, binary=1, **more)], force_double=False)
    data = read(tmp_path / "a.unv")
    assert data.channels == ("7:+Z#1", "7:+Z#2")
    np.testing.assert_allclose(data.coordinate.values, even, atol=1e-12)
    np.testing.assert_allclose(data.values, np.column_stack([np.sin(even), np.cos(even)]), atol=1e-5)


def test_a_function_of_frequency_lies_along_frequency(tmp_path):
    sets = [function(1, 1, ANGLE**2, abscissa_spec_data_type=18)]
    universal(tmp_path / "a.uff", sets)
    data = read(tmp_path / "a.uff", units={"t": "kHz"})
    assert (data.coordinate.name, data.coordinate.unit) == ("frequency", "Hz")
    np.testing.assert_allclose(data.coordinate.values, 1000 * TIMES, rtol=1e-5)


def test_units_that_a_netcdf_file_names_are_converted(tmp_path):
    Dataset(
        {"angle": ("t", ANGLE, {"units": "degrees"}), "rate": ("t", ANGLE, {"units": "rad s-1"})},
        {"t": ("t", 1000 * TIMES, {"units": "milliseconds since 2024-05-01"})},
    ).to_netcdf(tmp_path / "a.nc", engine="h5netcdf")
    data = read(tmp_path / "a.nc")
    np.testing.assert_allclose(data.coordinate.values, TIMES, rtol=1e-12)
    np.testing.assert_allclose(data.values, np.column_stack([np.deg2rad(ANGLE), ANGLE]), rtol=1e-14)
    data = read(tmp_path / "a.nc", units={"angle": "rad"})
    np.testing.assert_array_equal(data.values[:, 0], ANGLE)


def test_a_result_of_ours_is_data_again(tmp_path):
    fit = identify(DECAY, measured(DECAY, [2.0, 0.8]), starts=1)
    fit.save(tmp_path / "fit.nc")
    data = read(tmp_path / "fit.nc", "coordinate", {"x": "response[x]"})
    np.testing.assert_array_equal(data.values, Fit.load(tmp_path / "fit.nc").response)


@pytest.mark.parametrize(
    ("argument", "value"),
    [
        ("path", 5), ("time", None), ("columns", ["x"]), ("units", ["mm"]), ("units", {"x": None}), ("missing", None),
        ("missing", -9999), ("separator", 1), ("trial", 1), ("trial", "ab"),
    ],
)  # fmt: skip
def test_arguments_of_another_type_are_refused(argument, value, tmp_path):
    (tmp_path / "run.csv").write_text("t,x\n0,1\n1,2\n")
    arguments = {"path": tmp_path / "run.csv"} | {argument: value}
    with pytest.raises(DataError, match=f"read: {argument} is .*; expected "):
        read(**arguments)
