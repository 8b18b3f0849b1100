"""Kinds with internal constraints, which several test files share: a bob on a circle, and a heavy top in space."""

from dataclasses import dataclass, replace

import numpy as np

import dalembert.multibody as mb
from dalembert.kernels.kernel import inlined
from dalembert.kernels.views import stack
from dalembert.multibody.components.base_body import POSITION, with_points
from dalembert.multibody.components.fields import Number
from dalembert.multibody.components.planar import markers
from dalembert.multibody.components.planar.body import GRADIENT, Body, Marker
from dalembert.multibody.components.planar.joint import Joint
from dalembert.multibody.components.planar.load import Load
from dalembert.multibody.kernels.charts import Chart, flat
from dalembert.multibody.kernels.elementary import reciprocal, root
from dalembert.multibody.kernels.kind import Kind


# A bob at (x, y) on a circle about the origin; its increment is the angle.
@inlined
def turned(x, d, dx):
    dx[0], dx[1] = -x[1] * d[0], x[0] * d[0]


@inlined
def cayley(x, d, dx):
    half = 0.5 * d[0]
    f = d[0] * reciprocal(1.0 + half * half)
    dx[0], dx[1] = f * (-x[1] - half * x[0]), f * (x[0] - half * x[1])


@inlined
def onto_circle(x, p, m, dx):
    f = p.radius * reciprocal(root(x[0] * x[0] + x[1] * x[1])) - 1.0
    dx[0], dx[1] = f * x[0], f * x[1]


@inlined
def circle(x, p, m, inputs, g):
    g[0] = 0.5 * (x[0] * x[0] + x[1] * x[1] - p.radius * p.radius)


CIRCLE_CHART = Chart(2, 1, turned, cayley, onto_circle)
CIRCLE = Kind("circle", coordinates=2, multipliers=1, numbers=("radius",), constraint=circle, chart=CIRCLE_CHART)


@inlined
def weighs(x, v, a, p, m, inputs, r):
    r[0], r[1] = p.mass * a[0] + p.drag * v[0], p.mass * (a[1] - p.gravity) + p.drag * v[1]


BOB = Kind(
    "bob",
    coordinates=2,
    numbers=("mass", "gravity", "drag"),
    residual=weighs,
    dissipates="drag",
    charts=(CIRCLE_CHART,),
)


@inlined
def pull(x, v, a, p, m, inputs, r):
    for k in range(2):
        force = p.stiffness * (x[2 + k] - x[k])
        r[k] -= force
        r[2 + k] += force


TIE = Kind("tie", coordinates=4, numbers=("stiffness",), residual=pull, charts=(CIRCLE_CHART, flat(2)))


@inlined
def rod(x, p, m, inputs, g):
    dx, dy = x[2] - x[0], x[3] - x[1]
    g[0] = 0.5 * (dx * dx + dy * dy - p.length * p.length)


ROD = Kind(
    "nodal_rod", coordinates=4, multipliers=1, numbers=("length",), constraint=rod, charts=(CIRCLE_CHART, flat(2))
)


# A rigid body by its centre of mass and three directors; increments of the directors are those of a rotation.
@inlined
def cross(t, d, at, out):
    """Rotation rates of three directors."""
    for i in range(at, at + 9, 3):
        out[i] = t[1] * d[i + 2] - t[2] * d[i + 1]
        out[i + 1] = t[2] * d[i] - t[0] * d[i + 2]
        out[i + 2] = t[0] * d[i + 1] - t[1] * d[i]


@inlined
def rotated(x, d, dx):
    cross(d, x, 0, dx)


@inlined
def cayley_in_space(x, d, dx):
    f = reciprocal(1.0 + 0.25 * (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]))
    for i in range(0, 9, 3):
        a, b, c = d[1] * x[i + 2] - d[2] * x[i + 1], d[2] * x[i] - d[0] * x[i + 2], d[0] * x[i + 1] - d[1] * x[i]
        dx[i] = f * (a + 0.5 * (d[1] * c - d[2] * b))
        dx[i + 1] = f * (b + 0.5 * (d[2] * a - d[0] * c))
        dx[i + 2] = f * (c + 0.5 * (d[0] * b - d[1] * a))


@inlined
def orthonormal(x, p, m, dx):
    """Newton's iteration for the nearest rotation, D <- 1.5 D - 0.5 D (D^T D), to rounding."""
    before = stack(x, 9)
    for i in range(9):
        dx[i] = 0.0 * x[i]
    for _ in range(20):
        largest = 0.0
        for i in range(9):
            before[i] = x[i] + dx[i]
        for i in range(3):
            for j in range(3):
                product = before[3 * i] * before[3 * j]
                product += before[3 * i + 1] * before[3 * j + 1] + before[3 * i + 2] * before[3 * j + 2]
                if i == j:
                    product -= 1.0
                largest = max(largest, abs(product.real))
                for k in range(3):
                    dx[3 * i + k] -= 0.5 * product * before[3 * j + k]
        if largest < 1e-8:  # its square is rounding
            break


@inlined
def unit(x, p, m, inputs, g):
    number = 0
    for i in range(3):
        for j in range(i, 3):
            g[number] = x[3 * i] * x[3 * j] + x[3 * i + 1] * x[3 * j + 1] + x[3 * i + 2] * x[3 * j + 2]
            if i == j:
                g[number] = 0.5 * (g[number] - 1.0)
            number += 1


