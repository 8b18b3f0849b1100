"""The prismatic joint, and its friction."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.fields import Number, number, require, require_not_negative
from dalembert.multibody.components.planar import friction, pairs
from dalembert.multibody.components.planar.joint import OUTPUTS, Joint, observe_joint
from dalembert.multibody.components.planar.markers import direction, spin, spin_rate, twist
from dalembert.multibody.components.planar.pairs import (
    push_pair,
    relative_angle,
    relative_spin,
    relative_spin_rate,
    separation,
    separation_rate,
    separation_second,
    twist_pair,
)
from dalembert.multibody.kernels.dual import root, sin_cos
from dalembert.multibody.kernels.kind import Kind

if TYPE_CHECKING:
    from dalembert.multibody.lowering import Lowering


@inlined
def _axis(x, p, m):
    """Unit vector of the axis, which turns with a."""
    return direction(m.a_kind, 0, x, p.a_angle + p.axis_angle)


@inlined
def _residual(x, v, a, p, m, inputs, r):
    dx, dy = separation(x, p, m)
    c, s = _axis(x, p, m)
    push_pair(x, p, m, -s * x[8], c * x[8], r)
    twist(m.a_kind, 0, x, -x[8] * (c * dx + s * dy), r)
    r[8] = c * dy - s * dx
    sine, cosine = sin_cos(relative_angle(x, p, m) - p.rest_angle)
    twist_pair(x, m, cosine * x[9], r)
    r[9] = sine


@inlined
def _rates(x, v, a, p, m, inputs, rate, second):
    dx, dy = separation(x, p, m)
    ux, uy = separation_rate(x, v, p, m)
    wx, wy = separation_second(x, v, a, p, m)
    c, s = _axis(x, p, m)
    along, across, along_rate = c * dx + s * dy, c * dy - s * dx, c * ux + s * uy
    own, own_rate = spin(m.a_kind, 0, x, v), spin_rate(m.a_kind, 0, x, v, a)
    rate[0] = c * uy - s * ux - own * along
    second[0] = c * wy - s * wx - 2 * own * along_rate - own_rate * along - own * own * across
    sine, cosine = sin_cos(relative_angle(x, p, m) - p.rest_angle)
    turn = relative_spin(x, v, m)
    rate[1] = cosine * turn
    second[1] = cosine * relative_spin_rate(x, v, a, m) - sine * turn * turn


@inlined
def _observe(x, v, a, p, m, inputs, out):
    c, s = _axis(x, p, m)
    observe_joint(x, v, p, m, s * x[8], -c * x[8], -x[9], out)


PRISMATIC = Kind(
    "prismatic",
    coordinates=pairs.COORDINATES,
    multipliers=2,
    numbers=(*pairs.NUMBERS, "rest_angle", "axis_angle"),
    integers=pairs.INTEGERS,
    residual=_residual,
    rates=_rates,
    outputs=OUTPUTS,
    observe=_observe,
    lengths=("a_x", "a_y", "b_x", "b_y"),
)


@inlined
def _resistance(x, v, p, m):
    """Axis, sliding velocity, and the friction force against it, which grows with the normal force."""
    c, s = _axis(x, p, m)
    ux, uy = separation_rate(x, v, p, m)
    rate = c * ux + s * uy
    return c, s, rate, friction.resistance(root(x[8] * x[8] + friction.TINY), rate, p)


@inlined
def _friction_residual(x, v, a, p, m, inputs, r):
    c, s, _, force = _resistance(x, v, p, m)
    push_pair(x, p, m, force * c, force * s, r)


@inlined
def _friction_energy(x, v, p, m, inputs):
    _, _, rate, force = _resistance(x, v, p, m)
    return 0.0 * rate, 0.0 * rate, -rate * force


PRISMATIC_FRICTION = Kind(
    "prismatic_friction",
    coordinates=pairs.COORDINATES,
    reactions=2,
    numbers=(*pairs.NUMBERS, "axis_angle", *friction.NUMBERS),
    integers=pairs.INTEGERS,
    residual=_friction_residual,
    energy=_friction_energy,
    dissipates=True,
)


@dataclass(frozen=True)
class PrismaticJoint(Joint):
    """A slide: point b stays on a line through point a that turns with a, and keeps its relative angle.

    Parameters
    ----------
    name : str
    a, b : Point or ground
    angle : float
        Of the line against the axes of a, rad.
    viscous : float
        Friction force per sliding velocity, N s/m.
    coulomb : float
        Constant friction force, N.
    friction_coefficient : float
        Friction force per normal force.
    slip_velocity : float
        Sliding velocity, m/s, over which the Coulomb force turns its sign.
    """

    angle: Number = number("rad", 0.0)
    viscous: Number | None = number("N*s/m", None)
    coulomb: Number | None = number("N", None)
    friction_coefficient: Number | None = number("", None)
    slip_velocity: Number = number("m/s", 1e-3)

    kind = PRISMATIC

    def __post_init__(self) -> None:
        owner = f"prismatic joint {self.name!r}"
        require_not_negative(owner, **friction.coefficients(self))
        require(owner, slip_velocity=self.slip_velocity)

    def lower(self, lowering: "Lowering") -> None:
        pair = lowering.pair(self.a, self.b, self.name)
        self._oriented()
        index = pair.slots + lowering.multipliers(self.name, 2)
        lowering.add(PRISMATIC, index, [*pair.data, pair.rest_angle, self.angle], pair.integers, self.name)
        if friction.coefficients(self):
            law = self.viscous or 0.0, self.coulomb or 0.0, self.friction_coefficient or 0.0
            numbers = [*pair.data, self.angle, *law, self.slip_velocity]
            lowering.add(PRISMATIC_FRICTION, index, numbers, pair.integers)
