"""Functions of time: the value, rate and second rate of every signal of a model at one time.

Each signal has a row of `index`: kind, first entry and number of entries in `data`, first entry in `knots`.
Signal 0 is the time itself.
"""

import numpy as np

from dalembert.multibody.kernels.callback import call
from dalembert.multibody.kernels.compiled import compiled, kernel
from dalembert.multibody.kernels.dual import sin_cos

TIME, CONSTANT, STEP, HARMONIC, POLYNOMIAL, PIECEWISE, CUSTOM = range(7)


@kernel
def _polynomial(data, first, count, t):
    """Value and two derivatives of data[first] + data[first + 1] t + ..."""
    value, rate, second = 0.0 * data[first], 0.0 * data[first], 0.0 * data[first]
    for i in range(count - 1, -1, -1):
        second = second * t + 2.0 * rate
        rate = rate * t + value
        value = value * t + data[first + i]
    return value, rate, second


@kernel
def _segment(knots, first, count, t):
    """Number of the interval of `count` + 1 knots that holds t; the last one beyond the end."""
    low, high = 0, count - 1
    while low < high:
        middle = (low + high + 1) // 2
        if knots[first + middle] <= t:
            low = middle
        else:
            high = middle - 1
    return low


@compiled
def evaluate(index, data, knots, callbacks, t, within, out):
    """Fill ``out`` (signals, 3) with values, rates and second rates at time ``t``.

    ``within`` is a time strictly inside the present smooth stretch of motion; it decides on which side of a jump the
    time ``t`` lies when the two coincide.
    """
    for n in range(len(index)):
        kind, first, count = index[n, 0], index[n, 1], index[n, 2]
        out[n, 0], out[n, 1], out[n, 2] = 0.0, 0.0, 0.0
        if kind == TIME:
            out[n, 0], out[n, 1] = t, 1.0
        elif kind == CONSTANT:
            out[n, 0] = data[first]
        elif kind == STEP:
            if knots[index[n, 3]] <= within < knots[index[n, 3] + 1]:
                out[n, 0] = data[first]
        elif kind == HARMONIC:
            omega = data[first + 1]
            s, c = sin_cos(omega * t + data[first + 2])
            out[n, 0] = data[first] * s + data[first + 3]
            out[n, 1] = data[first] * omega * c
            out[n, 2] = -data[first] * omega * omega * s
        elif kind == POLYNOMIAL:
            out[n, 0], out[n, 1], out[n, 2] = _polynomial(data, first, count, t)
        elif kind == PIECEWISE:
            knot = index[n, 3]
            low, high = knots[knot], knots[knot + count // 4]
            if low <= t <= high:
                part = _segment(knots, knot, count // 4, t)
                out[n, 0], out[n, 1], out[n, 2] = _polynomial(data, first + 4 * part, 4, t - knots[knot + part])
            else:  # held beyond the ends
                part = 0 if t < low else count // 4 - 1
                at = 0.0 if t < low else high - knots[knot + part]
                out[n, 0] = _polynomial(data, first + 4 * part, 4, at)[0]
        elif kind == CUSTOM:
            given, answer = np.zeros(1, data.dtype), np.zeros(3, data.dtype)
            given[0] = t
            call(callbacks[first], given, answer)
            out[n, 0], out[n, 1], out[n, 2] = answer[0], answer[1], answer[2]