DIRECTORS_CHART = Chart(9, 3, rotated, cayley_in_space, orthonormal)
DIRECTORS = Kind("directors", coordinates=9, multipliers=6, numbers=(), constraint=unit, chart=DIRECTORS_CHART)
POSE = (flat(3), DIRECTORS_CHART)


@inlined
def spins(x, v, a, p, m, inputs, r):
    for k in range(3):
        r[k] = p.mass * a[k]
        r[3 + k], r[6 + k], r[9 + k] = p.first * a[3 + k], p.second * a[6 + k], p.third * a[9 + k]
    r[2] += p.mass * p.gravity


RIGID = Kind(
    "rigid_in_space",
    coordinates=12,
    numbers=("mass", "first", "second", "third", "gravity"),
    residual=spins,
    charts=POSE,
)


@inlined
def socket(x, p, m, inputs, g):
    for k in range(3):
        g[k] = x[k] - p.arm * x[6 + k]


SOCKET = Kind("socket", coordinates=12, multipliers=3, numbers=("arm",), constraint=socket, charts=POSE)

#: The same kinds with internal constraints as ordinary ones.
FULL = {
    kind: replace(kind, name=f"{kind.name}_full", chart=None, charts=())
    for kind in (CIRCLE, BOB, TIE, ROD, DIRECTORS, RIGID, SOCKET)
}


def of(kind: Kind, full: bool) -> Kind:
    """The kind, or its variant for the full system."""
    return FULL[kind] if full else kind


@with_points("centre")
@dataclass(frozen=True)
class Bob(Body):
    """A point mass on a circle about the origin."""

    mass: Number
    position: tuple[Number, Number]
    radius: Number
    drag: Number = 0.0
    full: bool = False

    @property
    def place(self):
        return self.position

    @property
    def coordinate_kinds(self):
        return (POSITION, POSITION)

    @property
    def turns(self):
        return False

    @property
    def point_names(self):
        return ("centre",)

    def coordinates(self, x, y, angle):
        return np.array([x, y])

    def marker(self, point):
        return Marker(markers.MASS, (0, 1, None, None), (0.0, 0.0, 0.0))

    def lower(self, lowering, first):
        index = [first, first + 1]
        lowering.add(of(BOB, self.full), index, [self.mass, lowering.gravity[1], self.drag])
        lowering.add(of(CIRCLE, self.full), index + lowering.multipliers(self.name, 1), [self.radius])

    def outline(self, coordinates, points):
        return coordinates[:, None, :]


@dataclass(frozen=True)
class Tie(Load):
    """A spring without length from a bob to a point mass."""

    a: mb.Point
    b: mb.Point
    stiffness: Number
    full: bool = False

    kind = TIE

    def lower(self, lowering):
        slots = lowering.pair(self.a, self.b, self.name).slots
        lowering.add(of(TIE, self.full), [*slots[:2], *slots[4:6]], [self.stiffness])


@dataclass(frozen=True)
class Rod(Joint):
    """A massless rod from a bob to a point mass."""

    full: bool = False

    kind = ROD

    def lower(self, lowering):
        pair = lowering.pair(self.a, self.b, self.name)
        index = [*pair.slots[:2], *pair.slots[4:6], *lowering.multipliers(self.name, 1)]
        lowering.add(of(ROD, self.full), index, [pair.distance], name=self.name)


INERTIA = (0.234375, 0.46875, 0.234375)


@with_points("centre")
@dataclass(frozen=True)
class Top(Body):
    """The heavy top on a spherical joint at the origin, its centre of mass one metre along the second director."""

    mass: Number = 15.0
    spin: Number = 150.0
    full: bool = False

    @property
    def place(self):
        return (0.0, 1.0)

    @property
    def motion(self):
        return 1.0, 0.0, 0.0

    @property
    def coordinate_kinds(self):
        return (POSITION, POSITION, *(GRADIENT,) * 10)

    @property
    def turns(self):
        return False

    @property
    def point_names(self):
        return ("centre",)

    def coordinates(self, x, y, angle):
        return np.array([x, y, 0.0, *np.eye(3).ravel()])

    def rigid_modes(self, coordinates, frame):
        spin = np.array([0.0, self.spin, -4.61538])
        modes = np.zeros((12, 3), np.result_type(coordinates, spin))
        modes[:, 0] = np.cross(spin, coordinates.reshape(4, 3)).ravel()
        return modes

    def marker(self, point):
        return Marker(markers.MASS, (0, 1, None, None), (0.0, 0.0, 0.0))

    def lower(self, lowering, first):
        moments = [0.5 * sum(INERTIA) - moment for moment in INERTIA]
        index = list(range(first, first + 12))
        lowering.add(of(RIGID, self.full), index, [self.mass, *moments, 9.81])
        lowering.add(of(DIRECTORS, self.full), index[3:] + lowering.multipliers(self.name, 6), [])
        lowering.add(of(SOCKET, self.full), index + lowering.multipliers(self.name, 3), [1.0])

    def outline(self, coordinates, points):
        return coordinates[:, None, :2]


def top(mass: Number = 15.0, spin: Number = 150.0, full: bool = False) -> mb.System:
    """The heavy top."""
    system = mb.System()
    system.add(Top("top", mass, spin, full))
    return system
