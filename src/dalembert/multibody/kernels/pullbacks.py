"""Gradients of (adjoint) . (residual) by what a model's residuals are made of: numbers of components, and signals.

The adjoint method needs for each step the row vector mu^T dr/da, with mu the adjoint of the step and a the numbers of
the model (`docs/theory/adjoint.md`). Each component depends only on a few numbers. So one complex-step residual of the
component gives the derivative along one number, whatever the number of parameters.
"""

import numpy as np

from dalembert.kernels.kernel import BlockKernel, inner
from dalembert.kernels.views import (
    complexes,
    complexes2,
    integers,
    integers2,
    local,
    reals,
    reals2,
    record,
    records,
    stack,
)
from dalembert.multibody.kernels.declaration import Declaration
from dalembert.multibody.kernels.elementary import STEP
from dalembert.multibody.kernels.loops import made
from dalembert.multibody.kernels.records import Inputs, block_at, call_at, model_at
from dalembert.multibody.kernels.signal_values import HELD, PIECEWISE, TABLE_HEAD, evaluate_one, segment


def _record(names: str) -> np.dtype:
    return np.dtype([(name, "i8") for name in names.split()])


#: What a block's kernel differentiates by: ``columns`` (column_count, 2), component and column of each number, with its
#: ``gradient``; ``reads`` (read_count, 2), component and signal, and the adjoints ``bars`` of all signals (signals, 3).
PULL = _record("columns column_count gradient reads read_count bars")
#: What the signals' kernel differentiates by: ``signals``, numbers of signals, and the ``gradient`` of all their data.
SIGNAL_PULL = _record("model signals signal_count gradient bars")

pull_at, signal_pull_at = record(PULL), record(SIGNAL_PULL)


def pullback(kind: Declaration, dtype: type) -> BlockKernel:
    """Take mu^T dr/d(number) off the gradient of each number, and mu^T dr/d(signal) off the signals' adjoints.

    The call has the adjoint mu (N + 1,) at ``r``, the state in real numbers, the signals in complex ones, and the
    record of what to differentiate by at ``slots``. The model's numbers are changed and restored.
    """
    function, width, columns = kind.residual_function, kind.width, max(1, len(kind.numbers))
    numbers, whole = records(kind.number_record(complex)), records(kind.integer_record)
    local_x, local_v, local_a, local_r = (local(complex, width) for _ in range(4))

    def loop(call_address, block_address):
        call, block = call_at(call_address), block_at(block_address)
        own, count, size = pull_at(call.slots), block.count, call.last + 1
        index = integers2(block.index, count, width)
        p, m = numbers(block.numbers, count), whole(block.integers, count)
        entries, signals = complexes2(block.numbers, count, columns), complexes2(call.signals, call.signal_count, 3)
        inputs = Inputs(signals, integers(call.callbacks, call.callback_count))
        x, v, a, adjoint = reals(call.x, size), reals(call.v, size), reals(call.a, size), reals(call.r, size)
        places, gradient = integers2(own.columns, own.column_count, 2), reals(own.gradient, own.column_count)
        reads, bars = integers2(own.reads, own.read_count, 2), reals2(own.bars, call.signal_count, 3)
        own_x, own_v, own_a, own_r = local_x(), local_v(), local_a(), local_r()
        before = -1
        for k in range(own.column_count + 3 * own.read_count):
            of_number, other = k < own.column_count, k - own.column_count
            read, rate = other // 3, other % 3
            e = places[k, 0] if of_number else reads[read, 0]
            # Neighbouring numbers mostly belong to one component, whose state is loaded once.
            if e != before:
                for i in range(width):
                    g = index[e, i]
                    own_x[i], own_v[i], own_a[i] = x[g], v[g], a[g]
                before = e
            if of_number:
                entries[e, places[k, 1]] += 1j * STEP
            else:
                signals[reads[read, 1], rate] += 1j * STEP
            for i in range(width):
                own_r[i] = 0.0
            function(own_x, own_v, own_a, p[e], m[e], inputs, own_r)
            total = 0.0
            for i in range(width):
                # mu^T dr/da by one complex residual: the gradient costs one residual a number, whatever the number of
                # parameters.
                total += adjoint[index[e, i]] * (own_r[i].imag / STEP)
            if of_number:
                # The step is exact to take back: real parts are never touched.
                entries[e, places[k, 1]] -= 1j * STEP
                gradient[k] -= total
            else:
                signals[reads[read, 1], rate] -= 1j * STEP
                bars[reads[read, 1], rate] -= total

    return made(loop, kind, "pullback", dtype)


@inner
def _differentiate(index, entry, data, knots, callbacks, t, within, bars, gradient):
    """Add the adjoint of one signal, times its derivative by one of its numbers, to the gradient."""
    out = stack(data, 3)
    data[entry] += 1j * STEP
    evaluate_one(index[0], index[1], index[2], index[3], data, knots, callbacks, t, within, out)
    data[entry] -= 1j * STEP
    for rate in range(3):
        gradient[entry] += bars[rate] * (out[rate].imag / STEP)


def _pull_signals(work, given):
    """Add the adjoints of signals, times their derivatives by their numbers, to the gradient of all numbers.

    Of a table only the piece that holds the time matters. The call has the time.
    """
    call, own = call_at(work), signal_pull_at(given)
    table = model_at(own.model)
    index = integers2(table.signal_index, table.signal_count, 4)
    data, knots = complexes(table.signal_data, table.number_count), reals(table.knots, table.knot_count)
    callbacks, chosen = integers(table.callbacks, table.callback_count), integers(own.signals, own.signal_count)
    bars, gradient = reals2(own.bars, table.signal_count, 3), reals(own.gradient, table.number_count)
    # Signals count from their own zero, calls from the start of the motion.
    t, within = call.t + data[0].real, call.within + data[0].real
    for k in range(own.signal_count):
        s = chosen[k]
        kind, first, count, knot = index[s, 0], index[s, 1], index[s, 2], index[s, 3]
        # No component has read this signal at this state.
        if bars[s, 0] == 0.0 and bars[s, 1] == 0.0 and bars[s, 2] == 0.0:
            continue
        begin, end = first, first + count
        if kind == PIECEWISE or kind == HELD:
            order = int(data[first + 4].real) if kind == PIECEWISE else 1
            parts = (count - TABLE_HEAD) // order
            since = (t if kind == PIECEWISE else within) - data[first + 2].real
            part = segment(knots, knot, parts, since)
            near = 0 if kind == PIECEWISE else 1  # at a change of a held table the other side counts, too
            begin = first + TABLE_HEAD + order * max(0, part - near)
            end = min(end, first + TABLE_HEAD + order * (part + near + 1))
            for entry in range(first, first + 3):  # scale, offset and delay
                _differentiate(index[s], entry, data, knots, callbacks, t, within, bars[s], gradient)
        for entry in range(begin, end):
            _differentiate(index[s], entry, data, knots, callbacks, t, within, bars[s], gradient)


PULL_SIGNALS = BlockKernel(_pull_signals, "dal_signals_pullback")
