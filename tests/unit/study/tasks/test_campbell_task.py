"""The task of Campbell diagrams."""

import numpy as np
import pytest

from dalembert.errors import InputError, ModelError
from dalembert.study import load, run_study
from dalembert.study.run.runner import plan
from dalembert.study.tasks import TASKS

STUDY = """
[parameters]
speed = { lower = 0.0, upper = "200 rad/s", unit = "rad/s" }

[model]
space = true
gravity = [0.0, 0.0, 0.0]

[[model.body]]
kind = "RigidBody"
name = "disc"
inertia = { mass = 1.0, moments = [1.0, 1.0, 1.6] }
points = { tip = [0.0, 0.0, 1.0] }
angular_velocity = [0.0, 0.0, "speed"]

[[model.joint]]
kind = "SphericalJoint"
name = "ball"
a = "ground"
b = "disc.origin"

[[model.load]]
kind = "Spring"
name = "x"
a = { position = [2.0, 0.0, 1.0] }
b = "disc.tip"
stiffness = "32005 N/m"
free_length = 2.0

[[model.load]]
kind = "Spring"
name = "y"
a = { position = [0.0, 2.0, 1.0] }
b = "disc.tip"
stiffness = "32005 N/m"
free_length = 2.0

[campbell]
over = { speed = { count = 9 } }
"""


def _load(tmp_path, text):
    path = tmp_path / "study.toml"
    path.write_text(text)
    return load(path)


def test_it_runs_and_is_read_again(tmp_path):
    study = _load(tmp_path, STUDY)
    assert plan(study) == "finds the modes at 9 values of speed: 9 simulations"
    folder, outcome = run_study(study, tmp_path / "run")
    assert outcome.success
    np.testing.assert_allclose(outcome.result.frequencies[-1], [12.73, 63.66], atol=0.01)
    assert outcome.best["values"]["critical speed 1"] == pytest.approx(np.sqrt(32005 / 2.6), rel=1e-3)
    read = TASKS["campbell"].load(study, folder.result).result
    np.testing.assert_array_equal(read.roots, outcome.result.roots)
    assert (read.parameter, read.unit) == ("speed", "rad/s")


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (STUDY.replace("over = { speed", "over = { sped"), "[campbell.over]: unknown parameter 'sped'; did you mean"),
        (STUDY + 'frame = "turning"\n', "frame"),
        (STUDY + "count = 0\n", "count"),
    ],
)
def test_what_cannot_be_meant(tmp_path, text, sentence):
    with pytest.raises(InputError) as error:
        _load(tmp_path, text)
    assert sentence in str(error.value)


def test_what_is_not_steady_is_refused_before_the_run(tmp_path):
    study = _load(
        tmp_path,
        STUDY.replace("moments = [1.0, 1.0, 1.6]", "moments = [1.0, 1.2, 1.6]").replace(
            'name = "y"\na = { position = [0.0, 2.0, 1.0] }', 'name = "y"\na = { position = [2.0, 0.0, 1.0] }'
        ),
    )
    with pytest.raises(ModelError, match="the motion at the start is not steady"):
        plan(study)
