"""Studies that cannot run: the check and the run refuse them with the same sentence, before there is a folder."""

import re
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from dalembert.errors import DalembertError
from dalembert.study import load, plan, run_study
from study_texts import BAR, SLIDER

COMMAND = Path(sys.executable).with_name("dalembert")
MODELS = """
import time
import numpy as np
from dalembert.forward import PythonModel
TIMES = np.linspace(0, 2, 21)

def swing(parameters):
    def motion(place, speed):
        x = place * np.cos(3 * TIMES) + speed / 3 * np.sin(3 * TIMES)
        v = speed * np.cos(3 * TIMES) - 3 * place * np.sin(3 * TIMES)
        return np.stack([x, v], axis=1)
    return PythonModel(motion, parameters, ["x", "v"], TIMES)

def uneven(parameters):
    return PythonModel(lambda place, speed: place * TIMES**2 + speed, parameters, ["x"], TIMES**2)

def pause(parameters):
    def late(place, speed):
        time.sleep(20)
        return place * TIMES + speed
    return PythonModel(late, parameters, ["x"], TIMES)
"""
HEAD = """
[parameters]
place = { lower = -2.0, upper = 2.0 }
speed = { lower = -3.0, upper = 3.0 }
[model]
forward = "models.py:swing"
"""
DATA = '[data]\nfile = "x.csv"\ncolumns = { x = "x" }\n'
KNOWN = DATA + "deviations = { x = 0.01 }\n"
BANDS = '[bands]\nfile = "x.csv"\ncolumns = { x = ["low", "high"] }\n'
SHOOTING = """
[identify]
shooting.segments = 4
shooting.states.place = { channel = "x", lower = -2.0, upper = 2.0 }
shooting.states.speed = { channel = "v", lower = -9.0, upper = 9.0 }
"""
SPEED = 'shooting.states.speed = { channel = "v", lower = -9.0, upper = 9.0 }'
ONE = '[[experiments]]\nname = "one"\nfile = "x.csv"\ncolumns = { x = "x" }\n'
TWO = ONE + ONE.replace("one", "two")
SOLVED = BAR + '[solver]\nstep = "1 ms"\n'
WORK = """
[work_precision]
end = 1.0
channels = ["bar.end.x"]
[[work_precision.series]]
solver = { step = 0.01 }
over = { step = [0.01, 0.005] }
[[work_precision.reference]]
step = 1e-3
[[work_precision.reference]]
step = 2e-3
"""
OPEN = '[[model.joint]]\nkind = "RevoluteJoint"\nname = "second"\na = "ground(3, 0)"\nb = "bar.end"\n'
CURVE = SLIDER + "[frequency_response]\nfrequencies = [0.1, 0.2]\n"
MEASURED = (
    SOLVED.replace("[model", '[parameters]\nmass = { lower = "1 kg", upper = "3 kg" }\n[model', 1).replace(
        "mass = 1.0", 'mass = "mass"'
    )
    + '[data]\nfile = "x.csv"\ncolumns = { "bar.end.x" = "x" }\n'
)
REFUSED = {
    "data: unit of a deviation": (
        MEASURED + 'deviations = { "bar.end.x" = "1 s" }\n[identify]\n',
        "[data], deviations, bar.end.x: '1 s' was given; expected a length",
    ),
    "noise: unit of a deviation": (
        MEASURED + '[identify.noise]\nmodel = "constant"\ndeviation = ["1 mm", "1 rad"]\n',
        "[identify.noise], bar.end.x: '1 rad' was given; expected a length",
    ),
    "noise: unit within a table": (
        MEASURED
        + '[sample.noise.channels."bar.end.x"]\nmodel = "autoregressive"\n'
        + 'deviation = { model = "constant", deviation = "1 rad" }\n',
        "[sample.noise], bar.end.x: '1 rad' was given; expected a length",
    ),
    "noise: known without deviations": (
        HEAD + DATA + '[identify]\nnoise = "known"\n',
        "noise of channel 'x': KnownNoise was given, but the data have no deviations",
    ),
    "noise: order too high": (
        HEAD + DATA + '[sample.noise]\nmodel = "autoregressive"\norder = 9\n',
        "AutoregressiveNoise of order 9 needs 90 samples",
    ),
    "noise: open order of uneven samples": (
        HEAD.replace("swing", "uneven")
        + DATA.replace("x.csv", "uneven.csv")
        + '[identify]\nnoise = "autoregressive"\n',
        "AutoregressiveNoise needs evenly spaced samples",
    ),
    "sample: open order": (
        HEAD + DATA + '[sample]\nnoise = "autoregressive"\n',
        "noise of channel 'x': the order of AutoregressiveNoise is open; give it",
    ),
    "sample: prior of no noise parameter": (
        HEAD + DATA + '[sample.priors."noise.y.deviation"]\nkind = "half-normal"\ndeviation = 0.1\n',
        "[sample.priors]: unknown noise parameter 'noise.y.deviation'; did you mean 'noise.x.deviation'?",
    ),
    "sample: unit of a prior": (
        MEASURED + '[sample.priors."noise.bar.end.x.deviation"]\nkind = "half-normal"\ndeviation = "1 s"\n',
        "[sample.priors], noise.bar.end.x.deviation: '1 s' was given; expected a length",
    ),
    "sample: unit of a start": (
        HEAD.replace("lower = -2.0, upper = 2.0", 'lower = "-2 m", upper = "2 m"')
        + DATA
        + '[sample]\nstart = { place = "1 kg", speed = 0.0 }\n',
        "[sample.start], place: '1 kg' was given; expected a length",
    ),
    "screening: odd levels": (HEAD + "[screening]\nlevels = 3\n", "expected a multiple of 2"),
    "simulate: open": (SOLVED + OPEN + "[simulate]\nend = 1.0\n", "has a gap of 1 (m or rad)"),
    "simulate: channel": (SOLVED + '[simulate]\nend = 1.0\nchannels = ["bar.end.q"]\n', "[simulate], channels: "),
    "simulate: memory": (SOLVED.replace("1 ms", "1e-13 s") + "[simulate]\nend = 1.0\n", "GB of memory"),
    "shooting: no states": (
        HEAD + DATA + "[identify]\nshooting = true\n",
        "shooting: the model cannot begin at a later state",
    ),
    "shooting: uneven": (
        HEAD.replace("swing", "uneven") + KNOWN.replace("x.csv", "uneven.csv") + SHOOTING.replace('"v"', '"x"'),
        "shooting: the samples are between",
    ),
    "shooting: few samples": (HEAD + KNOWN + SHOOTING.replace("= 4", "= 12"), "too few for 12 segments"),
    "shooting: channel": (
        HEAD + KNOWN + SHOOTING.replace('"v"', '"w"'),
        "[data], columns: unknown channel 'w'",
    ),
    "validation: no experiments": (
        HEAD + DATA + '[identify]\nvalidation = ["one"]\n',
        "validation is 'one', but there is one experiment",
    ),
    "validation: unknown": (HEAD + TWO + '[identify]\nvalidation = ["three"]\n', "unknown experiment 'three'"),
    "validation: all": (
        HEAD + TWO + '[identify]\nvalidation = ["one", "two"]\n',
        "at least one experiment to be fitted",
    ),
    "validation: local": (
        HEAD + ONE + ONE.replace("one", "two") + 'local = ["speed"]\n[identify]\nvalidation = ["two"]\n',
        "parameter 'two.speed' belongs to experiments for validation alone",
    ),
    "validation: share": (HEAD + DATA + "[identify]\nvalidation = 0.99\n", "leaves 0 of 21 samples to be fitted"),
    "weights": (
        HEAD + DATA + "[identify]\nweights = { x = -1.0 }\n",
        "weights have the value -1; expected finite numbers",
    ),
    "prior": (
        HEAD.replace("upper = 3.0", "upper = 3.0, deviation = 0.1") + DATA + "[identify]\n",
        "deviation",
    ),
    "loss": (HEAD + DATA + '[identify]\nloss = "huber"\n', "loss"),
    "data: other samples": (HEAD + DATA.replace("x.csv", "uneven.csv") + "[identify]\n", "sample 20: the data lie at"),
    "data: not a number": (HEAD + DATA.replace("x.csv", "gap.csv") + "[identify]\n", "gap.csv"),
    "data: channel": (HEAD + DATA.replace("{ x =", "{ y =") + "[identify]\n", "[data], columns: unknown channel 'y'"),
    "experiments: deviations": (
        HEAD + ONE + TWO[len(ONE) :] + "deviations = { x = 0.1 }\n[identify]\n",
        "'one' has no dev",
    ),
    "sensors": (HEAD + DATA + "[sensors.x]\ndelay = [0.5, 0.9]\n[identify]\n", "delay"),
    "sweep: sample": (HEAD + '[sweep]\nat = 0.03\nchannels = ["x"]\nover = { place = [1.0] }\n', "[sweep], at: 0.03"),
    "sweep: channel": (HEAD + '[sweep]\nat = 0.1\nchannels = ["y"]\nover = { place = [1.0] }\n', "unknown channel 'y'"),
    "propagate: twice": (
        HEAD + '[propagate]\nmethod = "scan"\ncompare = ["scan", "vertex"]\n',
        "'scan' is given 2 times",
    ),
    "propagate: channel": (
        SOLVED.replace("length = 1.0", 'length = "l"')
        + '[parameters]\nl = { lower = 1.0, upper = 2.0 }\n[propagate]\ntimes = [0.5]\nchannels = ["bar.end.q"]\n',
        "[propagate], channels: ",
    ),
    "bands: samples": (
        HEAD + BANDS.replace("x.csv", "uneven.csv") + "[identify_bands]\n",
        "sample 20: the data lie at",
    ),
    "bands: weights": (HEAD + BANDS + "[identify_bands]\nweights = { x = -1 }\n", "weights have the value -1"),
    "set: error": (
        HEAD + DATA + "[identify_set]\nerror = -0.1\n",
        "identify_set: error has the value -0.1; expected finite positive numbers",
    ),
    "design: horizon": (HEAD + "[design]\ndeviations = 0.1\nhorizons = [-1.0]\n", "design: horizon -1"),
    "design: channel": (HEAD + "[design]\ndeviations = { y = 0.1 }\n", "unknown channel 'y'"),
    "design: pairs": (
        HEAD.replace("swing", "uneven") + '[design]\ndeviations = 0.1\nsensors = "pairs"\n',
        "'x' is the only channel",
    ),
    "work: channel": (SOLVED.partition("[solver]")[0] + WORK.replace("end.x", "end.q"), "[work_precision], channels: "),
    "work: open": (SOLVED.partition("[solver]")[0] + OPEN + WORK, "has a gap of 1 (m or rad)"),
    "curve: dof": (CURVE + 'observe = ["n"]\n', "[frequency_response], observe: "),
    "curve: amplitude": (CURVE + 'amplitude = "harmonic 99"\n', "[frequency_response], amplitude: "),
    "curve: mode": (CURVE + "backbone = { amplitudes = [1.0], mode = 7 }\n", "mode"),
    "curve: mode's dof": (CURVE + 'backbone = { amplitudes = [1.0], dof = "n" }\n', "'n'"),
    "track: dof": (
        SLIDER + '[track_resonance]\nparameter = "preload"\nvalues = [1.0]\nbetween = [0.1, 0.3]\ndof = "n"\n',
        "[track_resonance], dof: ",
    ),
    "backbone: mode": (SLIDER + "[backbone]\namplitudes = [1.0]\nmode = 7\n", "mode"),
    "modes": (SLIDER + "[modes]\n", "[modes] draws the shapes"),
}


