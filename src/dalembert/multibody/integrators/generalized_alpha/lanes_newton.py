"""Newton's iteration of one step of generalized-alpha for eight samples side by side.

Each lane decides for itself, by the rules of :mod:`newton`, in the same order of operations: a lane that has converged
is frozen, a lane that needs a new factorisation gets it alone, and a lane that fails is marked and later runs alone. So
a sample has the same bits in any group.
"""

from typing import NamedTuple

import numpy as np

from dalembert.kernels.kernel import inner
from dalembert.kernels.lanes import WIDTH, chosen, entry, lane_vector, lane_zeros, larger, sizes
from dalembert.kernels.words import Address, Integers, Reals, Reals2, Reals3
from dalembert.multibody.integrators.generalized_alpha.newton import AGED, MOST_ITERATIONS, SLOW
from dalembert.multibody.integrators.shared.convergence import BALANCED, NOISE, ROUNDING
from dalembert.multibody.integrators.shared.lane_states import (
    LaneFactors,
    LaneSignals,
    keep_factors,
    lane_factors,
    lane_state,
    largest_lanes,
    set_lane_signals,
    take_lane,
)
from dalembert.multibody.integrators.shared.problem import IntegrationProblem
from dalembert.multibody.kernels.assembly import displace, reduced_residual, reduced_tangent, restore, set_signals
from dalembert.multibody.kernels.linear import Factors, factorise, storage
from dalembert.multibody.kernels.sample_lanes import solve_samples
from dalembert.multibody.kernels.states import MotionState, advance, resting, shift

NORM, BEFORE, LEFT, FORCE, ITERATES, IS_FRESH = range(6)
"""Rows of the numbers of lanes: see :class:`LanesNewton`."""


class LanesNewton(NamedTuple):
    """Work of the iteration. ``model``, ``call``: in lanes, with its ``signals`` (signals, 3, 8), which come from
    ``source``. ``factors``, ``before``, ``after``: a matrix and two states of one lane. ``kept``: factors of all lanes.
    ``weights``, ``memory`` (2, 8): as of :class:`newton.Newton`. ``turns`` (8,): counters of turns, 0 for none;
    ``alone`` (8,): lanes that are to run alone. ``numbers`` (6, 8): size of the last correction, of the one before,
    bound of those to come, forces at the prediction, whether the lane iterates, whether its matrix is of this step.
    """

    model: Address
    call: Address
    signals: Reals3
    source: LaneSignals
    factors: Factors
    before: MotionState
    after: MotionState
    kept: LaneFactors
    r: Reals2
    delta: Reals2
    change: Reals2
    buffer: Reals2
    slope: Reals2
    weights: Reals
    memory: Reals2
    turns: Integers
    alone: Integers
    numbers: Reals2


def lanes_newton(
    problem: IntegrationProblem,
    model: int,
    call: Address,
    signals: np.ndarray,
    source: LaneSignals,
    turns: np.ndarray,
) -> LanesNewton:
    """Workspace for the iteration."""
    layout, width = problem.reduced.layout, len(problem.scale)
    r, delta = lane_zeros(2, layout.size + 1)
    # The same array where no node makes them differ, as of one sample.
    change = delta if problem.reduced.increments == problem.n else lane_zeros(width)
    return LanesNewton(
        model, call, signals, source, storage(layout), resting(width), resting(width), lane_factors(layout), r, delta,
        change,
        lane_zeros(layout.size + 3 * layout.reach), lane_zeros(width), 1.0 / problem.scale, lane_zeros(2),
        turns, np.zeros(WIDTH, np.int64), lane_zeros(6),
    )  # fmt: skip


@inner
def _renew(problem, c, t, within, stack, lane, scratch):
    """Factorise the matrix of one lane, by the kernels of one sample; mark the lane where that fails, or where it
    exchanges other rows than the lanes before.
    """
    reduced, factors, state = problem.reduced, scratch.factors, scratch.after
    # The derivative of the residual along da, with dv = c.dv da and dq = c.dq da.
    take_lane(stack, lane, state)
    model, work = scratch.source.models[lane], scratch.source.call
    set_signals(model, t, within, work)
    reduced_tangent(
        model, reduced.slots, reduced.increments, reduced.layout.size, state.x, state.v, state.a,
        (c.dq, c.dv, 1.0), (1.0, 1.0 / c.dq), work, factors.matrix,
    )  # fmt: skip
    if not factorise(reduced.layout, factors):
        scratch.alone[lane] = 1
        return
    scratch.memory[0, lane] = c.step
    # The factors as one sample has them, so that no bit depends on the group; the other lanes keep theirs.
    if not keep_factors(reduced.layout, factors, lane, scratch.kept):
        scratch.alone[lane] = 1


@inner
def _predict(n, c, old, new, scratch):
    """Fill the new states with linear extrapolations of accelerations and multipliers, as for one sample."""
    slope = lane_vector(scratch.slope)
    for i in range(n):
        new.a[i] = old.a[i] + c.step * slope[i]
    # Multipliers stand behind the coordinates.
    for i in range(n, len(old.x) - 1):
        new.x[i] = old.x[i] + c.step * slope[i]
    advance(n, c, old, new)
    # The predicted coordinates of nodes are moved onto their internal constraints.
    change = lane_vector(scratch.change)
    if restore(scratch.model, c.dq, new.x, scratch.call, change):
        shift(n, c, change, new)


