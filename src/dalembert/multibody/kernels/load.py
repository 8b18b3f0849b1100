"""Forces and torques given as functions of time.

Local coordinates: marker a that is loaded (slots 0-3) and, for a torque between two bodies, marker b that reacts (4-7).
Data: (sx, sy, phi) of a and of b. Meta: kind, marker kinds of a and b, signal of x or of the torque, signal of y.
"""

from dalembert.multibody.kernels.compiled import inlined, kernel
from dalembert.multibody.kernels.markers import direction, push, spin, twist, velocity

WIDTH = 8
FORCE, FOLLOWER, TORQUE = range(3)


@inlined
def _force(x, signals, data, meta, e):
    """Force in the fixed axes."""
    fx, fy = signals[meta[e, 3], 0], signals[meta[e, 4], 0]
    if meta[e, 0] == FOLLOWER:
        c, s = direction(meta[e, 1], 0, x, data[e, 2])
        return c * fx - s * fy, s * fx + c * fy
    return fx, fy


@inlined
def residual(x, v, a, signals, callbacks, data, meta, e, r):
    """The load with its sign turned: it stands on the left."""
    for i in range(WIDTH):
        r[i] = 0.0
    if meta[e, 0] == TORQUE:
        torque = signals[meta[e, 3], 0]
        twist(meta[e, 1], 0, x, -torque, r)
        twist(meta[e, 2], 4, x, torque, r)
    else:
        fx, fy = _force(x, signals, data, meta, e)
        push(meta[e, 1], 0, x, data[e, 0], data[e, 1], -fx, -fy, r)


@kernel
def energy(x, v, signals, callbacks, data, meta, e):
    """No energy; the power of the load."""
    zero = 0.0 * data[e, 0]
    if meta[e, 0] == TORQUE:
        return zero, zero, signals[meta[e, 3], 0] * (spin(meta[e, 1], 0, x, v) - spin(meta[e, 2], 4, x, v))
    fx, fy = _force(x, signals, data, meta, e)
    ux, uy = velocity(meta[e, 1], 0, x, v, data[e, 0], data[e, 1])
    return zero, zero, fx * ux + fy * uy
