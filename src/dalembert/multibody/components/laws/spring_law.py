"""Springs with dampers: tension = (stiffness + cubic e^2) e + damping de/dt, e the elongation (or the twist)."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.base_load import BaseLoad
from dalembert.multibody.components.fields import Number, number
from dalembert.multibody.kernels.kind import Kind

NUMBERS = ("rest", "stiffness", "damping", "cubic")


@inlined
def tension(elongation, rate, p):
    """Force (or torque) with which the spring pulls its ends together."""
    square = elongation * elongation  # not by **: the complex power loses the imaginary step of a negative number
    return (p.stiffness + p.cubic * square) * elongation + p.damping * rate


def law_functions(stretch: Callable[..., Any]) -> tuple[Callable[..., Any], Callable[..., Any]]:
    """Energy and outputs of a spring, from ``stretch(x, v, p, m)``, which returns elongation and rate."""
    elongation_and_rate: Any = stretch

    @inlined
    def energy(x, v, p, m, inputs):
        """No kinetic energy; energy stored; power of the damper."""
        elongation, rate = elongation_and_rate(x, v, p, m)
        square = elongation * elongation
        stored = (0.5 * p.stiffness + 0.25 * p.cubic * square) * square
        return 0.0 * stored, stored, -p.damping * rate * rate

    @inlined
    def observe(x, v, a, p, m, inputs, out):
        elongation, rate = elongation_and_rate(x, v, p, m)
        out[0], out[1] = elongation, tension(elongation, rate, p)

    return energy, observe


@inlined
def _counted_stretch(x, v, p, m):
    """Counted angle less the free one, and its rate."""
    return x[0] - p.rest, v[0]


@inlined
def _counted_residual(x, v, a, p, m, inputs, r):
    twisted, rate = _counted_stretch(x, v, p, m)
    r[0] += tension(twisted, rate, p)


def counted_spring(name: str, home: str, outputs: tuple[tuple[str, str], ...]) -> Kind:
    """Kind of a torsional spring on a counted angle, which is its coordinate; ``home``: module that holds it."""
    energy, observe = law_functions(_counted_stretch)
    return Kind(
        name, coordinates=1, numbers=NUMBERS, residual=_counted_residual, energy=energy, outputs=outputs,
        observe=observe, dissipates="damping", home=home,
    )  # fmt: skip


@dataclass(frozen=True)
class LineSpring(BaseLoad):
    """Fields and row of a spring along the connection of two points.

    Parameters
    ----------
    stiffness : float
        N/m.
    damping : float
        N s/m.
    free_length : float, optional
        m; the initial distance of the points if not given.
    cubic : float
        N/m^3.
    """

    a: Any
    b: Any
    stiffness: Number = number("N/m")
    damping: Number = number("N*s/m", 0.0)
    free_length: Number | None = number("m", None, least=0)
    cubic: Number = number("N/m**3", 0.0)

    def lower(self, lowering: Any) -> None:
        pair = lowering.pair(self.a, self.b, self.name)
        free = pair.distance if self.free_length is None else self.free_length
        numbers = [*pair.data, free, self.stiffness, self.damping, self.cubic]
        lowering.add(self.kind, pair.slots, numbers, pair.integers, self.name)


@dataclass(frozen=True)
class TwistSpring(BaseLoad):
    """Fields of a torsional spring.

    Parameters
    ----------
    stiffness : float
        N m/rad.
    damping : float
        N m s/rad.
    free_angle : float, optional
        Angle of b relative to a without torque, rad; the initial one if not given.
    cubic : float
        N m/rad^3.
    """

    a: Any
    b: Any
    stiffness: Number = number("N*m/rad")
    damping: Number = number("N*m*s/rad", 0.0)
    free_angle: Number | None = number("rad", None)
    cubic: Number = number("N*m/rad**3", 0.0)
