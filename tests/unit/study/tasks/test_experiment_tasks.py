"""Studies of several experiments, of sensors, losses and validation."""

import numpy as np
import pytest
from scipy.interpolate import make_interp_spline

from dalembert.errors import DataError, InputError
from dalembert.inverse import Prediction
from dalembert.study import load, plan, report_run, run_study
from dalembert.study.run.runner import unknowns
from dalembert.study.tables.posing import posed
from pages import read_page

DECAY = """
import numpy as np
from dalembert.forward import PythonModel

def decay(parameters, end, samples):
    times = np.linspace(0, end, samples)
    return PythonModel(lambda size, rate: size * np.exp(-rate * times), parameters, ["x"], times)
"""
HEAD = """
[parameters]
size = { lower = 0.5, upper = 4.0 }
rate = { lower = 0.1, upper = "3 1/s" }
[model]
forward = "decay.py:decay"
arguments = { end = 2.0, samples = 21 }
"""
TWO = (
    HEAD
    + """
[[experiments]]
name = "short"
file = "short.csv"
columns = { x = "x" }
local = ["size"]
[[experiments]]
name = "long"
file = "long.csv"
columns = { x = "x" }
local = ["size"]
arguments = { end = 5.0, samples = 41 }
"""
)
TIMES = {"short": np.linspace(0, 2, 21), "long": np.linspace(0, 5, 41)}
SIZES = {"short": 2.0, "long": 1.5}
PENDULUM = """
[constants]
L = "800 mm"
begin = "30 deg"
[parameters]
drag = { lower = 0.0, upper = 0.5, unit = "N*m*s" }
[model]
[[model.body]]
kind = "RigidBar"
name = "rod"
length = "L"
mass = 1.5
angle = "-begin"
[[model.joint]]
kind = "RevoluteJoint"
name = "pin"
a = "ground"
b = "rod.start"
viscous = "drag"
[solver]
step = "2 ms"
"""


OWN = TWO.replace('local = ["size"]', "local = { size = { lower = 1.0, upper = 1.7, start = 1.2 } }").replace(
    "local = { size = { lower = 1.0, upper = 1.7, start = 1.2 } }", 'local = ["size"]', 1
)


def table(path, times, values):
    path.write_text("\n".join(["t,x", *(f"{t!r},{x!r}" for t, x in zip(times.tolist(), values.tolist(), strict=True))]))


@pytest.fixture
def write(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "decay.py").write_text(DECAY)
    for name, times in TIMES.items():
        table(tmp_path / f"{name}.csv", times, SIZES[name] * np.exp(-0.8 * times))

    def write(text):
        path = tmp_path / "study.toml"
        path.write_text(text)
        return path

    return write


def test_experiments_share_parameters_and_have_their_own(write, tmp_path):
    study = load(write(TWO + "[identify]\nweights = { x = 4.0 }\n"))
    assert unknowns(study) == ("short.size", "rate", "long.size")
    assert plan(study).startswith(
        "identifies short.size, rate, long.size from 2 experiments (short: 21 samples of x; long: 41 samples of x) by "
        "LeastSquares: about 40 simulations a start"
    )
    folder, outcome = run_study(study, tmp_path / "run")
    assert outcome.best["values"] == pytest.approx({"short.size": 2.0, "rate": 0.8, "long.size": 1.5})
    assert {path.name for path in (folder.path / "inputs").iterdir()} == {"0-decay.py", "1-short.csv", "2-long.csv"}
    page = read_page(report_run(folder))
    assert "short: x" in page.text
    assert "long: x" in page.text


def test_losses_and_validation_come_from_the_study(write, tmp_path):
    task = '[identify]\nloss = "cauchy"\nloss_scale = 0.1\nvalidation = ["long"]\n'
    text = TWO.replace('local = ["size"]\narguments', "arguments") + task
    with pytest.raises(InputError, match="parameter 'size' belongs to experiments for validation alone"):
        run_study(load(write(text)), tmp_path / "refused")
    _, outcome = run_study(load(write(text.replace('local = ["size"]', ""))), tmp_path / "run")
    assert outcome.best["values"] == pytest.approx({"size": 2.0, "rate": 0.8})
    assert "Not fitted: the experiment 'long'." in outcome.summary
    assert "weighted residuals exceed 0.1" in outcome.status


