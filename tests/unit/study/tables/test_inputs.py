"""Measured inputs of a study file: columns of files that drive the model."""

from pathlib import Path

import numpy as np
import pytest

import dalembert.multibody as mb
from dalembert.errors import DalembertError, DataError, InputError
from dalembert.study import load, run_study
from dalembert.study.run.runner import plan
from dalembert.study.tables.posing import posed

TIMES = np.linspace(0.0, 1.0, 201)
CURRENT = np.sin(9.0 * TIMES) + 0.4 * np.cos(31.0 * TIMES)
TRUE = {"constant": 0.35, "late": 0.007, "drag": 0.02}

MODEL = """
[parameters]
constant = { lower = 0.1, upper = 1.0, unit = "N*m/A" }
late = { lower = 0.0, upper = "20 ms" }
drag = { lower = 0.0, upper = 0.1 }
[[model.body]]
kind = "RigidBar"
name = "bar"
length = 0.5
mass = 0.4
angle = "-90 deg"
[[model.joint]]
kind = "RevoluteJoint"
name = "pin"
a = "ground"
b = "bar.start"
viscous = "drag"
[[model.load]]
kind = "Torque"
name = "motor"
at = "bar.start"
torque = { input = "current" }
[solver]
step = "2 ms"
"""
INPUT = """
[inputs.current]
column = "i"
unit = "mA"
scale = "constant"
delay = "late"
"""
DATA = """
[data]
file = "record.csv"
time = "ms"
columns = { "bar.start.angle" = "angle" }
units = { ms = "ms", angle = "deg" }
deviations = { "bar.start.angle" = 1e-4 }
between = [0.1, 0.9]
[identify]
starts = 1
"""


def system(course: mb.Signal, drag: float = TRUE["drag"]) -> mb.System:
    made = mb.System()
    bar = made.add(mb.RigidBar("bar", 0.5, 0.4, angle=-np.pi / 2))
    made.add(mb.RevoluteJoint("pin", made.ground, bar.start, viscous=drag))
    made.add(mb.Torque("motor", bar.start, course))
    return made


def moved(current: np.ndarray = CURRENT, kind: str = "linear", **more) -> np.ndarray:
    given = {"scale": TRUE["constant"], "delay": TRUE["late"]} | more
    motion = mb.simulate(system(mb.Table(TIMES, current, kind, **given)), 1.0, mb.GeneralizedAlpha(step=2e-3), TIMES)
    return motion.channels(["bar.start.angle"])[:, 0]


def written(path: Path, angle: np.ndarray, current: np.ndarray = CURRENT) -> None:
    columns = (1000 * TIMES, np.rad2deg(angle), 1000 * current)
    rows = [f"{t!r},{a!r},{i!r}" for t, a, i in zip(*(column.tolist() for column in columns), strict=True)]
    path.write_text("\n".join(["ms,angle,i", *rows]))


@pytest.fixture
def folder(tmp_path):
    written(tmp_path / "record.csv", moved())
    return tmp_path


def study(folder: Path, text: str):
    path = folder / "study.toml"
    path.write_text(text)
    return load(path)


def test_a_column_of_the_data_drives_the_model_in_units_scaled_and_delayed(folder):
    case = study(folder, MODEL + INPUT + DATA)
    assert plan(case).startswith("identifies constant, late, drag from 161 samples of bar.start.angle")
    model, data = posed(case)
    response = model.evaluate(np.array(list(TRUE.values()))).only()[0]
    np.testing.assert_allclose(response, data.values, rtol=0, atol=2e-6)  # the steps end at 0.9 s, not at 1 s


def test_numbers_of_an_input_are_identified(folder, tmp_path):
    _, outcome = run_study(study(folder, MODEL + INPUT + DATA), tmp_path / "run")
    found = outcome.best["values"]
    for name, value in TRUE.items():
        assert found[name] == pytest.approx(value, abs=3e-5), name
    copies = sorted(path.name for path in (tmp_path / "run" / "inputs").iterdir())
    assert copies == ["0-record.csv"]