@inner
def _correct(n, c, weights, mask, corrections, old, new, zero):
    """Apply the corrections of lanes that iterate; return their sizes against the scales."""
    size = zero
    for i in range(n):
        # A frozen lane takes off zero, which keeps its bits.
        change = chosen(mask, corrections[i])
        new.a[i] -= change
        size = larger(size, c.dq * weights[i] * sizes(change))
    for i in range(n, len(old.x) - 1):
        new.x[i] -= chosen(mask, corrections[i])
    advance(n, c, old, new)
    return size


@inner
def _stops(lane, iteration, tolerance, size, forces, scratch):
    """Return whether a lane stops to iterate, and whether it needs a new matrix: the rules of `newton.converge`."""
    values, memory = scratch.numbers, scratch.memory
    values[NORM, lane] = size
    # A lane that lost its numbers stops too, and then runs alone.
    if not size < 1e100 or size <= tolerance:
        return True, False
    # Of a linear contraction rate, norm rate / (1 - rate) bounds the sum of all corrections to come.
    rate = memory[1, lane] if iteration == 1 else size / values[BEFORE, lane]
    values[LEFT, lane] = size * rate / (1.0 - rate) if rate < 1.0 else size
    if values[LEFT, lane] <= tolerance:
        return True, False
    # Small corrections that do not shrink are rounding only if the forces are in balance.
    if iteration > 2 and rate > 0.5 and size <= ROUNDING and forces <= BALANCED * values[FORCE, lane]:
        values[LEFT, lane] = 0.0
        return True, False
    if iteration > 1 and size > NOISE:
        memory[1, lane] = rate
    values[BEFORE, lane] = size
    slow = iteration > 1 and rate > SLOW
    # A new matrix that diverges helps no more: the step must be shorter.
    return slow and values[IS_FRESH, lane] == 1.0 and rate > 2.0, slow


@inner
def converge_lanes(problem, c, t, within, tolerance, old_stack, new_stack, scratch):
    """Newton's iteration on new accelerations and multipliers of all lanes that are not marked: `newton.converge`.

    ``old_stack``, ``new_stack`` (4, N + 1, 8): x, v, a and w of the lanes. A lane that does not converge is marked.
    """
    n, reduced, memory, alone, values = problem.n, problem.reduced, scratch.memory, scratch.alone, scratch.numbers
    old, new = lane_state(old_stack), lane_state(new_stack)
    kept = scratch.kept
    r, delta, numbers = lane_vector(scratch.r), lane_vector(scratch.delta), lane_vector(scratch.numbers)
    change = lane_vector(scratch.change)
    zero = 0.0 * old.x[len(old.x) - 1]
    _predict(n, c, old, new, scratch)
    for lane in range(WIDTH):
        values[NORM, lane], values[BEFORE, lane], values[LEFT, lane] = 1.0, 0.0, 1.0
        # Each lane keeps its matrix while its step is about as long and its last contraction was good.
        is_aged = not (0.8 * memory[0, lane] < c.step < 1.25 * memory[0, lane]) or memory[1, lane] > AGED
        values[IS_FRESH, lane] = 0.0
        if alone[lane] == 0 and is_aged:
            _renew(problem, c, t, within, new_stack, lane, scratch)
            memory[1, lane], values[IS_FRESH, lane] = AGED, 1.0
        values[ITERATES, lane] = 1.0 - alone[lane]
    set_lane_signals(t, within, scratch.source, scratch.signals)
    for iteration in range(1, MOST_ITERATIONS + 1):
        reduced_residual(scratch.model, reduced.increments, new.x, new.v, new.a, scratch.call, 1.0 / c.dq, r)
        if iteration == 1:  # of the prediction, and of the constraints
            numbers[FORCE] = larger(
                largest_lanes(r, 0, reduced.increments, zero), largest_lanes(new.x, n, len(old.x) - 1, zero)
            )
        # Increments by the kept matrices, then the step by its formulas, as for one sample.
        solve_samples(reduced.layout, kept.matrix, kept.pivots, kept.tops, scratch.r, scratch.buffer, scratch.delta)
        displace(scratch.model, c.dq, new.x, delta, scratch.call, change)
        moved = _correct(n, c, scratch.weights, numbers[ITERATES], change, old, new, zero)
        forces = largest_lanes(r, 0, reduced.increments, zero) if iteration > 2 else zero
        running = False
        for lane in range(WIDTH):
            if values[ITERATES, lane] == 1.0:
                ends, is_slow = _stops(lane, iteration, tolerance, entry(moved, lane), entry(forces, lane), scratch)
                if is_slow and not ends:
                    # The matrix of this lane alone: the others keep theirs.
                    _renew(problem, c, t, within, new_stack, lane, scratch)
                    values[IS_FRESH, lane], ends = 1.0, alone[lane] == 1
                values[ITERATES, lane] = 0.0 if ends else 1.0
                running = running or not ends
        if not running:
            break
    for lane in range(WIDTH):
        # What else may pass as converged is decided where the sample runs alone.
        if not (values[NORM, lane] <= tolerance or values[LEFT, lane] <= tolerance):
            alone[lane] = 1
