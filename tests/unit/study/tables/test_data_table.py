"""Tables of data: formats, units, gaps, wraps, derivatives and resampling in a study file."""

import numpy as np
import pytest
from scipy.io import savemat

from dalembert.data import read
from dalembert.errors import DataError, InputError
from dalembert.study.loader import load
from dalembert.study.run.runner import plan
from dalembert.study.tables.data_table import BandsTable
from dalembert.study.tasks import TASKS
from dalembert.study.text.table import Context
from dalembert.units import expected
from support import says

STUDY = """
[parameters]
rate = {{ lower = 0.5, upper = 3.0 }}
[model]
forward = "model.py:spin"
arguments = {{ end = {end}, count = {count} }}
[data]
file = "{file}"
{more}
[identify]
starts = 1
"""
MODEL = """
import numpy as np
from dalembert.forward import PythonModel

def spin(parameters, end=2.0, count=201):
    times = np.linspace(0.0, end, count)
    respond = lambda rate: np.stack([rate * times, rate + 0 * times], axis=1)
    return PythonModel(respond, parameters, ["crank.angle", "crank.rate"], times)
"""
TIMES = np.linspace(0.0, 2.0, 201)


@pytest.fixture
def study(tmp_path):
    (tmp_path / "model.py").write_text(MODEL)
    degrees = (np.rad2deg(2.5 * TIMES) + 180) % 360 - 180
    degrees[20:25] = np.nan
    savemat(tmp_path / "run.mat", {"run": {"ms": 1000 * TIMES, "deg": degrees}})

    def make(more: str, *, end: float = 2.0, count: int = 201, file: str = "run.mat"):
        path = tmp_path / "study.toml"
        path.write_text(STUDY.format(more=more, end=end, count=count, file=file))
        return load(path)

    return make


GIVEN = """
time = "run.ms"
columns = { "crank.angle" = "run.deg" }
units = { "run.ms" = "ms", "run.deg" = "deg" }
missing = "leave-out"
wraps = ["crank.angle"]
"""


def test_data_are_read_from_another_format_in_si_with_gaps_and_wraps(study):
    data = study(GIVEN).data()
    assert data.channels == ("crank.angle",)
    assert (data.missing, data.wraps) == ("leave-out", ("crank.angle",))
    np.testing.assert_allclose(data.coordinate.values, TIMES, atol=1e-15)
    np.testing.assert_array_equal(np.flatnonzero(~data.present[:, 0]), np.arange(20, 25))
    np.testing.assert_allclose(data.difference(2.5 * TIMES[:, None])[data.present], 0, atol=1e-12)


def test_a_study_with_gaps_and_wraps_runs(study, tmp_path):
    case = study(GIVEN + 'derivatives = { "crank.rate" = "crank.angle" }')
    assert plan(case).startswith("identifies rate from 201 samples of crank.angle, crank.rate by LeastSquares")

    outcome = TASKS["identify"].run(case, lambda *_, **__: None)
    assert outcome.best["values"]["rate"] == pytest.approx(2.5, rel=1e-9)


def test_derivatives_have_the_deviation_given_or_that_of_their_error(study):
    told = 'deviations = { "crank.angle" = "0.1 deg" }\n'
    automatic = study(GIVEN + told + 'derivatives = { "crank.rate" = "crank.angle" }').data()
    assert automatic.deviations[0] == pytest.approx(np.deg2rad(0.1))
    assert 1e-4 < automatic.deviations[1] < 1e-1
    np.testing.assert_allclose(automatic.values[automatic.present[:, 1], 1], 2.5, atol=1e-9)
    told = 'deviations = { "crank.angle" = "0.1 deg", "crank.rate" = "3 deg/s" }\n'
    table = 'derivatives = { "crank.rate" = { of = "crank.angle", window = 9, degree = 2 } }'
    assert study(GIVEN + told + table).data().deviations[1] == pytest.approx(np.deg2rad(3))


@pytest.mark.parametrize(
    ("more", "times"),
    [
        ('between = ["500 ms", 1.0]', TIMES[50:101]),
        ("every = 40", TIMES[::40]),
        ("between = [0.5, 1.0]\nevery = 10", TIMES[50:101:10]),
        ("resample = [0.0, 0.333, 2.0]", np.array([0.0, 0.333, 2.0])),
        ('resample = { end = "2 s", every = "125 ms" }', np.linspace(0, 2, 17)),
    ],
)
def test_samples_are_chosen_or_interpolated(study, more, times):
    data = study(GIVEN + more).data()
    np.testing.assert_allclose(data.coordinate.values, times, atol=1e-15)
    np.testing.assert_allclose(data.difference(2.5 * times[:, None])[data.present], 0, atol=1e-9)


