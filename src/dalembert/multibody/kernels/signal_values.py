"""Functions of time: the value, rate and second rate of every signal of a model at one time.

Each signal has a row of `index`: kind, first entry and number of entries in `data`, first entry in `knots`.
Signal 0 is the time itself. The first entry of `data` is the time of the signals at which the motion begins.
"""

from dalembert.kernels.arithmetic import VIEWS
from dalembert.kernels.duals import Dual
from dalembert.kernels.kernel import BlockKernel, inner
from dalembert.kernels.views import call_with, integers, integers2, reals, stack
from dalembert.multibody.kernels.elementary import sin_cos
from dalembert.multibody.kernels.records import call_at, model_at

TIME, CONSTANT, STEP, HARMONIC, POLYNOMIAL, PIECEWISE, HELD, CUSTOM = range(8)

#: Numbers of a table before those of its pieces: scale, offset, delay, integrals, coefficients of a piece.
TABLE_HEAD = 5
_AT_CHANGE = 1e-6  # of the interval between two times of a held table: how near to one of them is at it


@inner
def _polynomial(data, first, count, t):
    """Value and two derivatives of data[first] + data[first + 1] t + ..."""
    # Zeros of the data's arithmetic. Horner's scheme carries the derivatives along: (second, rate, value) in this
    # order, as each needs the one below before it changes.
    value, rate, second = 0.0 * data[first], 0.0 * data[first], 0.0 * data[first]
    for i in range(count - 1, -1, -1):
        second = second * t + 2.0 * rate
        rate = rate * t + value
        value = value * t + data[first + i]
    return value, rate, second


@inner
def segment(knots, first, count, t):
    """Number of the interval of `count` + 1 knots that holds t; the last one beyond the end."""
    low, high = 0, count - 1
    # Bisection: a table of a measured input has many thousands of knots.
    while low < high:
        middle = (low + high + 1) // 2
        if knots[first + middle] <= t:
            low = middle
        else:
            high = middle - 1
    return low


@inner
def _table(first, count, knot, data, knots, t, out):
    """Value, rate and second rate of scaled and delayed polynomials between knots, held beyond their ends."""
    scale, offset, since = data[first], data[first + 1], t - data[first + 2]
    integrals, order = int(data[first + 3].real), int(data[first + 4].real)
    parts = (count - TABLE_HEAD) // order
    low, high = knots[knot], knots[knot + parts]
    # Comparisons are of real parts: a delay may be complex, the piece that it falls on may not depend on it.
    inside = low <= since.real <= high
    if not inside:
        since = 0.0 * since + (low if since.real < low else high)
    part = segment(knots, knot, parts, since.real)
    piece = first + TABLE_HEAD + order * part
    value, rate, second = _polynomial(data, piece, order, since - knots[knot + part])
    value, rate, second = scale * value, scale * rate, scale * second
    # The offset acts under the integrals too: as a ramp of the first one, as a parabola of the second.
    lasted = since - low
    if integrals == 0:
        value += offset
    elif integrals == 1:
        value, rate = value + offset * lasted, rate + offset
    else:
        value, rate, second = value + 0.5 * offset * lasted * lasted, rate + offset * lasted, second + offset
    out[0] = value
    if inside:
        out[1], out[2] = rate, second


@inner
def evaluate_one(kind, first, count, knot, data, knots, callbacks, t, within, out):
    """Value, rate and second rate of one signal, into ``out`` (3,)."""
    out[0], out[1], out[2] = 0.0, 0.0, 0.0
    if kind == TIME:
        out[0], out[1] = t, 1.0
    elif kind == CONSTANT:
        out[0] = data[first]
    elif kind == STEP:
        if knots[knot] <= within < knots[knot + 1]:
            out[0] = data[first]
    elif kind == HARMONIC:
        omega = data[first + 1]
        s, c = sin_cos(omega * t + data[first + 2])
        out[0] = data[first] * s + data[first + 3]
        out[1] = data[first] * omega * c
        out[2] = -data[first] * omega * omega * s
    elif kind == POLYNOMIAL:
        out[0], out[1], out[2] = _polynomial(data, first, count, t)
    elif kind == PIECEWISE:
        _table(first, count, knot, data, knots, t, out)
    elif kind == HELD:
        since = within - data[first + 2].real
        part = segment(knots, knot, count - TABLE_HEAD, since)
        value = data[first + TABLE_HEAD + part]
        for side in range(-1, 2, 2):  # the mean of both sides, where the method means a change itself
            other = part + side
            if 0 <= other < count - TABLE_HEAD:
                edge, width = knots[knot + max(part, other)], abs(knots[knot + part] - knots[knot + other])
                if abs(since - edge) <= _AT_CHANGE * width:
                    value = 0.5 * (value + data[first + TABLE_HEAD + other])
        out[0] = data[first] * value + data[first + 1]
    elif kind == CUSTOM:
        given, answer = stack(data, 1), stack(data, 3)
        given[0] = t
        call_with(callbacks[first], given, answer)
        out[0], out[1], out[2] = answer[0], answer[1], answer[2]


def _kernel(dtype: type) -> BlockKernel:
    view, view2 = VIEWS[dtype]

    def evaluate(work, model):
        """Fill the signals of a call at its time. ``within`` is a time strictly inside the present smooth stretch of
        motion; it decides on which side of a jump the time ``t`` lies when the two coincide. Where it is the time of a
        change of a held table, the value is the mean of both sides.
        """
        own, table = call_at(work), model_at(model)
        index, out = integers2(table.signal_index, table.signal_count, 4), view2(own.signals, table.signal_count, 3)
        data, knots = view(table.signal_data, table.number_count), reals(table.knots, table.knot_count)
        callbacks = integers(table.callbacks, table.callback_count)
        t, within = own.t + data[0].real, own.within + data[0].real
        for n in range(table.signal_count):
            evaluate_one(index[n, 0], index[n, 1], index[n, 2], index[n, 3], data, knots, callbacks, t, within, out[n])

    return BlockKernel(evaluate, f"dal_signals_{dtype.__name__.lower()}", dtype=dtype)


def _time_kernel(dtype: type) -> BlockKernel:
    view, view2 = VIEWS[dtype]

    def evaluate(work, model):
        """Fill the time. It compiles in a small part of the time of all signals, and is all that many models need."""
        own, table = call_at(work), model_at(model)
        out, data = view2(own.signals, 1, 3), view(table.signal_data, 1)
        out[0, 0], out[0, 1], out[0, 2] = own.t + data[0].real, 1.0, 0.0

    return BlockKernel(evaluate, f"dal_time_{dtype.__name__.lower()}", dtype=dtype)


EVALUATE_REAL, EVALUATE_COMPLEX, EVALUATE_DUAL = map(_kernel, (float, complex, Dual))
TIME_REAL, TIME_COMPLEX, TIME_DUAL = map(_time_kernel, (float, complex, Dual))
EVALUATORS = (
    {float: TIME_REAL, complex: TIME_COMPLEX, Dual: TIME_DUAL},
    {float: EVALUATE_REAL, complex: EVALUATE_COMPLEX, Dual: EVALUATE_DUAL},
)
"""Kernels that fill the signals of a model, of the time alone and of more than one signal, by their arithmetic."""
