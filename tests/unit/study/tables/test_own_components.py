"""A package of a user's own adds a joint, a force element, a body and an integrator, one file each."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from own_components import FILES, STUDY

CODE = """
import numpy as np, dalembert as da
import own_gears, own_pull, own_disc
from dalembert.multibody import GeneralizedAlpha
from pathlib import Path

def system(k):
    system = da.System(gravity=(0.0, 0.0))
    one = system.add(own_disc.OwnDisc("one", radius=0.5, mass=2.0, angular_velocity=3.0))
    two = system.add(own_disc.OwnDisc("two", radius=1.0, mass=1.0, position=(2.0, 0.0), angular_velocity=-1.5))
    bar = system.add(da.RigidBar("bar", length=1.0, mass=1.0, start=(0.0, 1.0)))
    for name, body in (("one", one), ("two", two)):
        system.add(da.RevoluteJoint(f"pin {name}", system.ground, body.centre))
    system.add(own_gears.OwnGears("gears", one.centre, two.centre, ratio=-0.5))
    system.add(da.RevoluteJoint("hinge", system.ground, bar.start))
    system.add(own_pull.OwnPull("pull", one.centre, bar.end, k))
    return system

times = np.linspace(0.0, 1.0, 21)
names, solver = ["bar.end.y", "two.centre.angle"], GeneralizedAlpha(step=0.01)
model = da.TimeResponse(system, {"k": (5.0, 40.0)}, names, times, solver)
y, angle = model.evaluate(np.array([20.0])).only()[0].T
assert abs(angle[-1] + 1.5) < 1e-9, angle[-1]
fit = da.identify(model, da.Measurements.of(times, {"bar.end.y": y}), seed=0)
assert abs(fit.values[0] - 20.0) < 1e-5, fit.values
Path("data.csv").write_text("t,y\\n" + "\\n".join(f"{t},{v!r}" for t, v in zip(times.tolist(), y.tolist())))
"""


@pytest.fixture(scope="module")
def package(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder on the path with four modules, and what an installation would say of them."""
    folder = tmp_path_factory.mktemp("package")
    for name, text in FILES.items():
        (folder / f"{name}.py").write_text(text)
    about = folder / "own-1.0.dist-info"
    about.mkdir()
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: own\nVersion: 1.0\n")
    names = "\n".join(f"{name} = {name}" for name in FILES)
    (about / "entry_points.txt").write_text(f"[dalembert.components]\n{names}\n")
    (folder / "study.toml").write_text(STUDY)
    return folder


def run(package: Path, *command: str) -> str:
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(package), *filter(None, sys.path)])}
    done = subprocess.run(
        [sys.executable, *command], cwd=package, env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.mark.slow
def test_they_serve_in_identify_in_a_study_and_in_its_report(package: Path) -> None:
    run(package, "-c", CODE)
    output = run(package, "-m", "dalembert.cli", "run", "study.toml", "--out", "run")
    assert "20" in output
    assert "OwnAlpha" in (package / "run" / "report.html").read_text()