@pytest.fixture(autouse=True)
def files(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("models.py").write_text(MODELS)
    times = np.linspace(0, 2, 21)
    x = np.cos(3 * times)
    for name, along in (("x", times), ("uneven", times**2)):
        columns = np.column_stack([along, x, x - 0.1, x + 0.1])
        np.savetxt(f"{name}.csv", columns, delimiter=",", header="t,x,low,high", comments="")
    Path("gap.csv").write_text(Path("x.csv").read_text().replace(f"{x[3]:.18e}", "nan"))


@pytest.mark.parametrize("case", REFUSED)
def test_check_and_run_refuse_with_the_same_sentence_and_leave_no_folder(case):
    text, part = REFUSED[case]
    Path("study.toml").write_text(text)
    sentences = []
    for step in (plan, run_study):
        with pytest.raises(DalembertError) as error:
            step(load("study.toml"))
        sentences.append(str(error.value))
    assert part in sentences[0]
    assert sentences[0] == sentences[1]
    assert not Path("runs").exists()


def test_an_address_without_a_scheduler_leaves_no_folder():
    pytest.importorskip("distributed")
    Path("study.toml").write_text(HEAD + DATA + "[identify]\n")
    with pytest.raises(DalembertError, match="no scheduler of Dask answers"):
        run_study(load("study.toml"), executor="nowhere")
    assert not Path("runs").exists()


def checked(*options: str) -> subprocess.CompletedProcess[str]:
    command = [COMMAND, "check", "study.toml", *options]
    return subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)


