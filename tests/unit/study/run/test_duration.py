"""About how long a study takes: sentences from a timed part, and the counts of each task."""

import re
import time
from dataclasses import dataclass

import pytest

from dalembert.errors import InputError
from dalembert.study import load
from dalembert.study.run.duration import Effort, duration, storage, timed, too_long, within
from dalembert.study.run.validation import forecast

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
        return next(forecast(load(tmp_path / "study.toml")))

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
    effort = Effort(lambda share: time.sleep(0.1) or 1.0, 2, least, most, "a part")
    assert re.fullmatch(pattern.replace(r"\d+ ms", r"(?:\d+ ms|0\.\d+ s)"), duration(effort, timed(effort)))


@dataclass
class Clock:
    """A simulation of some seconds with what happens at its beginning, on a clock of its own."""

    seconds: float
    begins: float = 0.5
    now: float = 0.0
    simulated: float = 0.0

    def __call__(self):
        return self.now

    def part(self, share):
        self.now += self.begins + share * self.seconds
        self.simulated += self.begins + share * self.seconds
        return share


@pytest.mark.parametrize("seconds", [1e-3, 1.0, 1e3, 1e6, 1e12])
def test_a_long_simulation_is_extrapolated_from_a_short_part(monkeypatch, seconds):
    clock = Clock(seconds)
    monkeypatch.setattr("dalembert.study.run.duration.perf_counter", clock)
    effort = Effort(clock.part, 1, 10, 20, "one", shortest=min(1.0, 0.1 / seconds))
    timing = timed(effort)
    assert timing.each == pytest.approx(seconds + 0.5, rel=1e-6)
    assert timing.share == 1 or timing.each > 0.8
    assert clock.simulated < 100
    finding = too_long(effort, timing)
    assert (finding is not None) == (seconds > 4000)
    if finding is not None:
        assert (finding.code, finding.severity) == ("long-run", "warning")
        assert finding.values["seconds"] == pytest.approx(20 * timing.each)
    assert ("extrapolated from its first" in duration(effort, timing)) == (timing.share < 1)


def test_sentences_come_until_the_time_is_over():
    def sentences():
        yield "one"
        time.sleep(30)
        yield "two"

    heard, began = [], time.monotonic()
    with pytest.raises(TimeoutError):
        heard.extend(within(0.2, sentences))
    assert heard == ["one"]
    assert list(within(5.0, lambda: iter(["one", "two"]))) == ["one", "two"]
    assert time.monotonic() - began < 10
    with pytest.raises(InputError, match="wrong"):
        list(within(5.0, failing))


def failing():
    yield "one"
    raise InputError("wrong")


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
        (PENDULUM, "(the motion)."),
    ],
)
def test_each_task_says_how_many_simulations_it_expects(sentence, text, count):
    assert count in sentence(text)


@pytest.mark.parametrize(
    ("most", "kept", "sentence"),
    [
        (5000, None, "The checkpoint takes up to 240 MB until the run ends."),
        (5000, 300, "The checkpoint takes up to 14 MB until the run ends."),
        (5000, 128, ""),
        (None, None, "Each simulation adds 48 kB to the checkpoint, which the run removes at its end."),
    ],
)
def test_the_size_of_a_checkpoint_is_stated(most, kept, sentence):
    """Responses of 1,000 samples of 6 channels."""
    assert storage(Effort(float, 1, most, most, "a part", response=8 * 1000 * 6, kept=kept)) == sentence
