"""Torsional springs with dampers."""

__all__ = ["TorsionSpring"]

from dataclasses import dataclass

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.fields import Number, number
from dalembert.multibody.components.lowering import Lowering
from dalembert.multibody.components.planar.load import Load
from dalembert.multibody.components.planar.pairs import relative_angle, relative_spin, twist_pair
from dalembert.multibody.components.planar.spring_law import spring_kind
from dalembert.multibody.components.points import Side, require_direction
from dalembert.multibody.components.spring_law import tension
from dalembert.multibody.kernels.elementary import wrapped


@inlined
def _stretch(x, v, p, m):
    """Twist and its rate."""
    angle = relative_angle(x, p, m) - p.rest
    return wrapped(angle) if m.wraps == 1 else angle, relative_spin(x, v, m)


@inlined
def _residual(x, v, a, p, m, inputs, r):
    """Torque on both sides."""
    twisted, rate = _stretch(x, v, p, m)
    twist_pair(x, m, tension(twisted, rate, p), r)


TORSION_SPRING = spring_kind("torsion_spring", _stretch, _residual)


@dataclass(frozen=True)
class TorsionSpring(Load):
    """A torsional spring with damper between the directions of two points.

    Parameters
    ----------
    name : str
    a, b : Point or ground
    stiffness : float
        N m/rad.
    damping : float
        N m s/rad.
    free_angle : float, optional
        Of b against a, rad; the first one if not given.
    cubic : float
        N m/rad^3.
    """

    a: Side
    b: Side
    stiffness: Number = number("N*m/rad")
    damping: Number = number("N*m*s/rad", 0.0)
    free_angle: Number | None = number("rad", None)
    cubic: Number = number("N*m/rad**3", 0.0)

    kind = TORSION_SPRING

    def lower(self, lowering: Lowering) -> None:
        require_direction(f"torsion spring {self.name!r}", "a spring, or a rigid body", self.a, self.b)
        pair = lowering.pair(self.a, self.b, self.name)
        free = pair.rest_angle if self.free_angle is None else self.free_angle
        numbers = [*pair.data, free, self.stiffness, self.damping, self.cubic]
        lowering.add(TORSION_SPRING, pair.slots, numbers, pair.integers, self.name)
