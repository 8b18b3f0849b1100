"""Springs with dampers: tension = (stiffness + cubic e^2) e + damping de/dt, e the elongation (or the twist)."""

from collections.abc import Callable
from typing import Any

from dalembert.kernels.kernel import inlined

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