def test_an_input_is_in_a_file_of_its_own_with_other_times_and_settings(folder):
    rows = [f"{1000 * t!r};{i!r}" for t, i in zip(TIMES.tolist(), CURRENT.tolist(), strict=True)]
    (folder / "drive.txt").write_text("\n".join(["ms;amps", *rows]))
    table = """
[inputs.current]
file = "drive.txt"
column = "amps"
time = "ms"
units = { ms = "ms" }
separator = ";"
interpolation = "cubic"
scale = "constant"
offset = "constant*0.1"
lowpass = "12 Hz"
"""
    case = study(folder, MODEL + table + DATA)
    (one,) = case.inputs.values()
    signal = one.signal(TRUE)
    assert (signal.interpolation, signal.scale, signal.delay) == ("cubic", 0.35, 0.0)
    assert signal.offset == pytest.approx(0.035)
    np.testing.assert_allclose(signal.times, TIMES, atol=1e-12)
    assert 1e-4 < np.abs(signal.values - CURRENT)[20:-20].max() < 0.01  # behind the filter
    assert set(case.files) == {"record.csv", "drive.txt"}


EXPERIMENTS = """
[[experiments]]
name = "first"
file = "record.csv"
time = "ms"
columns = { "bar.start.angle" = "angle" }
units = { ms = "ms", angle = "deg" }
[[experiments]]
name = "second"
file = "second.csv"
time = "ms"
columns = { "bar.start.angle" = "angle" }
units = { ms = "ms", angle = "deg" }
inputs.current.column = "j"
inputs.current.interpolation = "held"
inputs.current.delay = 0.0
[[experiments]]
name = "third"
file = "record.csv"
time = "ms"
columns = { "bar.start.angle" = "angle" }
units = { ms = "ms", angle = "deg" }
inputs.current = { file = "second.csv", column = "j", time = "ms", units = { ms = "ms" } }
[identify]
"""


def test_each_experiment_has_the_input_of_its_own_file(folder):
    other = CURRENT[::-1]
    written(folder / "second.csv", moved(other, "held", delay=0.0), other)
    (folder / "second.csv").write_text((folder / "second.csv").read_text().replace("ms,angle,i", "ms,angle,j"))
    experiments, _ = posed(study(folder, MODEL + INPUT + EXPERIMENTS))
    vector = np.array(list(TRUE.values()))
    for one in experiments[:2]:
        response = one.model.evaluate(vector).only()[0]
        np.testing.assert_allclose(response, one.data.values, rtol=0, atol=1e-9)
    driven = experiments[2].model.evaluate(vector).only()[0][:, 0]
    np.testing.assert_allclose(driven, moved(other), rtol=0, atol=1e-9)


def test_the_start_of_the_data_is_that_of_an_input_in_their_file(folder):
    lines = (folder / "record.csv").read_text().splitlines()
    late = [f"{float(line.partition(',')[0]) + 48200},{line.partition(',')[2]}" for line in lines[1:]]
    (folder / "record.csv").write_text("\n".join([lines[0], *late]))
    vector = np.array(list(TRUE.values()))
    for start in ('"first"', '"48.2 s"'):
        text = DATA.replace("between = [0.1, 0.9]", f"start = {start}")
        model, data = posed(study(folder, MODEL + INPUT + text))
        np.testing.assert_allclose(data.coordinate.values, TIMES, rtol=0, atol=1e-9)
        np.testing.assert_allclose(model.evaluate(vector).only()[0], data.values, rtol=0, atol=1e-8)


def test_an_input_in_another_file_has_a_start_of_its_own(folder):
    rows = [f"{t + 7.5!r},{i!r}" for t, i in zip(TIMES.tolist(), CURRENT.tolist(), strict=True)]
    (folder / "drive.csv").write_text("\n".join(["t,i", *rows]))
    table = INPUT.replace('unit = "mA"', 'file = "drive.csv"')
    for start in ('"first"', "7.5"):
        (one,) = study(folder, MODEL + table + f"start = {start}\n" + DATA).inputs.values()
        np.testing.assert_allclose(one.times, TIMES, rtol=0, atol=1e-9)


