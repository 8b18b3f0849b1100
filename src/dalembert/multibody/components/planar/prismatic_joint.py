"""The prismatic joint, and its friction."""

__all__ = ["PrismaticJoint"]

from dataclasses import dataclass

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.base_joint import Smoothing
from dalembert.multibody.components.fields import Number, number
from dalembert.multibody.components.laws import friction_law as friction
from dalembert.multibody.components.planar.joint import OUTPUTS, Joint, joint_kind, observe_joint
from dalembert.multibody.components.planar.markers import direction, twist
from dalembert.multibody.components.planar.pairs import (
    pair_kind,
    push_pair,
    relative_angle,
    separation,
    separation_rate,
    twist_pair,
)
from dalembert.multibody.components.rows import Lowering
from dalembert.multibody.kernels.elementary import root, sin_cos
from dalembert.multibody.kernels.kind import Kind


@inlined
def _axis(x, p, m):
    """Unit vector of the axis, which turns with a."""
    return direction(m.a_kind, 0, x, p.a_angle + p.axis_angle)


@inlined
def _sliding(x, v, p, m):
    """Velocity of b along the axis."""
    c, s = _axis(x, p, m)
    ux, uy = separation_rate(x, v, p, m)
    return c * ux + s * uy


@inlined
def _turned(x, p, m):
    """Sine and cosine of the angle by which b has turned against a."""
    return sin_cos(relative_angle(x, p, m) - p.rest_angle)


@inlined
def _constraint(x, p, m, inputs, g):
    """Distance of b from the axis, and the relative angle."""
    dx, dy = separation(x, p, m)
    c, s = _axis(x, p, m)
    g[0] = c * dy - s * dx
    g[1], _ = _turned(x, p, m)


@inlined
def _forces(x, p, m, r):
    dx, dy = separation(x, p, m)
    c, s = _axis(x, p, m)
    push_pair(x, p, m, -s * x[8], c * x[8], r)
    twist(m.a_kind, 0, x, -x[8] * (c * dx + s * dy), r)
    twist_pair(x, m, _turned(x, p, m)[1] * x[9], r)


@inlined
def _observe(x, v, a, p, m, inputs, out):
    c, s = _axis(x, p, m)
    observe_joint(x, v, p, m, s * x[8], -c * x[8], -x[9], out)
    out[5] = _sliding(x, v, p, m)


PRISMATIC = joint_kind(
    "prismatic", 2, ("rest_angle", "axis_angle"),
    constraint=_constraint, forces=_forces, outputs=(*OUTPUTS, ("sliding_velocity", "m/s")), observe=_observe,
)  # fmt: skip


@inlined
def _resistance(x, v, p, m):
    """Axis, sliding velocity, and the friction force against it, which grows with the normal force."""
    c, s = _axis(x, p, m)
    rate = _sliding(x, v, p, m)
    return c, s, rate, friction.resistance(root(x[8] * x[8] + friction.TINY), rate, p)


@inlined
def _friction_residual(x, v, a, p, m, inputs, r):
    c, s, _, force = _resistance(x, v, p, m)
    push_pair(x, p, m, force * c, force * s, r)


@inlined
def _friction_energy(x, v, p, m, inputs):
    _, _, rate, force = _resistance(x, v, p, m)
    return 0.0 * rate, 0.0 * rate, -rate * force


@inlined
def _observe_friction(x, v, a, p, m, inputs, out):
    out[0] = -_resistance(x, v, p, m)[3]


PRISMATIC_FRICTION = pair_kind(
    "prismatic_friction", ("axis_angle", *friction.NUMBERS),
    reactions=2, residual=_friction_residual, energy=_friction_energy, outputs=friction.FORCE,
    observe=_observe_friction, dissipates=True,
)  # fmt: skip


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
        Sliding velocity, m/s, over which dry friction turns its sign, as tanh(velocity / slip_velocity). The
        finding ``slip-rate`` of a trajectory says whether it suits the motion, as for a revolute joint.
    stribeck : float
        Friction force at low velocities beyond that of Coulomb, N. It decreases with the velocity as
        stribeck x exp(-\\|velocity / stribeck_velocity\\|^stribeck_exponent).
    stribeck_velocity : float
        m/s.
    stribeck_exponent : float
        2 (the default) for a Gaussian decrease, 1 for an exponential one.

    The output ``sliding_velocity`` is the velocity of b against a along the line. An initial state may state
    ``displacement``, the position of b against a along the line.
    """

    angle: Number = number("rad", 0.0)
    viscous: Number | None = number("N*s/m", None, least=0)
    coulomb: Number | None = number("N", None, least=0)
    friction_coefficient: Number | None = number("", None, least=0)
    slip_velocity: Number = number("m/s", 1e-3, above=0)
    stribeck: Number | None = number("N", None, least=0)
    stribeck_velocity: Number | None = number("m/s", None, above=0)
    stribeck_exponent: Number = number("", 2.0, above=0)

    kind = PRISMATIC

    def __post_init__(self) -> None:
        friction.check(f"prismatic joint {self.name!r}", self, "stribeck_velocity")

    @property
    def smoothing(self) -> Smoothing | None:
        if not friction.rubs(self):
            return None
        return Smoothing("sliding_velocity", "slip_velocity", self.slip_velocity, "m/s")

    @property
    def parts(self) -> dict[str, Kind]:
        return {"friction": PRISMATIC_FRICTION} if friction.coefficients(self) else {}

    @property
    def stated_coordinates(self) -> tuple[str, ...]:
        return ("displacement",)

    def lower(self, lowering: Lowering) -> None:
        pair = lowering.pair(self.a, self.b, self.name)
        self._oriented()
        index = self._add(lowering, pair, [pair.rest_angle, self.angle])
        if friction.coefficients(self):
            law = friction.law(self, self.friction_coefficient or 0.0, self.slip_velocity, self.stribeck_velocity)
            numbers = [*pair.data, self.angle, *law]
            lowering.add(PRISMATIC_FRICTION, index, numbers, pair.integers, f"{self.name}.friction")