def test_data_are_filtered_and_decimated(study):
    table = 'time = "t"\ncolumns = { "crank.angle" = "x" }\ndeviations = { "crank.angle" = 0.1 }\n'
    times = np.arange(2000) / 1000
    values = np.sin(5 * times) + np.sin(600 * times)
    folder = study(GIVEN).path.parent
    rows = [f"{t},{x}" for t, x in zip(times, values, strict=True)]
    (folder / "fast.csv").write_text("\n".join(["t,x", *rows]))
    raw = read(folder / "fast.csv", columns={"crank.angle": "x"}, deviations=0.1)
    for more, expected_data in (
        ('lowpass = "30 Hz"', raw.filtered(30.0)),
        ("decimate = 5", raw.decimated(5)),
        ('lowpass = "0.03 kHz"\ndecimate = 5\nbetween = [0.5, 1.0]', raw.decimated(5, 30.0).between(0.5, 1.0)),
    ):
        data = study(table + more, file="fast.csv").data()
        np.testing.assert_array_equal(data.values, expected_data.values)
        np.testing.assert_array_equal(data.deviations, expected_data.deviations)
    found = study(table + 'lowpass = "30 Hz"\nderivatives = { "crank.rate" = "crank.angle" }', file="fast.csv").data()
    inside = slice(100, -100)
    np.testing.assert_allclose(found.values[inside, 1], 5 * np.cos(5 * times)[inside], atol=0.1)


@pytest.fixture
def sweep(study, tmp_path):
    """A study of data over frequency."""
    lines = [f"{f},{2.5 * f}" for f in np.linspace(10.0, 30.0, 21)]
    (tmp_path / "sweep.csv").write_text("\n".join(["f,x", *lines]))
    return lambda more: study('frequency = "f"\ncolumns = { "crank.angle" = "x" }\n' + more, file="sweep.csv")


@pytest.mark.parametrize(
    ("more", "frequencies"),
    [
        ('between = ["12 Hz", "0.015 kHz"]', [12.0, 13.0, 14.0, 15.0]),
        ("between = [12, 14]", [12.0, 13.0, 14.0]),
        ('resample = ["12.5 Hz", 13.5]', [12.5, 13.5]),
        ('resample = { start = "12 Hz", end = "14 Hz", every = "500 mHz" }', [12.0, 12.5, 13.0, 13.5, 14.0]),
    ],
)
def test_samples_over_frequency_are_chosen_by_frequencies(sweep, more, frequencies):
    data = sweep(more).data()
    assert (data.coordinate.name, data.coordinate.unit) == ("frequency", "Hz")
    np.testing.assert_allclose(data.coordinate.values, frequencies, rtol=1e-12)
    np.testing.assert_allclose(data.values[:, 0], 2.5 * np.array(frequencies), rtol=1e-12)


FREQUENCY, TIME = (f"expected {expected(unit)}" for unit in ("Hz", "s"))


@pytest.mark.parametrize(
    ("more", "sentence"),
    [
        ('between = ["12 ms", "15 ms"]', f"[data], between: '12 ms' was given; {FREQUENCY}"),
        ('resample = { end = "2 s", count = 3 }', f"[data.resample]: '2 s' was given; {FREQUENCY}"),
    ],
)
def test_times_along_a_frequency_are_refused(sweep, more, sentence):
    with pytest.raises(InputError, match=says(f"study.toml: {sentence}")):
        sweep(more)


@pytest.mark.parametrize(
    ("more", "sentence"),
    [
        ('between = ["12 Hz", "15 Hz"]', f"[data], between: '12 Hz' was given; {TIME}"),
        ("resample = [0.0, true]", f"[data], resample: True was given; {TIME}"),
    ],
)
def test_frequencies_along_a_time_are_refused(study, more, sentence):
    with pytest.raises(InputError, match=says(f"study.toml: {sentence}")):
        study(GIVEN + more)


def test_samples_that_are_not_there_are_told_as_frequencies(sweep):
    sentence = "sweep.csv: no sample lies from 40 to 50; the frequency runs from 10 to 30 Hz"
    with pytest.raises(DataError, match=sentence):
        sweep("between = [40, 50]").data()
    sentence = (
        "frequency 5 Hz lies outside the data, which run from 10 to 30 Hz; expected samples within; nothing is known"
    )
    with pytest.raises(DataError, match=sentence):
        sweep("resample = [5, 12]").data()


def test_the_settings_of_a_table_are_in_si(study):
    settings = study(GIVEN + 'resample = { end = "2 s", count = 3 }\nderivatives = { v = "crank.angle" }').settings
    assert settings["data"]["resample"] == [0.0, 1.0, 2.0]
    assert settings["data"]["derivatives"] == {"v": {"of": "crank.angle"}}
    assert settings["data"]["units"] == {"run.ms": "ms", "run.deg": "deg"}


