"""A joint, a force element, a body and an integrator, each as the text of one file, and a study that names them."""

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
from dalembert.multibody.components.base_body import with_points
from dalembert.multibody.components.planar.rigid import PlanarRigid
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
class OwnDisc(PlanarRigid):
    """A disc without weight."""

    radius: Number = number("m")
    mass: Number = number("kg")
    position: Place = pair("m")
    angular_velocity: Number | None = number("rad/s", None)

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
FILES = {"own_gears": GEAR, "own_pull": PULL, "own_disc": BODY, "own_alpha": INTEGRATOR}
"""Texts by the names of their modules."""
SWARM = '''
"""One more swarm."""

from dataclasses import dataclass
from typing import ClassVar
from dalembert.optimize.particle_swarm import ParticleSwarm

@dataclass(frozen=True)
class SlowSwarm(ParticleSwarm):
    """A swarm with small velocities."""

    name: ClassVar[str] = "slow-swarm"
    velocity_limit: float | None = 0.05
'''
SAMPLING = '''
"""One more sampling."""

from dataclasses import dataclass
from typing import ClassVar
import numpy as np
from dalembert.uncertainty.samplings import Drawn

@dataclass(frozen=True)
class Diagonal(Drawn):
    """Points on the diagonal of the box."""

    name: ClassVar[str] = "diagonal"
    message: ClassVar[str] = "The bounds are the extremes on the diagonal."
    runs: int = 11

    def shares(self, dimensions, seed):
        return np.tile(np.linspace(0.0, 1.0, self.runs)[:, None], (1, dimensions))
'''
FORMAT = '''
"""One more format: pairs of a name and its numbers."""

import numpy as np
from dalembert.data.columns import Columns, chosen
from dalembert.data.format import Format

class Lines(Format):
    """A line for each column: its name and its numbers."""

    name = "lines"
    suffixes = (".lines",)

    def columns(self, path, request):
        rows = [line.split() for line in path.read_text().splitlines()]
        table = {name: np.array(numbers, dtype=float) for name, *numbers in rows}
        return Columns(path, str(request.time), *chosen(path, table, str(request.time), request.labels, request.missing))
'''
METHODS = {
    "optimize/slow_swarm": SWARM,
    "uncertainty/diagonal": SAMPLING,
    "data/formats/lines": FORMAT,
}
"""Texts of a swarm, a sampling and a format of data, by the place of their modules."""