def test_a_share_is_kept_for_validation(write, tmp_path):
    text = HEAD + '[data]\nfile = "short.csv"\ncolumns = { x = "x" }\n[identify]\nvalidation = 0.25\n'
    _, outcome = run_study(load(write(text)), tmp_path / "run")
    assert "Not fitted: the last 5 of 21 samples." in outcome.summary


@pytest.mark.parametrize("sensor", ["rod.end.x", "rod"], ids=["channel", "component"])
def test_sensors_read_a_mechanism_between_the_steps_of_the_solver(sensor, write, tmp_path):
    data = '[data]\nfile = "x.csv"\ncolumns = { "rod.end.x" = "x" }\n'
    sensors = f'[sensors."{sensor}"]\ndelay = [0, "30 ms"]\ngain = [0.5, 2.0]\nat_rest = true\n'
    text = PENDULUM + data + sensors + "[identify]\n"
    stamps = np.arange(0, 60) * 0.025
    study = load(write(PENDULUM + "[simulate]\nend = 1.5\n"))
    exact = study.forward(["rod.end.x"], np.arange(0, 1501) * 1e-3).evaluate(np.array([[0.2]])).only()[0, :, 0]
    late = np.interp(stamps - 0.012, np.arange(0, 1501) * 1e-3, exact)
    table(tmp_path / "x.csv", stamps, 1.1 * late)
    study = load(write(text))
    assert unknowns(study) == ("drag", f"{sensor} delay", f"{sensor} gain")
    assert plan(study).startswith(f"identifies drag, {sensor} delay, {sensor} gain from 60 samples of rod.end.x by ")
    folder, outcome = run_study(study, tmp_path / "run")
    values = {"drag": 0.2, f"{sensor} delay": 0.012, f"{sensor} gain": 1.1}
    assert outcome.best["values"] == pytest.approx(values, rel=1e-3)
    assert folder.report.is_file()


def test_the_lag_of_a_sensor_is_identified_in_the_unit_of_the_study(write, tmp_path):
    data = '[data]\nfile = "x.csv"\ncolumns = { "rod.end.x" = "x" }\n'
    text = PENDULUM + data + '[sensors."rod.end.x"]\nlag = [0, "100 ms"]\n[identify]\n'
    fine, lag = np.arange(0, 150_001) * 1e-5, 0.04
    study = load(write(PENDULUM + "[simulate]\nend = 1.5\n"))
    steps = study.forward(["rod.end.x"], fine[::100]).evaluate(np.array([[0.2]])).only()[0, :, 0]
    true, read = make_interp_spline(fine[::100], steps, k=5)(fine), np.empty_like(fine)
    read[0] = true[0]
    for k in range(len(fine) - 1):  # the trapezoidal rule for lag y' + y = x
        half = 0.5e-5 / lag
        read[k + 1] = ((1 - half) * read[k] + half * (true[k] + true[k + 1])) / (1 + half)
    table(tmp_path / "x.csv", fine[::2500], read[::2500])
    study = load(write(text))
    assert unknowns(study) == ("drag", "rod.end.x lag")
    _, outcome = run_study(study, tmp_path / "run")
    assert outcome.best["values"] == pytest.approx({"drag": 0.2, "rod.end.x lag": lag}, rel=1e-4)


def test_experiments_may_differ_in_constants(write, tmp_path):
    times = np.arange(0, 41) * 0.05
    texts = []
    for name, begin in (("low", "30 deg"), ("high", "80 deg")):
        study = load(write(PENDULUM.replace('"30 deg"', f'"{begin}"') + "[simulate]\nend = 2.0\n"))
        table(
            tmp_path / f"{name}.csv",
            times,
            study.forward(["rod.end.x"], times).evaluate(np.array([[0.2]])).only()[0, :, 0],
        )
        constants = f'constants = {{ begin = "{begin}" }}\n' if name == "high" else ""
        texts.append(
            f'[[experiments]]\nname = "{name}"\nfile = "{name}.csv"\ncolumns = {{ "rod.end.x" = "x" }}\n{constants}'
        )
    folder, outcome = run_study(load(write(PENDULUM + "".join(texts) + "[identify]\n")), tmp_path / "run")
    assert outcome.best["values"] == pytest.approx({"drag": 0.2}, rel=1e-6)
    assert outcome.best["misfit"] < 1e-15
    page = read_page(folder.report)
    drawn = {entries["data-name"] for tag, entries in page.tags if tag == "script" and "data-name" in entries}
    assert {"mechanism-1", "mechanism-2", "energies-1", "energies-2"} <= drawn
    rows = page.table("diagnostics")
    assert {row[0] for row in rows[1:]} == {"low", "high"}
    assert "Not drawn" not in page.text


