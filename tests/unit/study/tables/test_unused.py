"""Parameters on which nothing depends, and studies that need too much memory."""

import pytest
from typer.testing import CliRunner

import dalembert as da
from dalembert.cli import app
from dalembert.errors import InputError
from dalembert.study import load
from dalembert.study.run.model_findings import model_findings
from dalembert.study.tables.unused import unused_parameters
from dalembert.study.text.functions import users_code
from support import says

STUDY = """
[parameters]
length = { lower = 0.5, upper = 2.0, start = 1.0 }
push = { count = 8, lower = -10.0, upper = 10.0, unit = "N" }
[constants]
half = "length/2"
[model]
[[model.body]]
kind = "RigidBar"
name = "bar"
length = "2*half"
mass = "2 kg"
angle = "-90 deg"
[[model.joint]]
kind = "RevoluteJoint"
name = "pin"
a = "ground"
b = "bar.start"
LOAD
[solver]
step = "5 ms"
"""
LOAD = """
[[model.load]]
kind = "Force"
name = "hand"
at = "bar.end"
x = { kind = "BSpline", coefficients = "push", start = 0.0, end = 2.0 }
"""
SWEEP = '[sweep]\nat = 0.1\nchannels = ["bar.end.x"]\nover = { length = { count = 3 } }\n'
REGULARISE = """
[data]
file = "motion.csv"
columns = { "bar.end.x" = "x" }
[regularise]
smooth = "push"
"""
NAMES = "'push_1', 'push_2', 'push_3', 'push_4' and 4 others"


@pytest.fixture
def path(tmp_path):
    (tmp_path / "motion.csv").write_text("t,x\n0.1,0.0\n0.2,0.1\n")
    return tmp_path / "study.toml"


def test_a_parameter_that_nothing_names_is_a_finding_of_the_check(path):
    path.write_text(STUDY.replace("LOAD", "") + SWEEP)
    (finding,) = model_findings(load(path))
    assert (finding.code, finding.severity) == ("unused-parameters", "warning")
    assert finding.values["parameters"].split(", ") == [f"push_{k}" for k in range(1, 9)]
    checked = CliRunner().invoke(app, ["check", str(path)])
    assert f"Warning: No number of the model depends on {NAMES}." in checked.output


def test_parameters_of_lists_and_of_constants_are_used(path):
    path.write_text(STUDY.replace("LOAD", LOAD) + SWEEP)
    assert unused_parameters(load(path).file) == []


def test_smooth_parameters_that_nothing_names_are_refused(path):
    path.write_text(STUDY.replace("LOAD", "") + REGULARISE)
    sentence = f"study.toml: [regularise], smooth: no number of the model depends on {NAMES}; use them in the model"
    with pytest.raises(InputError, match=says(sentence)):
        load(path)


def test_a_lack_of_memory_is_no_error_of_the_users_code():
    with (
        pytest.raises(InputError, match=r"^the study needs more memory than there is: MemoryError: 8 GB"),
        users_code(),
    ):
        raise MemoryError("8 GB")


@pytest.mark.parametrize("swarm", [da.ParticleSwarm, da.ImprovedParticleSwarm])
def test_a_swarm_has_a_million_particles_at_most(swarm):
    with pytest.raises(InputError, match=r"particles is 1e\+?09|particles is 1000000000"):
        swarm(particles=1_000_000_000)
