"""The law of springs with dampers: tension = (stiffness + cubic e^2) e + damping de/dt, e the elongation."""

from dalembert.kernels.kernel import inlined

NUMBERS = ("rest", "stiffness", "damping", "cubic")


@inlined
def tension(elongation, rate, p):
    """Force (or torque) with which the spring pulls its ends together."""
    square = elongation * elongation  # not by **: the complex power loses the imaginary step of a negative number
    return (p.stiffness + p.cubic * square) * elongation + p.damping * rate


@inlined
def energy(elongation, rate, p):
    """No kinetic energy; energy stored; power of the damper."""
    square = elongation * elongation
    stored = (0.5 * p.stiffness + 0.25 * p.cubic * square) * square
    return 0.0 * stored, stored, -p.damping * rate * rate
