"""A package of a user's own adds a joint, a force element, a body and an integrator, one file each."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

GEAR = '''
from dataclasses import dataclass
from dalembert.kernels.kernel import inner
from dalembert.multibody import Joint, Kind
from dalembert.multibody.components.fields import Number, number
from dalembert.multibody.components.planar import pairs
from dalembert.multibody.components.planar.markers import angle

@inner
def constraint(x, p, m, inputs, g):
    g[0] = angle(m.b_kind, 4, x, p.b_angle) - p.ratio * angle(m.a_kind, 0, x, p.a_angle) - p.offset

GEARS = Kind("own_gears", coordinates=8, multipliers=1, numbers=(*pairs.NUMBERS, "ratio", "offset"),
             integers=pairs.INTEGERS, constraint=constraint)

@dataclass(frozen=True)
class OwnGears(Joint):
    """A fixed ratio between two angles."""

    ratio: Number = number("")

    kind = GEARS

    def lower(self, lowering):
        pair = lowering.pair(self.a, self.b, self.name)
        offset = pair.angles[1] - self.ratio * pair.angles[0]
        index = pair.slots + lowering.multipliers(self.name, 1)
        lowering.add(GEARS, index, [*pair.data, self.ratio, offset], pair.integers, self.name)
'''
PULL = '''
from dataclasses import dataclass
from dalembert.kernels.kernel import inner
from dalembert.multibody import Kind, Load
from dalembert.multibody.components.fields import Number, number
from dalembert.multibody.components.planar import pairs
from dalembert.multibody.components.points import Side

@inner
def residual(x, v, a, p, m, inputs, r):
    dx, dy = pairs.separation(x, p, m)
    pairs.push_pair(x, p, m, p.stiffness * dx, p.stiffness * dy, r)

PULLS = Kind("own_pull", coordinates=8, numbers=(*pairs.NUMBERS, "stiffness"), integers=pairs.INTEGERS,
             residual=residual)

@dataclass(frozen=True)
class OwnPull(Load):
    """A force that grows with the distance."""

    a: Side
    b: Side
    stiffness: Number = number("N/m")

    kind = PULLS

    def lower(self, lowering):
        pair = lowering.pair(self.a, self.b, self.name)
        lowering.add(PULLS, pair.slots, [*pair.data, self.stiffness], pair.integers, self.name)
'''
BODY = '''
from dataclasses import dataclass
from dalembert.kernels.kernel import inner
from dalembert.multibody import Kind
from dalembert.multibody.components.fields import Number, number, pair
from dalembert.multibody.components.planar.body import with_points
from dalembert.multibody.components.planar.rigid import Rigid
from dalembert.multibody.components.points import Place

@inner
def residual(x, v, a, p, m, inputs, r):
    r[0], r[1] = p.mass * a[0], p.mass * a[1]
    r[2] = p.inertia * a[2]

@inner
def energy(x, v, p, m, inputs):
    return 0.5 * (p.mass * (v[0] * v[0] + v[1] * v[1]) + p.inertia * v[2] * v[2]), 0.0 * v[0], 0.0 * v[0]

DISC = Kind("own_disc", coordinates=3, numbers=("mass", "inertia"), residual=residual, energy=energy)

@with_points("centre")
@dataclass(frozen=True)
class OwnDisc(Rigid):
    """A disc without weight."""

    radius: Number = number("m")
    mass: Number = number("kg")
    position: Place = pair("m")
    angular_velocity: Number = number("rad/s", 0.0)

    @property
    def place(self):
        return self.position

    @property
    def point_names(self):
        return ("centre",)

    @property
    def offset(self):
        return 0.0, 0.0

    @property
    def inertias(self):
        return self.mass, 0.5 * self.mass * self.radius**2

    def local(self, point):
        return 0.0, 0.0

    def lower(self, lowering, first):
        lowering.add(DISC, [first, first + 1, first + 2], self.inertias)
'''
INTEGRATOR = '''
from dataclasses import dataclass
from dalembert.multibody import GeneralizedAlpha

@dataclass(frozen=True)
class OwnAlpha(GeneralizedAlpha):
    """Generalized-alpha with a damping of its own."""

    spectral_radius: float = 0.5
'''
STUDY = """
[study]
name = "own"

[parameters.k]
lower = 5.0
upper = 40.0

[model]
gravity = [0.0, 0.0]
body = [
    {kind = "OwnDisc", name = "one", radius = 0.5, mass = 2.0, angular_velocity = 3.0},
    {kind = "OwnDisc", name = "two", radius = 1.0, mass = 1.0, position = [2.0, 0.0], angular_velocity = -1.5},
    {kind = "RigidBar", name = "bar", length = 1.0, mass = 1.0, start = [0.0, 1.0]},
]
joint = [
    {kind = "RevoluteJoint", name = "pin1", a = "ground", b = "one.centre"},
    {kind = "RevoluteJoint", name = "pin2", a = "ground", b = "two.centre"},
    {kind = "OwnGears", name = "gears", a = "one.centre", b = "two.centre", ratio = -0.5},
    {kind = "RevoluteJoint", name = "hinge", a = "ground", b = "bar.start"},
]
load = [
    {kind = "OwnPull", name = "pull", a = "one.centre", b = "bar.end", stiffness = "k"},
]

[solver]
kind = "OwnAlpha"
step = 0.01

[data]
file = "data.csv"
columns = {"bar.end.y" = "y"}

[identify]
"""
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
    files = {"own_gears": GEAR, "own_pull": PULL, "own_disc": BODY, "own_alpha": INTEGRATOR}
    for name, text in files.items():
        (folder / f"{name}.py").write_text(text)
    about = folder / "own-1.0.dist-info"
    about.mkdir()
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: own\nVersion: 1.0\n")
    names = "\n".join(f"{name} = {name}" for name in files)
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


def test_they_serve_in_identify_in_a_study_and_in_its_report(package: Path) -> None:
    run(package, "-c", CODE)
    output = run(package, "-m", "dalembert.cli", "run", "study.toml", "--out", "run")
    assert "20" in output
    assert "OwnAlpha" in (package / "run" / "report.html").read_text()
