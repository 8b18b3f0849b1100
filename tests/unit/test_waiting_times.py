"""What a user waits for before anything is computed."""

import subprocess
import sys
from pathlib import Path

import pytest

from dalembert.component_index import HOMES, KINDS

HELPING = {"dalembert", "typer", "rich", "pygments", "markdown_it", "mdurl", "shellingham"}
HELPING |= {"annotated_doc", "annotated_types", "attr", "typing_extensions", "click"}
HEAVY = {"xarray", "pandas", "scipy.interpolate", "scipy.stats", "dask"}
HEAVY |= {"dalembert.vibration", "dalembert.uncertainty"}
MINIMISING = {"scipy.optimize", "scipy.spatial", "scipy.special"}  # the first one imports the others
INTEGRATORS = {f"dalembert.multibody.{HOMES[name]}" for name in KINDS["Integrator"]}
SWING = """
[model]
body = [{ kind = "RigidBar", name = "bar", length = "400 mm", mass = "2 kg" }]
joint = [{ kind = "RevoluteJoint", name = "pin", a = "ground", b = "bar.start" }]
[solver]
step = "1 ms"
[simulate]
end = 0.01
"""
LINE = """
import numpy as np
from dalembert.forward import PythonModel

def line(parameters):
    times = np.linspace(0.0, 1.0, 11)
    return PythonModel(lambda slope: slope * times, parameters, ["x"], times)
"""
FIT = """
[parameters]
slope = { lower = 0.0, upper = 3.0 }
[model]
forward = "model.py:line"
[data]
file = "data.csv"
columns = { x = "x" }
[identify]
prediction = true
"""


def loaded(arguments: list[str], folder: Path) -> set[str]:
    """Names of the modules that the command line loads with arguments."""
    code = f"import sys; from dalembert.cli import app; app({arguments}, standalone_mode=False); print('LOADED', *sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return set(done.stdout.partition("LOADED")[2].split())


def test_the_help_text_loads_no_numerical_library(tmp_path: Path) -> None:
    """The installed packages load themselves at the start of Python, without the command."""
    code = "import sys; print(*sys.modules)"
    plain = set(subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split())
    packages = {name.partition(".")[0] for name in loaded(["--help"], tmp_path) - plain}
    assert packages - set(sys.stdlib_module_names) <= HELPING


@pytest.mark.parametrize("study", [SWING, FIT], ids=["simulate", "identify"])
def test_a_study_loads_nothing_heavy_that_it_does_not_name(tmp_path: Path, study: str) -> None:
    (tmp_path / "study.toml").write_text(study)
    (tmp_path / "model.py").write_text(LINE)
    (tmp_path / "data.csv").write_text("t,x\n" + "\n".join(f"{n / 10},{n / 5}" for n in range(11)))
    names = loaded(["run", "study.toml", "--out", "run"], tmp_path)
    assert names & HEAVY == set()
    assert names & MINIMISING == (set() if study == SWING else MINIMISING)
    expected = {"dalembert.multibody.integrators.generalized_alpha.generalized_alpha"} if study == SWING else set()
    assert names & INTEGRATORS == expected
