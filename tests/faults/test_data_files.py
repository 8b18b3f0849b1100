"""Defects of data in files of every format: one sentence each; malformed files never anything but a DataError."""

import sys

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from scipy.io import mmwrite, savemat
from scipy.sparse import coo_array, csc_array
from xarray import Dataset

from dalembert.data import read, read_bands
from dalembert.data.known_formats import known_formats
from dalembert.errors import DataError, InputError
from dalembert.structure import Dofs, Structure, read_structure, write_structure
from data_files import ANGLE, TIMES, WAY, WRITERS, function, universal

NAN = np.where(TIMES == 0.05, np.nan, ANGLE)


def refused(path, **options):
    with pytest.raises(DataError) as error:
        read(path, **options)
    return str(error.value)


def parquet(**columns):
    return lambda path: pq.write_table(pa.table(columns), path)


def mat(**variables):
    return lambda path: savemat(path, variables)


def uff(*sets):
    return lambda path: universal(path, list(sets))


def cut_short(path):
    universal(path, [function(1, 1, ANGLE)])
    lines = path.read_text().splitlines(keepends=True)
    path.write_text("".join(lines[:-2] + lines[-1:]))


def netcdf(units="s", **columns):
    variables = {name: ("t", *(column if isinstance(column, tuple) else (column,))) for name, column in columns.items()}
    dataset = Dataset(variables, {"t": ("t", TIMES, {"units": units})})
    return lambda path: dataset.to_netcdf(path, engine="h5netcdf")


MM = {"type": 164, "units_code": 5, "units_description": "mm", "temp_mode": 1}
MM |= {"length": 1000.0, "force": 1000.0, "temp": 1.0, "temp_offset": 273.15}