def test_each_trial_of_a_file_has_its_own_input(folder):
    rows = ["run,t,angle,i"]
    currents = (CURRENT, CURRENT[::-1])
    for run, current in enumerate(currents):
        rows += [
            f"{run},{t!r},{a!r},{1000 * i!r}"
            for t, a, i in zip(TIMES.tolist(), moved(current).tolist(), current.tolist(), strict=True)
        ]
    (folder / "trials.csv").write_text("\n".join(rows))
    text = """
[[experiments]]
name = "run"
file = "trials.csv"
split = "run"
columns = { "bar.start.angle" = "angle" }
[identify]
"""
    experiments, _ = posed(study(folder, MODEL + INPUT + text))
    assert [one.name for one in experiments] == ["run-0", "run-1"]
    for one in experiments:
        response = one.model.evaluate(np.array(list(TRUE.values()))).only()[0]
        np.testing.assert_allclose(response, one.data.values, rtol=0, atol=1e-8)


def test_an_acceleration_moves_the_base_of_a_model(folder):
    """Simulated without data: the input has its own file."""
    text = """
[inputs.shaker]
file = "record.csv"
time = "ms"
units = { ms = "ms" }
column = "i"
integrals = 2
interpolation = "cubic"
[[model.body]]
kind = "PointMass"
name = "base"
mass = 1.0
[[model.joint]]
kind = "PrescribedMotion"
name = "shake"
a = "ground(0, 0)"
b = "base.centre"
coordinate = "x"
motion = { input = "shaker" }
[solver]
step = "5 ms"
[simulate]
end = 1.0
"""
    motion = study(folder, text).motion(1.0)
    t = motion.times
    expected = 1000 * (-np.sin(9 * t) / 81 + t / 9 + 0.4 * (1 - np.cos(31 * t)) / 31**2)
    np.testing.assert_allclose(motion.channels(["base.centre.x"])[:, 0], expected, rtol=1e-4, atol=1e-4)


def test_a_function_is_given_the_signal(folder):
    (folder / "model.py").write_text(
        """
import numpy as np
import dalembert.multibody as mb

def driven(constant, late, drag, course):
    made = mb.System()
    bar = made.add(mb.RigidBar("bar", 0.5, 0.4, angle=-np.pi / 2))
    made.add(mb.RevoluteJoint("pin", made.ground, bar.start, viscous=drag))
    made.add(mb.Torque("motor", bar.start, course))
    return made
"""
    )
    head, _, _ = MODEL.partition("[[model.body]]")
    text = head + '[model]\nfunction = "model.py:driven"\narguments = { course = { input = "current" } }\n'
    model, _ = posed(study(folder, text + '[solver]\nstep = "2 ms"\n' + INPUT + DATA))
    own, _data = posed(study(folder, MODEL + INPUT + DATA))
    vector = np.array(list(TRUE.values()))
    np.testing.assert_array_equal(model.jacobian(vector), own.jacobian(vector))


