"""Springs with dampers along the connection of two points."""

__all__ = ["Spring"]

from dataclasses import dataclass

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.fields import Number, number
from dalembert.multibody.components.laws.spring_law import tension
from dalembert.multibody.components.planar.load import Load
from dalembert.multibody.components.planar.pairs import push_pair, separation, separation_rate
from dalembert.multibody.components.planar.spring_law import spring_kind
from dalembert.multibody.components.points import Side
from dalembert.multibody.components.rows import Lowering
from dalembert.multibody.kernels.elementary import root

_TINY = 1e-30  # keeps the direction of a spring of no length defined, m^2


@inlined
def _stretch(x, v, p, m):
    """Elongation and its rate."""
    dx, dy = separation(x, p, m)
    ux, uy = separation_rate(x, v, p, m)
    length = root(dx * dx + dy * dy + _TINY)
    return length - p.rest, (dx * ux + dy * uy) / length


@inlined
def _residual(x, v, a, p, m, inputs, r):
    """Tension on both ends."""
    elongation, rate = _stretch(x, v, p, m)
    force = tension(elongation, rate, p)
    dx, dy = separation(x, p, m)
    per_length = force / root(dx * dx + dy * dy + _TINY)
    push_pair(x, p, m, per_length * dx, per_length * dy, r)


SPRING = spring_kind("spring", _stretch, _residual, holds_frame=False)


@dataclass(frozen=True)
class Spring(Load):
    """A spring with damper along the connection of two points.

    Tension = stiffness x elongation + cubic x elongation^3 + damping x rate of elongation.

    Parameters
    ----------
    name : str
    a, b : Point or ground
    stiffness : float
        N/m.
    damping : float
        N s/m.
    free_length : float, optional
        m; the first distance of the points if not given.
    cubic : float
        N/m^3.
    """

    a: Side
    b: Side
    stiffness: Number = number("N/m")
    damping: Number = number("N*s/m", 0.0)
    free_length: Number | None = number("m", None, least=0)
    cubic: Number = number("N/m**3", 0.0)

    kind = SPRING

    def lower(self, lowering: Lowering) -> None:
        pair = lowering.pair(self.a, self.b, self.name)
        free = pair.distance if self.free_length is None else self.free_length
        numbers = [*pair.data, free, self.stiffness, self.damping, self.cubic]
        lowering.add(SPRING, pair.slots, numbers, pair.integers, self.name)