def test_each_experiment_has_its_prediction(write, tmp_path):
    folder, outcome = run_study(load(write(TWO + "[identify]\nprediction = true\nlevel = 0.9\n")), tmp_path / "run")
    told = {name: Prediction.load(folder.path / f"prediction-{name}.nc") for name in ("short", "long")}
    assert [len(one.coordinate.values) for one in told.values()] == [21, 41]
    np.testing.assert_allclose(told["long"].response[:, 0], 1.5 * np.exp(-0.8 * TIMES["long"]), rtol=1e-6)
    assert told["short"].level == 0.9
    for name, one in told.items():
        assert f"experiment {name}\n{one.summary()}" in outcome.summary
    first = folder.report.read_text()
    page = read_page(folder.report)
    assert "short: The 90 % band of the response is at most" in page.text
    assert [row[0] for row in page.table("prediction")] == ["experiment", "short", "long"]
    drawn = {entries["data-name"] for tag, entries in page.tags if tag == "script" and "data-name" in entries}
    assert {"prediction-1-1", "prediction-2-1"} <= drawn
    folder.report.unlink()
    report_run(folder)
    assert folder.report.read_text() == first


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (
            TWO.replace('"long"', '"short"') + "[identify]\n",
            "[[experiments]]: short is given more than once; expected different names",
        ),
        (
            TWO + '[data]\nfile = "short.csv"\ncolumns = { x = "x" }\n[identify]\n',
            "[data] and [[experiments]] are both given; expected one of them",
        ),
        (
            TWO + "[identify_set]\nerror = 0.1\n",
            "[[experiments]] belongs to [identify] or [sample], and the task is [identify_set]; leave it out",
        ),
        (
            TWO + "[sensors.y]\ngain = [0.5, 2.0]\n[identify]\n",
            "[sensors]: unknown channel 'y'; known: x",
        ),
        (
            TWO + "[sensors.x]\ngain = [2.0, 0.5]\n[identify]\n",
            "gain is between 2 and 0.5; expected the lower bound first",
        ),
        (
            TWO + "[sensors.x]\nlag = [-0.1, 0.5]\n[identify]\n",
            "lag may be -0.1 s; expected bounds of zero or more",
        ),
        (
            TWO + "[sensors.x]\nat_rest = true\n[identify]\n",
            "none of delay, lag, gain and offset is given; expected bounds of at least one",
        ),
        (
            TWO.replace("arguments = { end = 5.0, samples = 41 }", "constants = { begin = 1.0 }") + "[identify]\n",
            "[[experiments]] 'long', constants: unknown constant 'begin'; known: none",
        ),
        (HEAD + "[identify]\n", "[identify] needs a [data] table"),
        (TWO + "[identify]\nweights = { y = 1.0 }\n", "[identify], weights: no weight is given for channel 'x'"),
        (TWO + '[identify]\nloss = "hubr"\n', "[identify], loss: 'hubr' was given"),
    ],
)
def test_what_does_not_fit_together_is_told(write, text, sentence):
    with pytest.raises(InputError) as error:
        load(write(text))
    assert sentence in str(error.value)


def test_an_own_parameter_has_bounds_and_a_first_guess_for_one_experiment(write, tmp_path):
    _, outcome = run_study(load(write(OWN + "[identify]\n")), tmp_path / "run")
    bounds = {item.name: (item.lower, item.upper, item.start) for item in outcome.result.parameters}
    assert bounds["short.size"] == (0.5, 4.0, None)
    assert bounds["long.size"] == (1.0, 1.7, 1.2)
    assert outcome.best["values"]["long.size"] == pytest.approx(1.5)


@pytest.mark.parametrize(
    ("own", "sentence"),
    [
        ("{ size = { lower = 5.0 } }", "[[experiments]] 'long', local: bounds are (5.0, 4.0)"),
        ("{ sice = { lower = 1.0 } }", "[[experiments]] 'long', local: unknown parameter 'sice'; did you mean 'size'?"),
        ('["sice"]', "[[experiments]] 'long', local: unknown parameter 'sice'; did you mean 'size'?"),
    ],
)
def test_what_is_wrong_with_own_parameters(write, own, sentence):
    text = OWN.replace("{ size = { lower = 1.0, upper = 1.7, start = 1.2 } }", own) + "[identify]\n"
    with pytest.raises(InputError) as raised:
        load(write(text))
    assert sentence in str(raised.value)