FILES = {
    "a column that is missing": (
        "a.parquet",
        parquet(t=TIMES, case1_x=ANGLE),
        {"columns": {"x": "case_x"}},
        "{path}: unknown column 'case_x'; did you mean 'case1_x'?",
    ),
    "a time column that is missing": (
        "a.mat",
        mat(time=TIMES, x=ANGLE),
        {},
        "{path}: unknown column 't'; known: time, x",
    ),
    "a dimension without times": (
        "a.nc",
        netcdf(x=ANGLE),
        {"time": "tt"},
        "{path}: unknown column 'tt'; did you mean 't'?",
    ),
    "a function that is missing": (
        "a.uff",
        uff(function(1, 1, ANGLE, "tip"), function(1, 2, ANGLE)),
        {"columns": {"x": "1:X"}},
        "{path}: unknown column '1:X'; did you mean '1:+X'?",
    ),
    "no function at all": (
        "a.uff",
        uff(MM),
        {},
        "{path}: no function at a node, dataset 58; the file holds datasets: 164",
    ),
    "a NaN": (
        "a.mat",
        mat(t=TIMES, x=NAN),
        {},
        "{path}, column 'x', sample 3: nan; expected a finite number; remove the sample or the column, or leave it "
        "out: missing = 'leave-out'",
    ),
    "a null": (
        "a.parquet",
        parquet(t=[0.0, 1.0], x=[1, None]),
        {},
        "{path}, column 'x', sample 1: nan; expected a finite number; remove the sample or the column, or leave it "
        "out: missing = 'leave-out'",
    ),
    "an infinity, which is no gap": (
        "a.parquet",
        parquet(t=[0.0, 1.0], x=[1.0, np.inf]),
        {"missing": "leave-out"},
        "{path}, column 'x', sample 1: inf; expected a finite number; remove the sample or the column",
    ),
    "a time that is not there": (
        "a.parquet",
        parquet(t=[0.0, None], x=[1.0, 2.0]),
        {"missing": "leave-out"},
        "{path}, column 't', sample 1: nan; expected a finite number; remove the sample or the column, or leave it "
        "out: missing = 'leave-out'",
    ),
    "a time that goes backwards": (
        "a.mat",
        mat(t=[0.0, 0.2, 0.1], x=[0.0, 0.0, 0.0]),
        {},
        "{path}, column 't', sample 2: 0.1 comes after 0.2; expected growing values; "
        "sort the samples or remove the repeated one",
    ),
    "a column of another length": (
        "a.mat",
        mat(t=TIMES, x=ANGLE[:4]),
        {"columns": {"x": "x"}},
        "{path}, column 'x': 4 values; expected 6, as 't' has",
    ),
    "nothing as long as the times": (
        "a.mat",
        mat(t=TIMES, x=ANGLE[:4]),
        {},
        "{path}: no column of numbers is as long as 't', 6 samples; name another",
    ),
    "text": (
        "a.parquet",
        parquet(t=[0.0, 1.0], x=["a", "b"]),
        {"columns": {"x": "x"}},
        "{path}, column 'x': no numbers; expected numbers",
    ),
    "complex numbers": (
        "a.mat",
        mat(t=TIMES, x=ANGLE + 1j),
        {"columns": {"x": "x"}},
        "{path}, column 'x': complex numbers; expected real ones, such as a motion over time",
    ),
    "a matrix whose columns are not named": (
        "a.mat",
        mat(t=TIMES, q=WAY),
        {"columns": {"x": "q"}},
        "{path}: unknown column 'q'; known: q(:,1), q(:,2), t",
    ),
    "functions over different abscissas": (
        "a.uff",
        uff(function(1, 1, ANGLE), function(2, 1, ANGLE, x=2 * TIMES)),
        {},
        "{path}: the functions '1:+X' and '2:+X' have different abscissas; expected one for all that are read "
        "together; read each by itself, and resample one at the other's samples",
    ),
    "a function that is cut short": (
        "a.uff",
        cut_short,
        {},
        "{path}, column '1:+X': 4 values; the file promises 6; is it cut short?",
    ),
    "a function along something else": (
        "a.uff",
        uff(function(1, 1, ANGLE, abscissa_spec_data_type=19)),
        {},
        "{path}, column '1:+X': its abscissa is of type 19; expected time (17) or frequency (18)",
    ),
    "a function in other units": (
        "a.uff",
        uff(MM, function(1, 1, ANGLE)),
        {},
        "{path}, column '1:+X': the file's units are 'mm' (dataset 164), which is not SI; give its unit: "
        "units = {{'1:+X': ...}}",
    ),
    "a function with a label in other units": (
        "a.uff",
        uff(function(1, 1, ANGLE, ordinate_axis_units_lab="g")),
        {},
        "{path}, column '1:+X': the file calls its unit 'g', which is not SI; give its unit: units = {{'1:+X': ...}}",
    ),
    "an unknown unit": (
        "a.mat",
        mat(t=TIMES, x=ANGLE),
        {"units": {"x": "milimetre"}},
        "{path}, column 'x': the unit 'milimetre' is unknown; expected one such as 'mm', 'deg' or 'm/s^2'; give it in "
        "units",
    ),
    "an unknown unit that the file names": (
        "a.nc",
        netcdf(x=(ANGLE, {"units": "furlongs per fortnite"})),
        {},
        "{path}, column 'x': the unit 'furlongs per fortnite' is unknown; expected one such as 'mm', 'deg' or "
        "'m/s^2'; give it in units",
    ),
    "a unit with an offset": (
        "a.mat",
        mat(t=TIMES, x=ANGLE),
        {"units": {"x": "degC"}},
        "{path}, column 'x': the unit 'degC' has an offset; expected a multiple of an SI unit, such as 'K'",
    ),
    "a unit of the times that is no time": (
        "a.mat",
        mat(t=TIMES, x=ANGLE),
        {"units": {"t": "mm"}},
        "{path}, column 't': the unit 'mm' was given; expected a unit of time such as 's' or 'ms'",
    ),
    "a unit of a column that there is not": (
        "a.mat",
        mat(t=TIMES, case1_x=ANGLE),
        {"units": {"case_x": "mm"}},
        "{path}, units: unknown column 'case_x'; did you mean 'case1_x'?",
    ),
    "an unknown format": (
        "a.mat",
        mat(t=TIMES, x=ANGLE),
        {"format": "matlab"},
        "{path}: unknown format 'matlab'; did you mean 'mat'?",
    ),
    "an unknown suffix": (
        "a.xls",
        mat(t=TIMES, x=ANGLE),
        {},
        "{path}: the suffix '.xls' stands for no format; expected one of {suffixes}; rename the file, or say "
        "which format it has: {formats}",
    ),
    "a column that is there twice": (
        "a.csv",
        lambda path: path.write_text("t,x,x\n0,1,2\n"),
        {},
        "{path}: 2 columns are called 'x'; expected one; name the column by its number, such as 2",
    ),
    "a wrapping channel that there is not": (
        "a.csv",
        lambda path: path.write_text("t,x\n0,1\n"),
        {"wraps": ["y"]},
        "{path}: wraps: unknown channel 'y'; known: x",
    ),
}