def test_the_states_of_segments_are_checked_where_the_motion_does_not_begin_with_them():
    moving = HEAD.replace("upper = 3.0", "upper = 3.0, start = 1.0")
    Path("study.toml").write_text(moving + KNOWN + SHOOTING.replace('"v"', '"x"'))
    done = checked()
    assert (done.returncode, done.stdout.splitlines()[0][:24]) == (2, "study.toml: valid; it id")
    assert "shooting, state 'speed': the motion begins with 'x' at" in done.stderr
    with pytest.raises(DalembertError, match="shooting, state 'speed': the motion begins with 'x' at"):
        run_study(load("study.toml"))


def test_tiny_steps_are_extrapolated_and_warned_about():
    sweep = '[sweep]\nat = 1.0\nchannels = ["bar.end.x"]\nover = { m = { count = 50000 } }\n'
    text = SOLVED.replace("1 ms", "2e-9 s").replace("mass = 1.0", 'mass = "m"')
    Path("study.toml").write_text("[parameters]\nm = { lower = 1.0, upper = 2.0 }\n" + text + sweep)
    began = time.monotonic()
    done = checked()
    assert done.returncode == 0, done.stderr
    assert time.monotonic() - began < 30
    lines = done.stdout.splitlines()
    (place,) = (number for number, line in enumerate(lines) if line.startswith("This takes "))
    assert re.match(r"This takes about [\d.]+ (h|days|years)\b", lines[place])
    assert "extrapolated from its first" in lines[place]
    assert lines[place + 1].startswith("Warning: The study may take ")
    assert "more than a day. Check the step of the solver" in lines[place + 1]