COMPARED = """
[work_precision]
end = "1 s"
channels = ["bar.start.angle"]
[[work_precision.reference]]
kind = "RadauIIA"
[[work_precision.reference]]
kind = "RungeKutta4"
step = 1e-3
[[work_precision.series]]
name = "alpha"
solver = { step = 0.01 }
over = { step = [0.01, 0.005] }
"""
SHORT = """
[inputs.current]
file = "short.csv"
column = "i"
"""


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (
            MODEL.replace("current", "curent") + INPUT + DATA,
            "[[model.load]] 'motor', torque: unknown input 'curent'; did you mean 'current'?",
        ),
        (
            MODEL.replace('{ input = "current" }', "1.0") + INPUT + DATA,
            "[inputs.current] is used nowhere in [model]; write { input = 'current' } where a signal may stand",
        ),
        (
            MODEL + INPUT.replace('column = "i"', "") + DATA,
            "[inputs.current]: the key 'column' is missing; expected the name of a column",
        ),
        (
            MODEL + INPUT + '[simulate]\nend = "1 s"',
            "[inputs.current]: the key 'file' is missing, and there are no [data] with a file",
        ),
        (
            MODEL + INPUT + 'separator = ";"' + DATA,
            "[inputs.current]: separator: an input from the data's file is read as the data are; give a file too",
        ),
        (
            MODEL + SHORT.replace("short", "record") + "start = { lower = 0.0, upper = 1.0 }" + DATA,
            "[inputs.current]: start: bounds were given; expected a number of seconds of the file, or 'first'",
        ),
        (
            MODEL + INPUT + 'interpolation = "held"' + DATA,
            "[inputs.current], delay: the response to a held input has no derivative by its delay, since each change "
            "of the value moves in time as a jump; take interpolation = 'linear', or a delay that depends on no parameter",
        ),
        (
            MODEL + INPUT + 'interpolation = "hold"' + DATA,
            "[inputs.current], interpolation: 'hold' was given; expected 'linear', 'cubic' or 'held'",
        ),
        (
            MODEL + INPUT + EXPERIMENTS.replace("inputs.current.interpolation", "inputs.curent.interpolation"),
            "[[experiments]] 'second', inputs: unknown input 'curent'; did you mean 'current'?",
        ),
        (
            MODEL.replace('{ input = "current" }', '{ input = "current", scale = 2 }') + INPUT + DATA,
            "unknown key 'scale'; known: input",
        ),
    ],
)
def test_a_mistake_about_inputs_is_told_with_its_place(folder, text, sentence):
    written(folder / "second.csv", moved())
    with pytest.raises(InputError) as error:
        study(folder, text)
    assert sentence in str(error.value)


@pytest.mark.parametrize(
    ("text", "kind", "sentence"),
    [
        (
            MODEL + INPUT.replace('"i"', '"amps"') + DATA,
            DataError,
            "unknown column 'amps'; did you mean 'ms'?",
        ),
        (
            MODEL + SHORT + DATA,
            DataError,
            "has values from 0 to 0.5 s, and the motion lasts from 0 to 0.9 s; expected an input that lasts as long. "
            "Choose samples of the data by between, or another start of the times",
        ),
        (
            MODEL + SHORT + '[simulate]\nend = "1 s"',
            DataError,
            "has values from 0 to 0.5 s, and the motion lasts from 0 to 1 s; expected an input that lasts as long.",
        ),
        (
            MODEL.replace('[solver]\nstep = "2 ms"', "") + SHORT + COMPARED,
            DataError,
            "has values from 0 to 0.5 s, and the motion lasts from 0 to 1 s; expected an input that lasts as long.",
        ),
    ],
)
def test_an_input_that_cannot_drive_the_motion_is_refused(folder, text, kind, sentence):
    rows = [f"{t!r},{i!r}" for t, i in zip(TIMES[:101].tolist(), CURRENT[:101].tolist(), strict=True)]
    (folder / "short.csv").write_text("\n".join(["t,i", *rows]))
    with pytest.raises(kind) as error:
        plan(study(folder, text))
    assert sentence in str(error.value)
    assert isinstance(error.value, DalembertError)


def test_an_input_at_uneven_times_is_resampled_and_filtered(folder):
    times = np.arange(1001) * 1e-3 + 3e-4 * np.random.default_rng(3).uniform(-1, 1, 1001)
    times[[0, -1]] = 0.0, 1.0
    values = np.sin(5 * times) + 0.2 * np.sin(2 * np.pi * 100 * times)
    rows = [f"{t!r},{v!r}" for t, v in zip(times.tolist(), values.tolist(), strict=True)]
    (folder / "drive.csv").write_text("\n".join(["t,amps", *rows]))
    table = '[inputs.current]\nfile = "drive.csv"\ncolumn = "amps"\nscale = "constant"\nlowpass = "20 Hz"\n'
    with pytest.raises(DataError, match="the samples are not evenly spaced"):
        study(folder, MODEL + table + DATA).inputs  # noqa: B018
    (one,) = study(folder, MODEL + table + 'resample = { end = 1.0, every = "1 ms" }\n' + DATA).inputs.values()
    np.testing.assert_allclose(one.times, np.arange(1001) * 1e-3, atol=1e-12)
    inside = slice(100, -100)
    np.testing.assert_allclose(one.values[inside], np.sin(5 * one.times)[inside], atol=1e-3)
