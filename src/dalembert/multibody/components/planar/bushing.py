"""Bushings: elastic bearings with stiffness and damping in both directions and in torsion."""

__all__ = ["Bushing"]

from dataclasses import dataclass

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.fields import Number, number
from dalembert.multibody.components.lowering import Lowering
from dalembert.multibody.components.planar.load import Load
from dalembert.multibody.components.planar.markers import direction, spin, twist
from dalembert.multibody.components.planar.pairs import (
    pair_kind,
    push_pair,
    relative_angle,
    relative_spin,
    separation,
    separation_rate,
    twist_pair,
)
from dalembert.multibody.components.points import Side, require_direction
from dalembert.multibody.kernels.elementary import wrapped


@inlined
def _deflection(x, v, p, m):
    """Displacement of b against a and its rate, in the axes of a; twist and its rate."""
    c, s = direction(m.a_kind, 0, x, p.a_angle)
    dx, dy = separation(x, p, m)
    ux, uy = separation_rate(x, v, p, m)
    turn = spin(m.a_kind, 0, x, v)
    along, across = c * dx + s * dy, c * dy - s * dx
    angle = relative_angle(x, p, m) - p.rest_angle
    twisted = wrapped(angle) if m.wraps == 1 else angle
    along_rate, across_rate = c * ux + s * uy + turn * across, c * uy - s * ux - turn * along
    return along - p.rest_x, across - p.rest_y, along_rate, across_rate, twisted, relative_spin(x, v, m)


@inlined
def _loads(x, v, p, m):
    """Force on a along its axes, and torque on a."""
    along, across, along_rate, across_rate, angle, rate = _deflection(x, v, p, m)
    fx = p.stiffness_x * along + p.damping_x * along_rate
    fy = p.stiffness_y * across + p.damping_y * across_rate
    return fx, fy, p.stiffness_angle * angle + p.damping_angle * rate


@inlined
def _residual(x, v, a, p, m, inputs, r):
    """The force acts at b; on a it has a lever, the displacement."""
    fx, fy, torque = _loads(x, v, p, m)
    c, s = direction(m.a_kind, 0, x, p.a_angle)
    gx, gy = c * fx - s * fy, s * fx + c * fy
    dx, dy = separation(x, p, m)
    push_pair(x, p, m, gx, gy, r)
    twist(m.a_kind, 0, x, -(dx * gy - dy * gx), r)
    twist_pair(x, m, torque, r)


@inlined
def _energy(x, v, p, m, inputs):
    along, across, along_rate, across_rate, angle, rate = _deflection(x, v, p, m)
    stored = p.stiffness_x * along * along + p.stiffness_y * across * across + p.stiffness_angle * angle * angle
    lost = (
        p.damping_x * along_rate * along_rate + p.damping_y * across_rate * across_rate + p.damping_angle * rate * rate
    )
    return 0.0 * stored, 0.5 * stored, -lost


@inlined
def _observe(x, v, a, p, m, inputs, out):
    out[0], out[1], _, _, out[2], _ = _deflection(x, v, p, m)
    out[3], out[4], out[5] = _loads(x, v, p, m)


LAWS = ("stiffness_x", "stiffness_y", "stiffness_angle", "damping_x", "damping_y", "damping_angle")
BUSHING = pair_kind(
    "bushing", ("rest_x", "rest_y", "rest_angle", *LAWS),
    residual=_residual,
    energy=_energy,
    outputs=(("x", "m"), ("y", "m"), ("angle", "rad"), ("force_x", "N"), ("force_y", "N"), ("torque", "N*m")),
    observe=_observe,
    dissipates=LAWS[3:],
    holds=True,
)  # fmt: skip


@dataclass(frozen=True)
class Bushing(Load):
    """An elastic bearing between two points, without force as the bodies are placed.

    A spring with a damper acts along each axis of a, and a torsion spring with a damper between their angles:
    force = stiffness x displacement + damping x velocity, of b relative to a. The three are uncoupled. Both forces act
    at the place of b: a also takes their moment, with the lever from a to b.

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

    def lower(self, lowering: Lowering) -> None:
        require_direction(f"bushing {self.name!r}", "a spring, or a rigid body", self.a, self.b)
        pair = lowering.pair(self.a, self.b, self.name)
        numbers = [*pair.data, *pair.relative, pair.rest_angle, *(getattr(self, name) for name in LAWS)]
        lowering.add(BUSHING, pair.slots, numbers, pair.integers, self.name)
