"""About how long a study takes: sentences from a timed part, and the counts of each task."""

import re
import time

import pytest

from dalembert.study import load
from dalembert.study.duration import Effort, duration
from dalembert.study.runner import takes

MODEL = """
import numpy as np
import time
from dalembert import PythonModel
TIMES = np.linspace(0, 2, 5)
def response(rate):
    return np.exp(-rate * TIMES)
def decay(parameters):
    return PythonModel(response, parameters, ["x"], TIMES)
"""
HEAD = """
[parameters]
rate = { lower = 0.1, upper = 3.0 }
[model]
forward = "decay.py:decay"
"""
DATA = '[data]\nfile = "x.csv"\ncolumns = { x = "x" }\n'
BANDS = '[bands]\nfile = "x.csv"\ncolumns = { x = ["low", "high"] }\n'
PENDULUM = """
[model]
[[model.body]]
kind = "RigidBar"
name = "rod"
length = 1.0
mass = 1.5
angle = "-30 deg"
[[model.joint]]
kind = "RevoluteJoint"
name = "pin"
a = "ground"
b = "rod.start"
[solver]
step = "2 ms"
[simulate]
end = 2.0
"""


@pytest.fixture
def sentence(tmp_path):
    (tmp_path / "decay.py").write_text(MODEL)
    rows = [f"{0.5 * k},{0.9 - 0.2 * k},{0.8 - 0.2 * k},{1 - 0.2 * k}" for k in range(5)]
    (tmp_path / "x.csv").write_text("\n".join(["t,x,low,high", *rows]))

    def of(text):
        (tmp_path / "study.toml").write_text(text)
        return takes(load(tmp_path / "study.toml"))

    return of


@pytest.mark.parametrize(
    ("least", "most", "pattern"),
    [
        (10, 10, r"This takes about 0\.[5-9]\d* s: 10 simulations of \d+ ms \(a part\)\."),
        (10, 20, r"This takes about 0\.[5-9]\d* s to 1\.?\d* s: 10 to 20 simulations of \d+ ms \(a part\)\."),
        (1, 1, r"This takes about \d+ ms \(a part\)\."),
        (None, None, r"A simulation takes about \d+ ms \(a part\); how many there will be shows on the way\."),
    ],
)
def test_a_timed_part_is_scaled_to_the_whole(least, most, pattern):
    effort = Effort(lambda: time.sleep(0.1), 2, least, most, "a part")
    assert re.fullmatch(pattern.replace(r"\d+ ms", r"(?:\d+ ms|0\.\d+ s)"), duration(effort))


@pytest.mark.parametrize(
    ("text", "count"),
    [
        (HEAD + DATA + "[identify]\n", ": 20 to 224 simulations of"),
        (HEAD + DATA + "[identify]\nstarts = 1\n", ": 20 simulations of"),
        (HEAD + DATA + '[identify]\nmethod = { kind = "standard-swarm", particles = 5, iterations = 3 }\n', ": 15 sim"),
        (HEAD + DATA + '[identify]\nmethod = "Nelder-Mead"\n', "how many there will be shows on the way."),
        (HEAD + DATA + "[identify_set]\nerror = 0.1\n", "how many there will be shows on the way."),
        (HEAD + BANDS + "[identify_bands]\n", "how many there will be shows on the way."),
        (HEAD + '[propagate]\nmethod = "vertex"\n', ": 2 simulations of"),
        (HEAD + "[propagate]\n", "how many there will be shows on the way."),
        (HEAD + "[design]\ndeviations = 0.1\n", ": 2 simulations of"),
        (HEAD + '[sweep]\nat = 1.0\nchannels = ["x"]\nover = { rate = { count = 5 } }\n', ": 10 simulations of"),
        (PENDULUM, "going by the first 0.1 s of the motion"),
    ],
)
def test_each_task_says_how_many_simulations_it_expects(sentence, text, count):
    assert count in sentence(text)
