"""What a user waits for before anything is computed."""

import subprocess
import sys
import time
from pathlib import Path

import pytest

from dalembert.component_index import HOMES, KINDS

QUIET = 0.12  # s that the loop takes on a quiet machine
DEMO = Path(__file__).parents[2] / "studies" / "flexible-pendulum" / "identify.toml"
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


def loop() -> float:
    """Processor time of a loop in plain Python."""
    began, total = time.process_time(), 0
    for i in range(2_000_000):
        total += i * i & 7
    return time.process_time() - began


def waiting_time(*arguments: str | Path) -> float:
    """Processor time of the command with arguments, as on a quiet machine."""
    resource = pytest.importorskip("resource")

    def used() -> float:
        children = resource.getrusage(resource.RUSAGE_CHILDREN)
        return children.ru_utime + children.ru_stime

    slowness, before = loop(), used()
    subprocess.run([sys.executable, "-m", "dalembert.cli", *arguments], capture_output=True, check=True)
    spent = used() - before
    return spent * QUIET / min(slowness, loop())


def test_the_help_text_comes_within_half_a_second() -> None:
    assert min(waiting_time("--help") for _ in range(3)) < 0.5


@pytest.mark.slow
def test_the_demo_comes_within_five_seconds_once_its_kernels_are_compiled(tmp_path: Path) -> None:
    assert min(waiting_time("run", DEMO, "--out", tmp_path, "--force") for _ in range(4)) < 5.0


@pytest.mark.parametrize("study", [SWING, FIT], ids=["simulate", "identify"])
def test_a_study_loads_nothing_heavy_that_it_does_not_name(tmp_path: Path, study: str) -> None:
    (tmp_path / "study.toml").write_text(study)
    (tmp_path / "model.py").write_text(LINE)
    (tmp_path / "data.csv").write_text("t,x\n" + "\n".join(f"{n / 10},{n / 5}" for n in range(11)))
    code = "import sys; from dalembert.cli import app; app(standalone_mode=False); print('LOADED', *sys.modules)"
    command = [sys.executable, "-c", code, "run", "study.toml", "--out", "run"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    loaded = set(done.stdout.partition("LOADED")[2].split())
    assert loaded & HEAVY == set()
    assert loaded & MINIMISING == (set() if study == SWING else MINIMISING)
    expected = {"dalembert.multibody.integrators.generalized_alpha"} if study == SWING else set()
    assert loaded & INTEGRATORS == expected
