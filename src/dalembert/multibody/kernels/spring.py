"""Springs with dampers between two markers, along their connection or in torsion.

Local coordinates: marker a (slots 0-3), b (4-7). Data: (sx, sy, phi) of a and of b, free length or angle, [unused],
stiffness, damping, cubic stiffness. Meta: kind, marker kinds of a and b, [unused], 1 where an angle must be wrapped.
"""

from dalembert.multibody.kernels import joints
from dalembert.multibody.kernels.compiled import inlined, kernel
from dalembert.multibody.kernels.dual import root, wrapped

WIDTH = 8
TRANSLATION, TORSION = range(2)
_TINY = 1e-30  # keeps the direction of a spring of no length defined, m^2


@inlined
def stretch(x, v, data, meta, e):
    """Elongation (or twist) and its rate."""
    if meta[e, 0] == TORSION:
        twist = joints.relative_angle(x, data, meta, e) - data[e, 6]
        if meta[e, 4] == 1:
            twist = wrapped(twist)
        return twist, joints.relative_spin(x, v, meta, e)
    dx, dy = joints.separation(x, data, meta, e)
    ux, uy = joints.separation_rate(x, v, data, meta, e)
    length = root(dx * dx + dy * dy + _TINY)
    return length - data[e, 6], (dx * ux + dy * uy) / length


@inlined
def tension(x, v, data, meta, e):
    """Force (or torque) with which the spring pulls its ends together."""
    elongation, rate = stretch(x, v, data, meta, e)
    square = elongation * elongation  # not by **: the complex power loses the imaginary step of a negative number
    return (data[e, 8] + data[e, 10] * square) * elongation + data[e, 9] * rate


@inlined
def residual(x, v, a, signals, callbacks, data, meta, e, r):
    """Tension on both ends."""
    for i in range(WIDTH):
        r[i] = 0.0
    force = tension(x, v, data, meta, e)
    if meta[e, 0] == TORSION:
        joints.twist_pair(x, meta, e, force, r)
    else:
        dx, dy = joints.separation(x, data, meta, e)
        per_length = force / root(dx * dx + dy * dy + _TINY)
        joints.push_pair(x, data, meta, e, per_length * dx, per_length * dy, r)


@kernel
def energy(x, v, signals, callbacks, data, meta, e):
    """No kinetic energy; energy stored; power of the damper."""
    elongation, rate = stretch(x, v, data, meta, e)
    square = elongation * elongation
    stored = (0.5 * data[e, 8] + 0.25 * data[e, 10] * square) * square
    return 0.0 * stored, stored, -data[e, 9] * rate * rate
