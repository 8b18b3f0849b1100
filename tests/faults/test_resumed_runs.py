"""Runs that are killed and resumed: nothing is lost or done twice, and they end with the bits of an undisturbed run."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from study_texts import BAR, SLIDER

HERE = Path(__file__).parent
MODEL = """
import time
import numpy as np
from dalembert.forward import PythonModel

times = np.linspace(0, 1, 11)

def decay(parameters):
    return PythonModel(response, parameters, ["x"], times)

def response(rate, height):
    time.sleep(0.002)
    return height * np.exp(-rate * times)
"""
HEAD = """
[parameters]
rate = { lower = 0.5, upper = 2.0 }
height = { lower = 0.1, upper = 1.0, start = 0.3 }
[model]
forward = "decay.py:decay"
"""
DATA = """
[data]
file = "data.csv"
columns = { x = "x" }
"""
BANDS = """
[bands]
file = "bands.csv"
columns = { x = ["low", "high"] }
"""
STRUCTURE = (
    SLIDER
    + """
[[model.spring]]
kind = "CubicSpring"
name = "hardening"
first = "m"
stiffness = 0.1
[harmonic_balance]
harmonics = 9
"""
)
CURVES = STRUCTURE + "[frequency_response]\n"
MECHANISM = (
    BAR
    + """
[work_precision]
end = "5 s"
channels = ["bar.end.x"]
reference = [{ step = 1e-4 }, { step = 2e-4 }]
[[work_precision.series]]
solver = { step = 0.01 }
over = { step = [1e-2, 5e-3, 2e-3, 1e-3, 5e-4] }
[[work_precision.series]]
name = "adaptive"
solver = { step = 0.01, adaptive = true }
over = { tolerance = [1e-4, 1e-5, 1e-6, 1e-7] }
"""
)
STUDIES = {
    "least-squares": HEAD + DATA + "[identify]\nstarts = 8\nprofile = true\nprediction = true\n",
    "improved-swarm": HEAD
    + DATA
    + '[identify]\nseed = 3\npolish = true\nmethod = { kind = "improved-swarm", particles = 8, iterations = 12 }\n',
    "nelder-mead": HEAD + DATA + '[identify]\nmethod = { kind = "scipy", name = "Nelder-Mead" }\n',
    "chebyshev": HEAD + "[propagate]\n",
    "compared": HEAD
    + '[propagate]\ncompare = ["vertex", { kind = "monte-carlo", runs = 200 }]\nreference = "optimise"\n',
    "bands": HEAD + BANDS + "[identify_bands]\nseed = 1\n",
    "set": HEAD + DATA + '[identify_set]\nerror = 0.02\nscheme = { kind = "tensor", order = 8 }\n',
    "sweep": HEAD + '[sweep]\nat = 0.5\nchannels = ["x"]\nover = { rate = { count = 150 } }\n',
}
STUDIES |= {
    "family of curves": CURVES + "frequencies = { start = 0.12, end = 0.3, count = 120 }\nstability = true\n"
    'sweep = { parameter = "preload", values = [0.0, 1.0, 2.0, 4.0, 8.0] }\n',
    "curve past folds": CURVES + 'between = [0.1, 0.4]\ncontinuation = "arc-length"\n',
    "curve beside its points in time and its mode": CURVES + "frequencies = { start = 0.12, end = 0.3, count = 40 }\n"
    "[frequency_response.compare_in_time]\nfrequencies = [0.13, 0.16, 0.19, 0.22, 0.25]\n"
    "method = { steps_per_period = 1024 }\n[frequency_response.backbone]\n"
    "amplitudes = { start = 0.1, end = 20.0, count = 20 }\n",
    "mode past corners": STRUCTURE + "[backbone]\nbetween = [0.1, 20.0]\n",
    "tracked resonance": STRUCTURE + '[track_resonance]\nparameter = "preload"\nbetween = [0.1, 0.4]\ndof = "m"\n'
    "values = { count = 17 }\n",
    "compared integrators": MECHANISM,
}
QUICK = ("sweep",)
"""The others are slow tests."""
KILLS = 2
MANY = 25


def killed(folder: Path, study: str, kills: int, seed: int) -> dict:
    """What the killing script says of a study."""
    times = np.linspace(0, 1, 11)
    noise = 0.005 * np.random.default_rng(0).standard_normal(11)
    columns = [times, 0.5 * np.exp(-times) + noise, 0.45 * np.exp(-1.1 * times), 0.55 * np.exp(-0.9 * times)]
    table = "\n".join(",".join(f"{value:.17g}" for value in row) for row in zip(*columns, strict=True))
    (folder / "decay.py").write_text(MODEL)
    (folder / "data.csv").write_text("t,x,low,high\n" + table + "\n")
    (folder / "bands.csv").write_text("t,x,low,high\n" + table + "\n")
    (folder / "study.toml").write_text(STUDIES[study])
    command = [sys.executable, HERE / "kills.py", folder / "study.toml", folder, str(kills), str(seed)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@pytest.mark.parametrize(
    "study", [name if name in QUICK else pytest.param(name, marks=pytest.mark.slow) for name in STUDIES]
)
def test_killed_at_random_moments_a_study_ends_the_same(tmp_path, study):
    assert killed(tmp_path, study, KILLS, seed=1)["kills"] == KILLS


@pytest.mark.slow
@pytest.mark.parametrize("study", STUDIES)
def test_killed_very_often_a_study_ends_the_same(tmp_path, study):
    """25 kills of each of fourteen kinds of study: 350 in all."""
    assert killed(tmp_path, study, MANY, seed=2)["kills"] == MANY
