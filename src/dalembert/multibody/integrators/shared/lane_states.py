"""What samples side by side share: states and factors of one lane among eight, and the signals of each."""

from typing import NamedTuple

import numpy as np

from dalembert.kernels.kernel import inlined, inner
from dalembert.kernels.lanes import WIDTH, lane_vector, lane_zeros, larger, sizes
from dalembert.kernels.words import Address, Integers, Reals2
from dalembert.multibody.integrators.shared.consistent import accelerate
from dalembert.multibody.integrators.shared.matrices import Pattern
from dalembert.multibody.integrators.shared.problem import SampleModels
from dalembert.multibody.kernels.assembly import set_signals
from dalembert.multibody.kernels.linear import BAND, Layout
from dalembert.multibody.kernels.states import MotionState
from dalembert.multibody.model.turns import STEP_END, count_turns


class LaneSignals(NamedTuple):
    """Where the signals of lanes come from: ``models`` (8,) in real numbers, a call of one of them, and its signals
    (signals, 3).
    """

    models: Integers
    call: Address
    signals: Reals2


class LaneFactors(NamedTuple):
    """Factorised matrices (entries, 8), dense ones by rows; ``pivots``, ``tops`` (N,): of all lanes; ``is_set`` (1,):
    whether they are known.
    """

    matrix: Reals2
    pivots: Integers
    tops: Integers
    is_set: Integers


class LaneMasses(NamedTuple):
    """What products with the masses of eight samples need: a pattern, its entries with masses, and these."""

    pattern: Pattern
    heavy: Integers
    mass: Reals2


def lane_factors(layout: Layout) -> LaneFactors:
    """Room for the factors of eight samples."""
    pivots, tops = np.zeros((2, layout.size), np.int64)
    return LaneFactors(lane_zeros(layout.lead * layout.size), pivots, tops, np.zeros(1, np.int64))


@inlined
def lane_state(stack):
    """The states of all lanes in ``stack`` (4, N + 1, 8), as one state of lanes."""
    return MotionState(lane_vector(stack[0]), lane_vector(stack[1]), lane_vector(stack[2]), lane_vector(stack[3]))


@inner
def take_lane(stack, lane, state):
    """Fill a state with that of a lane of ``stack`` (4, N + 1, 8)."""
    for i in range(stack.shape[1]):
        state.x[i], state.v[i], state.a[i], state.w[i] = (
            stack[0, i, lane],
            stack[1, i, lane],
            stack[2, i, lane],
            stack[3, i, lane],
        )


@inner
def put_lane(state, lane, stack):
    """Fill a lane of ``stack`` with a state."""
    for i in range(stack.shape[1]):
        stack[0, i, lane], stack[1, i, lane], stack[2, i, lane], stack[3, i, lane] = (
            state.x[i],
            state.v[i],
            state.a[i],
            state.w[i],
        )


@inner
def set_lane_signals(t, within, source, signals):
    """Evaluate the signals of each lane alone, which is cheap, into those of all lanes (signals, 3, 8)."""
    # Signals have branches on time and on their tables: some nanoseconds for each lane in real numbers.
    for lane in range(WIDTH):
        set_signals(source.models[lane], t, within, source.call)
        for k in range(signals.shape[0]):
            for rate in range(3):
                signals[k, rate, lane] = source.signals[k, rate]


@inner
def accelerate_lanes(problem, t, within, source, stack, none, start, state, alone):
    """Solve for consistent accelerations of each lane, and mark the lanes in which that fails."""
    # Some solutions a stretch: one lane after the other takes no time.
    for lane in range(WIDTH):
        models = SampleModels(source.models[lane], source.models[lane], alone[:0], 0)
        take_lane(stack, lane, state)
        if not accelerate(problem, models, t, within, state, none, start):
            alone[lane] = 1
        put_lane(state, lane, stack)


@inner
def count_lanes(t, stack, turns, state):
    """Count the turns of angles in all lanes at the end of a step; ``turns`` (8,): counters, 0 for none."""
    # Counters are those of one sample: they see each lane as a state.
    for lane in range(WIDTH):
        if turns[lane] != 0:
            take_lane(stack, lane, state)
            count_turns(turns[lane], t, state, STEP_END)


@inner
def all_alone(alone):
    """Whether all lanes run alone, so that nothing is left to do."""
    for lane in range(WIDTH):
        if alone[lane] == 0:
            return False
    return True


@inner
def keep_factors(layout, factors, lane, stack):
    """Keep the factors of one lane, as one sample has them; False if it exchanges other rows than the lanes before."""
    # The other lanes keep their factors: each is as old as it would be alone.
    if layout.kind == BAND:
        # Rows are exchanged by value. One sequence of exchanges serves all lanes, so that a substitution has no branch.
        for i in range(layout.size):
            if stack.is_set[0] == 0:
                stack.pivots[i], stack.tops[i] = factors.pivots[i], factors.tops[i]
            elif stack.pivots[i] != factors.pivots[i] or stack.tops[i] != factors.tops[i]:
                return False
        stack.is_set[0] = 1
        for i in range(len(factors.matrix)):
            stack.matrix[i, lane] = factors.matrix[i]
    else:
        # Dense inverses by rows, as products in lanes read them.
        for i in range(layout.size):
            for j in range(layout.size):
                stack.matrix[i * layout.size + j, lane] = factors.matrix[j * layout.lead + i]
    return True


@inlined
def lane_masses(masses):
    """The masses of eight samples as lanes."""
    return LaneMasses(masses.pattern, masses.heavy, lane_vector(masses.mass))


@inner
def largest_lanes(values, begin, end, zero):
    """Largest absolute value from begin to end, in each lane; a NaN stays, so that its lane fails."""
    largest = zero
    for k in range(begin, end):
        largest = larger(largest, sizes(values[k]))
    return largest
