"""The spring with damper in space, along the connection of two points."""

__all__ = ["Spring"]

from dataclasses import dataclass

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.fields import parameters_of
from dalembert.multibody.components.laws.spring_law import NUMBERS, LineSpring, law_functions, tension
from dalembert.multibody.components.spatial.ground_points import Side
from dalembert.multibody.components.spatial.kinds import pair_kind
from dalembert.multibody.components.spatial.spatial_load import Load
from dalembert.multibody.components.spatial.spatial_pairs import push_pair, separation, separation_rate
from dalembert.multibody.components.spatial.vectors import dot, times
from dalembert.multibody.kernels.elementary import reciprocal, root

_TINY = 1e-30  # keeps the direction of a spring of no length defined, m^2


@inlined
def _elongation(x, v, p, m):
    """Elongation and its rate."""
    delta = separation(x, p, m)
    length = root(dot(delta, delta) + _TINY)
    return length - p.rest, dot(delta, separation_rate(v, p, m)) * reciprocal(length)


@inlined
def _residual(x, v, a, p, m, inputs, r):
    """Tension on both ends."""
    elongation, rate = _elongation(x, v, p, m)
    delta = separation(x, p, m)
    push_pair(p, m, times(tension(elongation, rate, p) * reciprocal(root(dot(delta, delta) + _TINY)), delta), r)


_energy, _observe = law_functions(_elongation)
SPRING = pair_kind(
    "spring_in_space", __name__, NUMBERS, residual=_residual, energy=_energy,
    outputs=(("elongation", "m"), ("force", "N")), observe=_observe, dissipates="damping", holds=True,
    holds_frame=False,
)  # fmt: skip


@parameters_of(LineSpring)
@dataclass(frozen=True)
class Spring(LineSpring, Load):
    """A spring with damper along the connection of two points.

    Tension = stiffness x elongation + cubic x elongation^3 + damping x rate of elongation.

    Parameters
    ----------
    name : str
    a, b : Point or ground
    {law}
    """

    a: Side
    b: Side

    kind = SPRING