def test_a_million_samples_are_extrapolated():
    times = "times = { start = 0, end = 1000.0, count = 1000000 }\n"
    Path("study.toml").write_text(SOLVED.replace("1 ms", "0.1 ms") + "[simulate]\n" + times)
    done = checked("--limit", "20")
    assert done.returncode == 0, done.stderr
    assert "extrapolated from its first" in done.stdout


def test_a_sweep_with_sensitivities_refuses_a_model_that_loses_the_complex_step():
    Path("lost.py").write_text(MODELS.replace("x = place *", "x = abs(place) *"))
    sweep = HEAD.replace("models.py", "lost.py") + '[sweep]\nat = 0.1\nchannels = ["x"]\nover = { place = [1.0] }\n'
    Path("study.toml").write_text(sweep)
    with pytest.raises(DalembertError, match=r"by 'place' is .* by the complex step, but .* by differences"):
        run_study(load("study.toml"))
    Path("study.toml").write_text(sweep + "sensitivities = false\n")
    run_study(load("study.toml"))


def test_the_check_ends_at_its_time_limit():
    Path("study.toml").write_text(HEAD.replace("swing", "pause") + DATA + "[identify]\n")
    began = time.monotonic()
    done = checked("--limit", "0.5")
    assert (done.returncode, done.stderr) == (0, "")
    assert "The check ends at its time limit, 0.5 s, during a simulation. Raise --limit." in done.stdout.splitlines()
    assert time.monotonic() - began < 15


def test_what_would_take_longer_than_the_limit_is_left_out():
    Path("models.py").write_text(MODELS.replace("sleep(20)", "sleep(0.4)"))
    Path("study.toml").write_text(HEAD.replace("swing", "pause") + DATA + "[identify]\n")
    done = checked("--limit", "1.4")
    assert done.returncode == 0, done.stderr
    expected = "The check ends before its time limit, 1.4 s: what it would simulate next takes 1.6 s. Raise --limit."
    assert expected in done.stdout.splitlines()


OTHERS = [["schema"], ["new"], ["run", "study.toml"], ["report", "old"]]


@pytest.mark.parametrize(
    "command",
    [
        ["check", "study.toml"],
        ["list"],
        *(pytest.param(command, marks=pytest.mark.slow) for command in OTHERS),
    ],
    ids=" ".join,
)
@pytest.mark.skipif(sys.platform == "win32", reason="there are no such pipes")
def test_commands_end_quietly_where_nobody_reads(command):
    Path("study.toml").write_text(HEAD + DATA + "[identify]\nstarts = 1\n")
    if command[0] in ("list", "report"):
        run_study(load("study.toml"), Path("runs/old"))
    with subprocess.Popen([COMMAND, *command], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        process.stdout.close()
        said = process.stderr.read()
        assert process.wait(timeout=60) == 0, said
    assert not any(word in said for word in ("Traceback", "Broken pipe", "Exception", "rror"))
    if command[0] == "run":
        assert Path("runs/study/report.html").is_file()


@pytest.mark.skipif(sys.platform == "win32", reason="there are no such pipes")
def test_a_run_goes_on_where_nobody_reads_how_far_it_is():
    Path("study.toml").write_text(HEAD + DATA + '[identify]\nmethod = "improved-swarm"\n')
    with subprocess.Popen([COMMAND, "run", "study.toml"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT) as process:
        assert process.stdout is not None
        process.stdout.close()
        assert process.wait(timeout=60) == 0
    assert Path("runs/study/report.html").is_file()
