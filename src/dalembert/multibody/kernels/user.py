"""Forces that a function of the user's gives from the state of one or two markers.

Local coordinates: marker a that is loaded (slots 0-3) and marker b that reacts (4-7). Data: (sx, sy, phi) of a and b.
Meta: [unused], marker kinds of a and b, number of the callback.

The callback is given time and, for a and for b, position, velocity, angle and angular velocity (13 numbers); it answers
force (fx, fy) and torque on a.
"""

import numpy as np

from dalembert.multibody.kernels.callback import call
from dalembert.multibody.kernels.compiled import compiled
from dalembert.multibody.kernels.markers import angle, position, push, spin, twist, velocity

WIDTH = 8
GIVEN, ANSWER = 13, 3
_TIME = 0  # signal that holds the time


@compiled
def _ask(x, v, signals, callbacks, data, meta, e) -> tuple[np.ndarray, np.ndarray]:
    given, answer = np.zeros(GIVEN, x.dtype), np.zeros(ANSWER, x.dtype)
    given[0] = signals[_TIME, 0]
    for side in range(2):
        kind, k, row, out = meta[e, 1 + side], 4 * side, 3 * side, 1 + 6 * side
        sx, sy = data[e, row], data[e, row + 1]
        given[out], given[out + 1] = position(kind, k, x, sx, sy)
        given[out + 2], given[out + 3] = velocity(kind, k, x, v, sx, sy)
        given[out + 4] = angle(kind, k, x, data[e, row + 2])
        given[out + 5] = spin(kind, k, x, v)
    call(callbacks[meta[e, 3]], given, answer)
    return given, answer


@compiled
def residual(x, v, a, signals, callbacks, data, meta, e, r):
    """The force with its sign turned on a, as it is on b."""
    for i in range(WIDTH):
        r[i] = 0.0
    _, answer = _ask(x, v, signals, callbacks, data, meta, e)
    for side in range(2):
        kind, k, row, sign = meta[e, 1 + side], 4 * side, 3 * side, 2 * side - 1
        push(kind, k, x, data[e, row], data[e, row + 1], sign * answer[0], sign * answer[1], r)
        twist(kind, k, x, sign * answer[2], r)


@compiled
def energy(x, v, signals, callbacks, data, meta, e):
    """No energy; the power of the force on both markers."""
    given, answer = _ask(x, v, signals, callbacks, data, meta, e)
    zero = 0.0 * given[0]
    power = answer[0] * (given[3] - given[9]) + answer[1] * (given[4] - given[10]) + answer[2] * (given[6] - given[12])
    return zero, zero, power