@pytest.mark.parametrize("defect", FILES)
def test_a_defect_of_a_file_is_told_with_file_column_and_sample(defect, tmp_path):
    name, write, options, sentence = FILES[defect]
    write(tmp_path / name)
    known = known_formats()  # with those that other tests define
    suffixes = ", ".join(suffix for form in known.values() for suffix in form.suffixes)
    expected = sentence.format(path=tmp_path / name, suffixes=suffixes, formats=", ".join(known))
    assert refused(tmp_path / name, **options) == expected


@pytest.mark.parametrize("suffix", [".csv", ".parquet", ".mat", ".uff", ".nc"])
def test_a_file_that_is_not_there_is_answered_with_its_neighbours(suffix, tmp_path):
    (tmp_path / f"motion{suffix}").touch()
    expected = f"folder {tmp_path}: unknown file 'motions{suffix}'; did you mean 'motion{suffix}'?"
    assert refused(tmp_path / f"motions{suffix}") == expected


@pytest.mark.parametrize(
    ("module", "name", "what"),
    [("pyarrow.parquet", "motion.parquet", "Parquet files"), ("pyuff", "motion.uff", "UFF files")],
)
def test_a_library_that_is_not_installed_is_named_with_what_to_run(module, name, what, tmp_path, monkeypatch):
    WRITERS[name](tmp_path / name)
    monkeypatch.setitem(sys.modules, module, None)
    assert refused(tmp_path / name) == (
        f"{tmp_path / name}: {module.partition('.')[0]} is needed to read {what}, and is not installed; "
        "run: pip install 'dalembert[data]'"
    )


@pytest.mark.parametrize(("name", "what"), [("a.parquet", "Parquet"), ("a.mat", "MAT"), ("a.nc", "NetCDF")])
@pytest.mark.parametrize("content", [b"", b"no such thing at all, " * 20], ids=["empty", "text"])
def test_a_file_of_another_kind_is_told(name, what, content, tmp_path):
    (tmp_path / name).write_bytes(content)
    assert refused(tmp_path / name).startswith(f"{tmp_path / name}: cannot be read as {what} (")


def test_a_universal_file_without_datasets_is_told(tmp_path):
    (tmp_path / "a.uff").write_text("no datasets\n")
    assert refused(tmp_path / "a.uff").startswith(f"{tmp_path / 'a.uff'}: ")


def test_defects_of_bands_in_other_formats_are_told(tmp_path):
    savemat(tmp_path / "a.mat", {"t": [0.0, 1.0], "low": [0.0, 2.0], "high": [1.0, 1.0]})
    with pytest.raises(DataError) as error:
        read_bands(tmp_path / "a.mat", columns={"x": ("low", "high")})
    assert str(error.value) == (
        f"{tmp_path / 'a.mat'}: channel 'x', sample 1 (time 1 s): the lower bound 2 is larger than the upper bound 1; "
        "expected the lower one first; look whether the columns are exchanged"
    )


def test_a_file_that_ends_the_process_of_its_reader_is_told(tmp_path):
    """One byte of an array's flags changed: SciPy's compiled reader writes where it must not."""
    path = tmp_path / "a.mat"
    savemat(path, {"t": [0.0, 1.0, 2.0], "x": [1.0, 2.0, 3.0]})
    content = bytearray(path.read_bytes())
    content[144] = 5
    path.write_bytes(content)
    assert refused(path) == f"{path}: cannot be read as MAT (it is damaged: the reader broke down over it)"