def test_the_first_part_of_a_record_that_is_predicted_is_fitted(write, tmp_path):
    _, outcome = run_study(load(write(TWO + '[identify]\nvalidation = { long = "1 s" }\n')), tmp_path / "run")
    assert outcome.result.validation.what == "the experiment 'long' after its first 1 s"
    assert outcome.best["values"]["long.size"] == pytest.approx(1.5)


def swings(path, begins, drag=0.2, noise=0.0):
    """Angles of the pendulum, let go from each angle in degrees, in one file with a column that numbers the trials."""
    rows, stamps = [], np.arange(61) * 0.02
    for number, begin in enumerate(begins, start=1):
        path.with_name("swing.toml").write_text(
            PENDULUM.replace('"30 deg"', f'"{begin} deg"') + "[simulate]\nend = 1.3\n"
        )
        study = load(path.with_name("swing.toml"))
        angle = study.forward(["rod.end.angle"], stamps).evaluate(np.array([[drag]])).only()[0, :, 0]
        rows += [f"{number} {12.5 * number + t:.2f} {a:.9f}" for t, a in zip(stamps, angle, strict=True)]
    path.write_text("\n".join(["trial time angle", *rows]))


TRIALS = (
    PENDULUM.replace('begin = "30 deg"\n', "").replace(
        "[parameters]\n", '[parameters]\nbegin = { lower = "5 deg", upper = "80 deg" }\n'
    )
    + """
[[experiments]]
name = "swing"
file = "swings.txt"
time = "time"
columns = { "rod.end.angle" = "angle" }
split = "trial"
local = ["begin"]
"""
)


def test_the_trials_in_a_file_are_experiments(write, tmp_path):
    swings(tmp_path / "swings.txt", (30, 50, 40))
    study = load(write(TRIALS + '[identify]\nvalidation = { swing-3 = "0.3 s" }\n'))
    assert unknowns(study) == ("swing-1.begin", "drag", "swing-2.begin", "swing-3.begin")
    _, outcome = run_study(study, tmp_path / "run")
    exact = {"drag": 0.2} | {f"swing-{k}.begin": np.deg2rad(at) for k, at in ((1, 30), (2, 50), (3, 40))}
    assert outcome.best["values"] == pytest.approx(exact, rel=1e-6)
    assert outcome.result.validation.what == "the experiment 'swing-3' after its first 0.3 s"


def test_one_trial_of_a_file_is_data(write, tmp_path):
    swings(tmp_path / "swings.txt", (30, 50))
    table = '[data]\nfile = "swings.txt"\ntime = "time"\ncolumns = { "rod.end.angle" = "angle" }\nsplit = "trial"\n'
    text = TRIALS.partition("[[experiments]]")[0] + table
    _, outcome = run_study(load(write(text + 'trial = 2\nstart = "first"\n[identify]\n')), tmp_path / "run")
    assert outcome.best["values"] == pytest.approx({"drag": 0.2, "begin": np.deg2rad(50)}, rel=1e-6)
    for more, sentence in (
        ("", "split is given without trial; give the trial that is read, or use [[experiments]] for all"),
        ("trial = 3\n", "column 'trial': unknown trial '3'; known: 1, 2"),
    ):
        with pytest.raises((InputError, DataError)) as raised:
            run_study(load(write(text + more + "[identify]\n")), tmp_path / "refused")
        assert sentence in str(raised.value)


def test_a_record_that_begins_late_says_when_the_motion_begins(write, tmp_path):
    swings(tmp_path / "swings.txt", (30,))
    table = '[data]\nfile = "swings.txt"\ntime = "time"\ncolumns = { "rod.end.angle" = "angle" }\n'
    text = TRIALS.partition("[[experiments]]")[0] + table
    with pytest.raises(DataError) as raised:
        run_study(load(write(text + "[identify]\n")), tmp_path / "refused")
    assert str(raised.value).endswith(
        "swings.txt, column 'time': the times begin at 12.5 s, and a motion begins at 0. If it begins with the record, "
        "give start = 'first'; if it began at 0 s of the file, give start = 0"
    )
    for start in ('"first"', "12.5", '"12500 ms"'):
        data = load(write(text + f"start = {start}\n[identify]\n")).data()
        assert data.coordinate.values[0] == pytest.approx(0.0, abs=1e-12)


