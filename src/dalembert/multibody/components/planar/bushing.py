"""Bushings: elastic bearings with stiffness and damping in both directions and in torsion."""

__all__ = ["Bushing"]

from dataclasses import dataclass
from typing import Any

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.fields import Number, number
from dalembert.multibody.components.planar.angle_coordinate import AngleCoordinate, counted_angle
from dalembert.multibody.components.planar.load import Load
from dalembert.multibody.components.planar.markers import direction, spin, twist
from dalembert.multibody.components.planar.pairs import (
    COORDINATES,
    pair_kind,
    push_pair,
    relative_angle,
    relative_spin,
    separation,
    separation_rate,
    twist_pair,
)
from dalembert.multibody.components.points import Side, require_direction
from dalembert.multibody.components.rows import Lowering
from dalembert.multibody.kernels.kind import Kind


@inlined
def _displacement(x, v, p, m):
    """Displacement of b against a and its rate, in the axes of a."""
    c, s = direction(m.a_kind, 0, x, p.a_angle)
    dx, dy = separation(x, p, m)
    ux, uy = separation_rate(x, v, p, m)
    turn = spin(m.a_kind, 0, x, v)
    along, across = c * dx + s * dy, c * dy - s * dx
    along_rate, across_rate = c * ux + s * uy + turn * across, c * uy - s * ux - turn * along
    return along - p.rest_x, across - p.rest_y, along_rate, across_rate


@inlined
def _twist(x, v, p, m):
    """Twist and its rate."""
    return relative_angle(x, p, m) - p.rest_angle, relative_spin(x, v, m)


@inlined
def _counted_twist(x, v, p, m):
    """Twist and its rate by the counted angle."""
    return x[COORDINATES] - p.rest_angle, v[COORDINATES]


@inlined
def _exert(x, m, torque, r):
    twist_pair(x, m, torque, r)


@inlined
def _exert_counted(x, m, torque, r):
    r[COORDINATES] += torque


LAWS = ("stiffness_x", "stiffness_y", "stiffness_angle", "damping_x", "damping_y", "damping_angle")


def _bushing(name: str, twisting: Any, exerting: Any, coordinates: int) -> Kind:
    """Kind of a bushing, from its twist and rate and from what exerts its torque."""

    @inlined
    def loads(x, v, p, m):
        """Force on a along its axes, and torque on a."""
        along, across, along_rate, across_rate = _displacement(x, v, p, m)
        angle, rate = twisting(x, v, p, m)
        fx = p.stiffness_x * along + p.damping_x * along_rate
        fy = p.stiffness_y * across + p.damping_y * across_rate
        return fx, fy, p.stiffness_angle * angle + p.damping_angle * rate

    @inlined
    def residual(x, v, a, p, m, inputs, r):
        """The force acts at b; on a it has a lever, the displacement."""
        fx, fy, torque = loads(x, v, p, m)
        c, s = direction(m.a_kind, 0, x, p.a_angle)
        gx, gy = c * fx - s * fy, s * fx + c * fy
        dx, dy = separation(x, p, m)
        push_pair(x, p, m, gx, gy, r)
        twist(m.a_kind, 0, x, -(dx * gy - dy * gx), r)
        exerting(x, m, torque, r)

    @inlined
    def energy(x, v, p, m, inputs):
        along, across, along_rate, across_rate = _displacement(x, v, p, m)
        angle, rate = twisting(x, v, p, m)
        stored = p.stiffness_x * along * along + p.stiffness_y * across * across + p.stiffness_angle * angle * angle
        lost = (
            p.damping_x * along_rate * along_rate
            + p.damping_y * across_rate * across_rate
            + p.damping_angle * rate * rate
        )
        return 0.0 * stored, 0.5 * stored, -lost

    @inlined
    def observe(x, v, a, p, m, inputs, out):
        out[0], out[1], _, _ = _displacement(x, v, p, m)
        out[2], _ = twisting(x, v, p, m)
        out[3], out[4], out[5] = loads(x, v, p, m)

    return pair_kind(
        name, ("rest_x", "rest_y", "rest_angle", *LAWS),
        coordinates=coordinates,
        residual=residual,
        energy=energy,
        outputs=(("x", "m"), ("y", "m"), ("angle", "rad"), ("force_x", "N"), ("force_y", "N"), ("torque", "N*m")),
        observe=observe,
        dissipates=LAWS[3:],
        holds=True,
    )  # fmt: skip


BUSHING = _bushing("bushing", _twist, _exert, COORDINATES)
COUNTED_BUSHING = _bushing("counted_bushing", _counted_twist, _exert_counted, COORDINATES + 1)


@dataclass(frozen=True)
class Bushing(Load):
    """An elastic bearing between two points, without force as the bodies are placed.

    A spring with a damper acts along each axis of a, and a torsion spring with a damper between their angles:
    force = stiffness x displacement + damping x velocity, of b relative to a. The three are uncoupled. Both forces act
    at the place of b: a also takes their moment, with the lever from a to b. The angle counts whole turns, also of
    nodes of beams.

    Parameters
    ----------
    name : str
    a, b : Point or ground
    stiffness_x, stiffness_y : float
        Along the axes of a, N/m.
    stiffness_angle : float
        N m/rad.
    damping_x, damping_y : float
        N s/m.
    damping_angle : float
        N m s/rad.

    Examples
    --------
    >>> from dalembert.multibody import RigidBody, System, equilibrium
    >>> system = System(gravity=(0.0, -10.0))
    >>> block = system.add(RigidBody("block", mass=2.0, inertia=0.1))
    >>> rubber = system.add(Bushing("rubber", system.ground, block.centre, 1e3, 4e3, 50.0))
    >>> float(equilibrium(system).channels(["block.centre.y"])[0].round(9))
    -0.005
    """

    a: Side
    b: Side
    stiffness_x: Number = number("N/m", least=0)
    stiffness_y: Number = number("N/m", least=0)
    stiffness_angle: Number = number("N*m/rad", 0.0, least=0)
    damping_x: Number = number("N*s/m", 0.0, least=0)
    damping_y: Number = number("N*s/m", 0.0, least=0)
    damping_angle: Number = number("N*m*s/rad", 0.0, least=0)

    kind = BUSHING

    @property
    def coordinates(self) -> tuple[AngleCoordinate, ...]:
        return counted_angle(self.name, self.a, self.b)

    def lower(self, lowering: Lowering) -> None:
        require_direction(f"bushing {self.name!r}", "a spring, or a rigid body", self.a, self.b)
        pair = lowering.pair(self.a, self.b, self.name)
        numbers = [*pair.data, *pair.relative, pair.rest_angle, *(getattr(self, name) for name in LAWS)]
        index = [lowering.coordinate(own)[0] for own in self.coordinates]
        kind = COUNTED_BUSHING if index else BUSHING
        lowering.add(kind, [*pair.slots, *index], numbers, pair.unwrapped, self.name)