def damaged(whole, data):
    """A file's bytes with some changed, or the end cut off."""
    content = bytearray(whole)
    for place in data.draw(st.lists(st.integers(0, len(content) - 1), max_size=6)):
        content[place] = data.draw(st.integers(0, 255))
    return content[: data.draw(st.one_of(st.just(len(content)), st.integers(0, len(content))))]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("files")
    for name, write in WRITERS.items():
        write(folder / name)
    return folder


def tried(path, missing="refuse"):
    """Read a file: either the measurements can be used, or a DataError names the file."""
    try:
        found = read(path, missing=missing)
    except DataError as error:
        told = str(error)
    else:
        assert found.values.shape == (len(found.coordinate.values), len(found.channels))
        assert np.all(np.diff(found.coordinate.values) > 0)
        assert not np.any(np.isinf(found.values))
        told = str(path)
    assert told.startswith(str(path))


@pytest.mark.filterwarnings("ignore::ResourceWarning")  # libraries that stumble leave the file to be closed by itself
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
@pytest.mark.parametrize("name", WRITERS)
@settings(max_examples=15, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.data())
def test_a_malformed_file_gives_measurements_or_a_data_error(name, folder, data):
    """Bytes changed anywhere, or the end cut off: whatever the library meets, it is told in our words."""
    path = folder / f"broken-{name}"
    path.write_bytes(damaged((folder / name).read_bytes(), data))
    tried(path, missing=data.draw(st.sampled_from(["refuse", "leave-out"])))


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(text=st.text(alphabet='0123456789.,-e \n"tx;nai', max_size=80))
def test_any_text_gives_measurements_or_a_data_error(text, tmp_path):
    path = tmp_path / "motion.csv"
    path.write_text(f"t,x\n{text}")
    tried(path)


STRUCTURES = {
    "a.npz": lambda path: write_structure(CHAIN, path),
    "sparse.npz": lambda path: write_structure(Structure(csc_array(CHAIN.mass), CHAIN.stiffness, CHAIN.dofs), path),
    "a.mat": lambda path: savemat(path, {"M": CHAIN.mass, "K": CHAIN.stiffness}),
    "a.mtx": lambda path: mmwrite(path, coo_array(CHAIN.stiffness)),
    "abaqus.mtx": lambda path: path.write_text("1,1,1,1,2.0\n2,1,1,1,-1.0\n2,1,2,1,3.0\n"),
    "a.pch": lambda path: path.write_text(DMIG),
}
CHAIN = Structure(np.diag([2.0, 3.0]), np.array([[3.0, -1.0], [-1.0, 4.0]]), Dofs(("1.x", "2.x")))
DMIG = "".join(
    f"DMIG    {name}     0       6       2       0                       2\n"
    f"DMIG*   {name}                            1               1\n*                      1               1 2.0D+00\n"
    f"DMIG*   {name}                            2               1\n*                      2               1 3.0D+00\n"
    for name in ("KAA", "MAA")
)


@pytest.fixture(scope="module")
def structures(tmp_path_factory):
    folder = tmp_path_factory.mktemp("structures")
    for name, write in STRUCTURES.items():
        write(folder / name)
        read_structure(given_as(folder / name))
    return folder


def given_as(path):
    """One file for all, or for each role where it holds one matrix."""
    return {"mass": path, "stiffness": path} if path.suffix == ".mtx" else path


@pytest.mark.filterwarnings("ignore::ResourceWarning")
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
@pytest.mark.parametrize("name", STRUCTURES)
@pytest.mark.parametrize("examples", [8, pytest.param(40, marks=pytest.mark.slow)])
def test_a_malformed_file_of_matrices_gives_a_structure_or_an_error_of_ours(name, examples, structures):
    @settings(max_examples=examples, deadline=None)
    @given(st.data())
    def tried(data):
        path = structures / f"broken-{name}"
        path.write_bytes(damaged((structures / name).read_bytes(), data))
        try:
            assert read_structure(given_as(path)).size > 0
        except DataError as error:
            told = str(error)
        except InputError:  # the file was read, and its matrices make no structure
            told = str(path)
        else:
            told = str(path)
        assert str(path) in told

    tried()