@pytest.mark.parametrize(
    ("more", "sentences"),
    [
        (
            'columns = { "crank.angle" = "run.deg" }\nwraps = ["crank.angel"]',
            ["study.toml: [data]: wraps: unknown channel 'crank.angel'; did you mean 'crank.angle'?"],
        ),
        (
            'columns = { a = "run.deg" }\nderivatives = { a = "b" }\nevery = 2\nresample = [0.0, 1.0]',
            [
                "study.toml: [data]: derivatives: the channel 'a' has a column already; expected another name",
                "study.toml: [data]: derivatives, 'a': unknown channel 'b'; known: a",
                "study.toml: [data]: every and resample are both given; expected one of them",
            ],
        ),
        (
            'columns = { a = "run.deg", b = "run.deg" }',
            ["study.toml: [data]: columns: 'run.deg' is given for 2 channels; expected one channel for a column"],
        ),
        (
            'columns = { a = "run.deg" }\nmissing = "ignore"',
            ["study.toml: [data], missing: 'ignore' was given; expected 'refuse' or 'leave-out'"],
        ),
        (
            'columns = { a = "run.deg" }\nformat = "xls"',
            [
                "study.toml: [data], format: 'xls' was given; expected 'csv', 'hdf5', 'json', 'lvm', 'mat', 'mcap', 'mdf', "
                "'netcdf', 'npz', 'parquet', 'tdms', 'uff', 'xlsx' or 'zip'; did you mean 'xlsx'?",
            ],
        ),
    ],
)
def test_a_mistake_in_the_table_is_told_with_its_place(study, more, sentences):
    with pytest.raises(InputError) as error:
        study(more)
    assert str(error.value).split("\n") == sentences


def test_bands_are_read_in_other_units(tmp_path):

    (tmp_path / "bounds.csv").write_text("ms,low,high\n0,1,2\n10,3,4\n")

    given = {"file": "bounds.csv", "time": "ms", "columns": {"x": ["low", "high"]}}
    given["units"] = {"ms": "ms", "low": "mm", "high": "mm"}
    bands = BandsTable.model_validate(given, context=Context(tmp_path)).read()
    assert bands.coordinate.values.tolist() == [0.0, 0.01]
    assert bands.upper.tolist() == [[0.002], [0.004]]


SWINGING = """
[parameters]
viscous = { lower = 0.01, upper = 0.1 }
[model]
[[model.body]]
kind = "RigidBar"
name = "bar"
length = 1.0
mass = 0.5
angle = 0.0
[[model.joint]]
kind = "RevoluteJoint"
name = "pin"
a = "ground"
b = "bar.start"
viscous = "viscous"
[solver]
step = "5 ms"
[data]
file = "swing.csv"
columns = { "bar.end.x" = "x" }
[identify]
starts = 1
"""


@pytest.mark.parametrize(
    ("lines", "sentence"),
    [
        (
            "-3,1\n2,1\n",
            "the times reach from -3 to 2 s, and the motion begins at 0 s; shift the times in the file so that 0 s is "
            "where the motion begins, or keep those from there on by between in the study file",
        ),
        ("0,1\n", "the last of the times is 0 s; expected samples of a motion of some duration"),
    ],
)
def test_times_of_data_outside_the_motion_are_told_with_the_file(lines, sentence, tmp_path):
    (tmp_path / "study.toml").write_text(SWINGING)
    (tmp_path / "swing.csv").write_text(f"t,x\n{lines}")
    with pytest.raises(DataError, match=says(f"{tmp_path / 'swing.csv'}: {sentence}")):
        plan(load(tmp_path / "study.toml"))


def test_a_text_file_with_semicolons_and_decimal_commas(study, tmp_path):
    (tmp_path / "run.csv").write_text("t;angle\n0,0;0,0\n2,0;5,0\n")
    columns = 'columns = { "crank.angle" = "angle" }\n'
    read = study(columns + 'separator = ";"\ndecimal = ","', file="run.csv").data()
    assert (read.coordinate.values.tolist(), read.values.tolist()) == ([0.0, 2.0], [[0.0], [5.0]])
    sentence = "study.toml: [data], decimal: ';' was given; expected 'auto', '.' or ','"
    with pytest.raises(InputError, match=says(sentence)):
        study(columns + 'decimal = ";"', file="run.csv")


def test_data_at_uneven_times_are_resampled_before_they_are_filtered(study, tmp_path):
    times = np.linspace(0, 2, 401) + 4e-4 * np.random.default_rng(1).uniform(-1, 1, 401)
    times[0], times[-1] = 0.0, 2.0
    rows = [f"{t!r},{float(np.sin(3 * t))!r}" for t in times.tolist()]
    (tmp_path / "uneven.csv").write_text("\n".join(["t,x", *rows]))
    table = 'columns = { "crank.angle" = "x" }\nlowpass = "20 Hz"\n'
    with pytest.raises(DataError, match="not evenly spaced"):
        study(table, file="uneven.csv").data()
    data = study(table + 'resample = { end = 2.0, every = "5 ms" }\n', file="uneven.csv").data()
    raw = read(tmp_path / "uneven.csv", columns={"crank.angle": "x"})
    expected_values = raw.resampled(np.linspace(0, 2, 401)).filtered(20.0).values
    np.testing.assert_array_equal(data.values, expected_values)