def test_the_time_at_which_the_motion_begins_is_identified(write, tmp_path):
    swings(tmp_path / "swings.txt", (30,))
    table = (
        '[data]\nfile = "swings.txt"\ntime = "time"\ncolumns = { "rod.end.angle" = "angle" }\n'
        'start = { lower = "12.4 s", upper = "12.6 s", start = "12.42 s" }\n'
    )
    known = f"lower = {np.deg2rad(30)}, upper = {np.deg2rad(30)}"
    text = TRIALS.partition("[[experiments]]")[0].replace('lower = "5 deg", upper = "80 deg"', known)
    study = load(write(text + table + "[identify]\n"))
    assert unknowns(study) == ("drag", "start time")
    _, outcome = run_study(study, tmp_path / "run")
    assert outcome.best["values"]["start time"] == pytest.approx(12.5, abs=1e-5)
    assert outcome.best["values"]["drag"] == pytest.approx(0.2, rel=1e-4)


def test_files_with_other_time_stamps_belong_to_one_experiment(write, tmp_path):
    swings(tmp_path / "swings.txt", (30,))
    stamps = np.arange(40) * 0.033
    study = load(write(PENDULUM + "[simulate]\nend = 1.3\n"))
    way = study.forward(["rod.end.x"], stamps).evaluate(np.array([[0.2]])).only()[0, :, 0]
    rows = [f"{12500 + 1000 * t:.3f};{x:.9f}" for t, x in zip(stamps, way, strict=True)]
    (tmp_path / "way.csv").write_text("\n".join(["ms;x", *rows]))
    table = (
        '[data]\nfile = "swings.txt"\ntime = "time"\nstart = "first"\ncolumns = { "rod.end.angle" = "angle" }\n'
        'more = [{ file = "way.csv", time = "ms", units = { ms = "ms" }, columns = { "rod.end.x" = "x" } }]\n'
    )
    weights = 'weights = { "rod.end.angle" = 1.0, "rod.end.x" = 1.0 }\n'
    study = load(write(TRIALS.partition("[[experiments]]")[0] + table + "[identify]\n" + weights))
    assert study.data().present.sum(axis=0).tolist() == [61, 40]
    _, outcome = run_study(study, tmp_path / "run")
    assert outcome.best["values"] == pytest.approx({"drag": 0.2, "begin": np.deg2rad(30)}, rel=1e-5)


def two_files(folder, offset=0.0):
    """Two channels of different rates in two files: an angle each 2 ms, and a way each 33 ms."""
    fast, slow = np.arange(601) * 0.002 + offset, np.arange(37) * 0.033
    for name, along, values in (("angle", fast, np.sin(3 * fast)), ("way", slow, np.cos(3 * slow))):
        rows = [f"{t:.6f},{x:.9f}" for t, x in zip(along, values, strict=True)]
        (folder / f"{name}.csv").write_text("\n".join([f"t,{name}", *rows]))


FILES = '[data]\nfile = "angle.csv"\ncolumns = { "rod.end.angle" = "angle" }\n'
MORE = 'more = [{ file = "way.csv", columns = { "rod.end.x" = "way" } }]\n'


def test_each_of_several_files_is_filtered_and_decimated_for_itself(write, tmp_path):
    two_files(tmp_path)
    text = PENDULUM + FILES + 'decimate = 5\nlowpass = "30 Hz"\n' + MORE.replace(" } }", ' }, lowpass = "10 Hz" }')
    data = load(write(text + 'derivatives = { way = "rod.end.x" }\n[identify]\n')).data()
    assert data.taken.sum(axis=0).tolist() == [121, 37, 37]
    rate = data.values[data.taken[:, 2], 2]
    along = data.coordinate.values[data.taken[:, 2]]
    np.testing.assert_allclose(rate[8:-8], -3 * np.sin(3 * along[8:-8]), atol=0.02)


def test_every_does_not_count_the_samples_of_several_files(write, tmp_path):
    two_files(tmp_path)
    with pytest.raises(InputError) as raised:
        load(write(PENDULUM + FILES + MORE + "every = 5\n[identify]\n"))
    assert "every is given with more; give decimate for each file, whose time stamps differ" in str(raised.value)


