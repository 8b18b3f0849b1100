"""Springs with dampers along the connection of two points."""

__all__ = ["Spring"]

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.fields import parameters_of
from dalembert.multibody.components.laws.spring_law import NUMBERS, LineSpring, law_functions, tension
from dalembert.multibody.components.planar.load import Load
from dalembert.multibody.components.planar.pairs import pair_kind, push_pair, separation, separation_rate
from dalembert.multibody.components.points import Side
from dalembert.multibody.kernels.elementary import root
from dalembert.multibody.kernels.kind import Kind

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


def spring_kind(name: str, stretch: Callable[..., Any], residual: Callable[..., Any], **properties: Any) -> Kind:
    """Kind of a spring, from ``stretch(x, v, p, m)``, which returns elongation and rate, and its residual."""
    energy, observe = law_functions(stretch)
    law: dict[str, Any] = {"residual": residual, "energy": energy, "observe": observe}
    common: dict[str, Any] = {
        "outputs": (("elongation", "m"), ("force", "N")),
        "dissipates": "damping",
        "holds": True,
        "lanes": True,
    }
    return pair_kind(name, NUMBERS, **common | law | properties)


SPRING = spring_kind("spring", _stretch, _residual, holds_frame=False)


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
