"""The task of paths of equilibria."""

import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.study import load, run_study
from dalembert.study.run.runner import plan
from dalembert.study.tasks import TASKS

STUDY = """
[parameters]
push = { lower = 0.0, upper = "8 N", unit = "N" }
stiffness = { lower = "5 kN/m", upper = "15 kN/m", unit = "N/m" }

[model]
gravity = [0.0, 0.0]

[[model.body]]
kind = "PointMass"
name = "apex"
mass = 1.0
position = [0.0, 0.1]

[[model.load]]
kind = "Spring"
name = "left"
a = [-1.0, 0.0]
b = "apex.centre"
stiffness = "stiffness"
free_length = "sqrt(1.01)"

[[model.load]]
kind = "Spring"
name = "right"
a = [1.0, 0.0]
b = "apex.centre"
stiffness = "stiffness"
free_length = "sqrt(1.01)"

[[model.load]]
kind = "Force"
name = "force"
at = "apex.centre"
y = "-push"

[equilibrium_path]
over = { push = {} }
channels = ["apex.centre.y"]
"""


def _load(tmp_path, text):
    path = tmp_path / "study.toml"
    path.write_text(text)
    return load(path)


def test_it_runs_and_is_read_again(tmp_path):
    study = _load(tmp_path, STUDY)
    assert plan(study) == "follows the equilibria over push from 0 to 8 N: at most 500 simulations"
    folder, outcome = run_study(study, tmp_path / "run")
    assert outcome.success
    assert outcome.best["values"]["limit point 1"] == pytest.approx(3.82988, rel=1e-5)
    read = TASKS["equilibrium_path"].load(study, folder.result).result
    np.testing.assert_array_equal(read.values, outcome.result.values)
    np.testing.assert_allclose(read.channels(["apex.centre.x"]), 0.0, atol=1e-9)
    assert (read.parameter, read.unit) == ("push", "N")


def test_the_ends_and_the_points_can_be_given(tmp_path):
    text = STUDY.replace("push = {} }", 'push = { start = "1 N", end = "2e-3 kN" } }')
    study = _load(tmp_path, text + "most_points = 3\n")
    _, outcome = run_study(study, tmp_path / "run")
    assert outcome.result.loads[0] == 1.0
    assert outcome.result.end == 2.0
    assert not outcome.success


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (
            STUDY.replace("over = { push", "over = { pusch"),
            "[equilibrium_path.over]: unknown parameter 'pusch'; did you",
        ),
        (STUDY.replace("push = {} }", 'push = { end = "2 m" } }'), "[equilibrium_path.over], push: '2 m'"),
        (STUDY.replace("push = {} }", "push = {}, stiffness = {} }"), "over"),
        (STUDY.replace("push = {} }", "push = { stop = 3 } }"), "unknown key 'stop'"),
        (STUDY.replace('["apex.centre.y"]', '["apex.centre.y", "apex.centre.y"]'), "channels are repeated"),
        (STUDY + "steps = 0\n", "steps"),
    ],
)
def test_what_cannot_be_meant(tmp_path, text, sentence):
    with pytest.raises(InputError) as error:
        _load(tmp_path, text)
    assert sentence in str(error.value)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (STUDY.replace('["apex.centre.y"]', '["apex.y"]'), "[equilibrium_path], channels: unknown channel 'apex.y'"),
        (
            STUDY.replace("push = {} }", "push = { start = 2, end = 2 } }"),
            "start and end are both 2. Give two different",
        ),
    ],
)
def test_what_the_model_lacks_is_refused_before_the_run(tmp_path, text, sentence):
    study = _load(tmp_path, text)
    with pytest.raises(InputError) as error:
        plan(study)
    assert sentence in str(error.value)