def test_errors_of_a_further_file_name_it_alone(write, tmp_path):
    two_files(tmp_path)
    study = load(write(PENDULUM + FILES + MORE.replace(" } }", ' }, lowpass = "100 Hz" }') + "[identify]\n"))
    with pytest.raises(DataError) as raised:
        study.data()
    assert "way.csv: the cutoff frequency" in str(raised.value)
    assert "angle.csv" not in str(raised.value)


def test_close_stamps_of_two_files_are_no_late_record(write, tmp_path):
    """Both begin within half a step: the motion does not begin late, however close their stamps lie to each other."""
    stamps = 0.005 + np.arange(60) * 0.01
    for name, shift in (("angle", 0.0), ("way", 1e-4)):
        rows = [f"{t + shift:.6f},{np.sin(t):.9f}" for t in stamps]
        (tmp_path / f"{name}.csv").write_text("\n".join([f"t,{name}", *rows]))
    weights = '[identify]\nweights = { "rod.end.angle" = 1.0, "rod.end.x" = 1.0 }\n'
    model, data = posed(load(write(PENDULUM + FILES + MORE + weights)))
    assert len(model.coordinate.values) == len(data.coordinate.values) == 120


def test_a_study_says_the_longest_step_that_is_no_gap(write, tmp_path):
    stamps = np.delete(np.arange(101) * 0.01, np.arange(40, 60))
    rows = [f"{t:.2f},{np.sin(t):.9f}" for t in stamps]
    (tmp_path / "angle.csv").write_text("\n".join(["t,angle", *rows]))
    resample = 'resample = { end = 1.0, every = "10 ms" }\nmissing = "leave-out"\n'
    for gap, missing in (("", 20), ('gap = "0.3 s"\n', 0)):
        data = load(write(PENDULUM + FILES + resample + gap + "[identify]\n")).data()
        assert np.count_nonzero(~data.present) == missing


OFFSETS = """
[[experiments]]
name = "a"
file = "a.csv"
columns = { "rod.end.x" = "x" }
local = ["rod.end.x offset"]
[[experiments]]
name = "b"
file = "b.csv"
columns = { "rod.end.x" = "x" }
local = OWN
[sensors."rod.end.x"]
offset = [-0.3, 0.3]
[identify]
starts = 1
"""


@pytest.mark.parametrize(
    "own", ['["rod.end.x offset"]', '{ "rod.end.x offset" = { lower = "-30 cm", upper = 0.0, start = -0.05 } }']
)
def test_each_experiment_may_have_its_own_zero_of_a_sensor(own, write, tmp_path):
    times = np.arange(1, 31) * 0.04
    study = load(write(PENDULUM + "[simulate]\nend = 1.5\n"))
    exact = study.forward(["rod.end.x"], times).evaluate(np.array([[0.2]])).only()[0, :, 0]
    for name, offset in (("a", 0.05), ("b", -0.1)):
        table(tmp_path / f"{name}.csv", times, exact + offset)
    study = load(write(PENDULUM + OFFSETS.replace("OWN", own)))
    names = ("a.rod.end.x offset", "drag", "b.rod.end.x offset")
    assert set(unknowns(study)) == set(names)
    _, outcome = run_study(study, tmp_path / "run")
    assert [outcome.best["values"][name] for name in names] == pytest.approx([0.05, 0.2, -0.1], rel=1e-4)
    posed_parameters = {item.name: item for item in outcome.result.parameters}
    expected = (-0.3, 0.3) if own.startswith("[") else (-0.3, 0.0)
    assert (posed_parameters[names[2]].lower, posed_parameters[names[2]].upper) == expected


@pytest.mark.parametrize(
    ("own", "sentence"),
    [
        (
            '["rod.end.x gain"]',
            "[[experiments]] 'b', local: unknown parameter 'rod.end.x gain'; did you mean 'rod.end.x offset'?",
        ),
        ('{ "rod.end.x offset" = { lower = 0.5 } }', "[[experiments]] 'b', local: bounds are (0.5, 0.3)"),
    ],
)
def test_what_is_wrong_with_own_parameters_of_sensors(own, sentence, write, tmp_path):
    for name in "ab":
        table(tmp_path / f"{name}.csv", np.arange(3.0), np.arange(3.0))
    with pytest.raises(InputError) as caught:
        load(write(PENDULUM + OFFSETS.replace("OWN", own)))
    assert sentence in str(caught.value)
