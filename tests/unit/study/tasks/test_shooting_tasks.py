"""Multiple shooting in a study file: its keys, its run, its report, and what it cannot be used with."""

import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.study import load, plan, report_run, run_study
from pages import read_page

SWING = """
import numpy as np
from dalembert.forward import PythonModel

def swing(parameters):
    times = np.linspace(0, 4, 41)

    def motion(place, speed, stiffness):
        own = np.sqrt(stiffness)
        x = place * np.cos(own * times) + speed / own * np.sin(own * times)
        v = speed * np.cos(own * times) - place * own * np.sin(own * times)
        return np.stack([x, v], axis=1)

    return PythonModel(motion, parameters, ["x", "v"], times)
"""
HEAD = """
[parameters]
place = { lower = -2.0, upper = 2.0 }
speed = { lower = -3.0, upper = 3.0 }
stiffness = { lower = 2.0, upper = 30.0, start = 5.0 }
[model]
forward = "swing.py:swing"
"""
DATA = """
[data]
file = "swing.csv"
columns = { x = "x" }
deviations = { x = 0.01 }
"""
SHOOTING = """
[identify.shooting]
segments = 4
states.place = { channel = "x", lower = -2.0, upper = 2.0 }
states.speed = { channel = "v", lower = -9.0, upper = "9 m/s", rate_of = "x" }
"""
TIMES = np.linspace(0, 4, 41)


@pytest.fixture
def write(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "swing.py").write_text(SWING)
    x = np.cos(3 * TIMES) + 0.01 * np.random.default_rng(0).standard_normal(41)
    np.savetxt(tmp_path / "swing.csv", np.column_stack([TIMES, x]), delimiter=",", header="t,x", comments="")

    def written(text):
        path = tmp_path / "study.toml"
        path.write_text(text)
        return path

    return written


def test_a_study_shoots_and_reports_where_its_segments_meet(write, tmp_path):
    study = load(write(HEAD + DATA + "[identify]\nstarts = 1\n" + SHOOTING))
    assert "LeastSquares in 4 segments that must meet: about 320 simulations a start" in plan(study)
    folder, outcome = run_study(study, tmp_path / "run")
    assert outcome.success
    assert outcome.best["values"]["stiffness"] == pytest.approx(9.0, abs=0.05)
    assert any('"gap":' in line for line in folder.events.read_text().splitlines())
    for path in (folder.report, report_run(folder)):
        page = read_page(path)
        assert "and merged into one run." in page.text
        assert "a small change of the initial state has grown" in page.text
        rows = page.table("nodes")
        assert rows[0] == ["sample", "time (s)", "place", "speed", "largest gap"]
        assert [float(row[0]) for row in rows[1:]] == [10, 20, 30]
        np.testing.assert_allclose([float(row[2]) for row in rows[1:]], np.cos(3 * TIMES[[10, 20, 30]]), atol=0.02)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (
            DATA + "[identify]\n" + SHOOTING.replace("states.place", "states.plac"),
            "[identify.shooting], states: unknown parameter 'plac'; did you mean 'place'?",
        ),
        (
            DATA + "[identify]\nvalidation = 0.25\n" + SHOOTING,
            "[identify.shooting] cannot be used with validation; leave one of the keys out",
        ),
        (
            DATA + "[sensors.x]\ngain = [0.5, 2.0]\n[identify]\n" + SHOOTING,
            "[identify.shooting] cannot be used with [sensors]; leave one of them out",
        ),
        (
            DATA + '[identify]\nmethod = "improved-swarm"\n' + SHOOTING,
            "[identify.shooting] is a way of least squares; leave it or the method out",
        ),
        (
            DATA + "[identify]\n" + SHOOTING.replace("segments = 4", "segments = 1"),
            "MultipleShooting: segments is 1; expected a whole number of at least 2",
        ),
        (
            DATA + "[identify]\n" + SHOOTING.replace("upper = 2.0", "upper = -3.0"),
            "ShootingState 'x': bounds are (-2, -3); expected lower < upper",
        ),
    ],
)
def test_what_it_cannot_be_used_with_is_told(write, text, sentence):
    with pytest.raises(InputError) as error:
        load(write(HEAD + text))
    assert sentence in str(error.value)
