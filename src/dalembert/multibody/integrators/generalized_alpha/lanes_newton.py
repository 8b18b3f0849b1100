"""Newton's iteration of one step of generalized-alpha for eight samples side by side.

Each lane decides for itself, by the rules of :mod:`newton`, in the same order of operations: a lane that has converged
is frozen, a lane that needs a new factorisation gets it alone, and a lane that fails is marked and later runs alone. So
a sample has the same bits in any group.
"""

from typing import NamedTuple

import numpy as np

from dalembert.kernels.kernel import inlined, inner
from dalembert.kernels.lanes import WIDTH, chosen, entry, lane_vector, larger, sizes
from dalembert.kernels.words import Address, Integers, Integers2, Reals2, Reals3
from dalembert.multibody.integrators.generalized_alpha.newton import AGED, MOST_ITERATIONS, SLOW
from dalembert.multibody.integrators.shared.convergence import BALANCED, MAGNIFIED, NOISE, ROUNDING
from dalembert.multibody.integrators.shared.problem import IntegrationProblem
from dalembert.multibody.kernels.assembly import reduced_residual, reduced_tangent, set_signals
from dalembert.multibody.kernels.linear import BAND, Factors, factorise, storage
from dalembert.multibody.kernels.sample_lanes import solve_samples
from dalembert.multibody.kernels.states import MotionState, advance, resting


class LanesNewton(NamedTuple):
    """Work of the iteration. ``model``, ``call``: in lanes, with its ``signals`` (signals, 3, 8); ``reals`` (8,): those
    of the lanes in real numbers; ``work``: their call, with its signals (signals, 3). ``factors``, ``one``, ``other``:
    a matrix and two states of one lane. ``matrix`` (entries, 8): factorised matrices; ``pivots``, ``tops`` (N,): of all
    lanes; ``has_pivots`` (1,): whether they are known. ``memory`` (2, 8): as of :class:`newton.Newton`. ``alone`` (8,):
    lanes that are to run alone. ``numbers`` (6, 8): norms, those before, what is left, forces, whether the lane
    iterates, whether its matrix is of this step. ``counts`` (8, 4): as those of a log.
    """

    model: Address
    call: Address
    signals: Reals3
    reals: Integers
    work: Address
    signals_alone: Reals2
    factors: Factors
    one: MotionState
    other: MotionState
    matrix: Reals2
    pivots: Integers
    tops: Integers
    has_pivots: Integers
    r: Reals2
    delta: Reals2
    buffer: Reals2
    slope: Reals2
    memory: Reals2
    alone: Integers
    numbers: Reals2
    counts: Integers2


def lanes_newton(
    problem: IntegrationProblem,
    model: int,
    call: Address,
    signals: np.ndarray,
    reals: np.ndarray,
    work: int,
    signals_alone: np.ndarray,
) -> LanesNewton:
    """Workspace for the iteration."""
    layout, width = problem.reduced.layout, len(problem.scale)
    factors = storage(layout)
    return LanesNewton(
        model, call, signals, reals, work, signals_alone, factors, resting(width), resting(width),
        np.zeros((len(factors.matrix), WIDTH)), np.zeros(layout.size, np.int64), np.zeros(layout.size, np.int64),
        np.zeros(1, np.int64), np.zeros((layout.size + 1, WIDTH)), np.zeros((layout.size + 1, WIDTH)),
        np.zeros((layout.size + 3 * layout.reach, WIDTH)), np.zeros((width, WIDTH)), np.zeros((2, WIDTH)),
        np.zeros(WIDTH, np.int64), np.zeros((6, WIDTH)), np.zeros((WIDTH, 4), np.int64),
    )  # fmt: skip


@inner
def take_lane(stack, lane, one):
    """Fill a state with that of a lane of ``stack`` (4, N + 1, 8)."""
    for i in range(stack.shape[1]):
        one.x[i], one.v[i], one.a[i], one.w[i] = (
            stack[0, i, lane],
            stack[1, i, lane],
            stack[2, i, lane],
            stack[3, i, lane],
        )


@inner
def put_lane(one, lane, stack):
    """Fill a lane of ``stack`` with a state."""
    for i in range(stack.shape[1]):
        stack[0, i, lane], stack[1, i, lane], stack[2, i, lane], stack[3, i, lane] = (
            one.x[i],
            one.v[i],
            one.a[i],
            one.w[i],
        )


@inner
def set_lane_signals(t, within, scratch):
    """Evaluate the signals of each lane alone, which is cheap, into those of all lanes."""
    for lane in range(WIDTH):
        set_signals(scratch.reals[lane], t, within, scratch.work)
        for k in range(scratch.signals.shape[0]):
            for rate in range(3):
                scratch.signals[k, rate, lane] = scratch.signals_alone[k, rate]


@inner
def _renew(problem, c, t, within, stack, lane, scratch):
    """Factorise the matrix of one lane, by the kernels of one sample; mark the lane where that fails, or where it
    exchanges other rows than the lanes before.
    """
    own, factors, one = problem.reduced, scratch.factors, scratch.one
    scratch.counts[lane, 2] += 1
    take_lane(stack, lane, one)
    set_signals(scratch.reals[lane], t, within, scratch.work)
    reduced_tangent(
        scratch.reals[lane], own.slots, own.increments, own.layout.size, one.x, one.v, one.a, (c.dq, c.dv, 1.0),
        (1.0, 1.0 / c.dq), scratch.work, factors.matrix,
    )  # fmt: skip
    if not factorise(own.layout, factors):
        scratch.alone[lane] = 1
        return
    scratch.memory[0, lane] = c.step
    if own.layout.kind == BAND:
        for i in range(own.layout.size):
            if scratch.has_pivots[0] == 0:
                scratch.pivots[i], scratch.tops[i] = factors.pivots[i], factors.tops[i]
            elif scratch.pivots[i] != factors.pivots[i] or scratch.tops[i] != factors.tops[i]:
                scratch.alone[lane] = 1
                return
        scratch.has_pivots[0] = 1
    for i in range(len(factors.matrix)):
        scratch.matrix[i, lane] = factors.matrix[i]


@inlined
def _largest(values, begin, end, zero):
    """Largest absolute value from begin to end, in each lane."""
    largest = zero
    for k in range(begin, end):
        largest = larger(largest, sizes(values[k]))
    return largest


@inner
def converge_lanes(problem, c, t, within, tolerance, old_stack, new_stack, scratch):
    """Newton's iteration on new accelerations and multipliers of all lanes that are not marked; `newton.converge`."""
    n, own, memory, alone = problem.n, problem.reduced, scratch.memory, scratch.alone
    old = MotionState(
        lane_vector(old_stack[0]), lane_vector(old_stack[1]), lane_vector(old_stack[2]), lane_vector(old_stack[3])
    )
    new = MotionState(
        lane_vector(new_stack[0]), lane_vector(new_stack[1]), lane_vector(new_stack[2]), lane_vector(new_stack[3])
    )
    r, delta, slope = lane_vector(scratch.r), lane_vector(scratch.delta), lane_vector(scratch.slope)
    numbers = lane_vector(scratch.numbers)
    norm, before, left, force, iterates = 0, 1, 2, 3, 4
    values, zero = scratch.numbers, 0.0 * old.x[len(old.x) - 1]
    for i in range(n):
        new.a[i] = old.a[i] + c.step * slope[i]
    for i in range(n, len(old.x) - 1):
        new.x[i] = old.x[i] + c.step * slope[i]
    advance(n, c, old, new)
    for lane in range(WIDTH):
        values[norm, lane], values[before, lane], values[left, lane] = 1.0, 0.0, 1.0
        values[5, lane] = 0.0
        if alone[lane] == 0 and (
            not (0.8 * memory[0, lane] < c.step < 1.25 * memory[0, lane]) or memory[1, lane] > AGED
        ):
            _renew(problem, c, t, within, new_stack, lane, scratch)
            memory[1, lane] = AGED
            values[5, lane] = 1.0
        values[iterates, lane] = 1.0 - alone[lane]
    set_lane_signals(t, within, scratch)
    for iteration in range(1, MOST_ITERATIONS + 1):
        reduced_residual(scratch.model, own.increments, new.x, new.v, new.a, scratch.call, 1.0 / c.dq, r)
        if iteration == 1:
            numbers[force] = larger(_largest(r, 0, own.increments, zero), _largest(new.x, n, len(old.x) - 1, zero))
        solve_samples(
            own.layout, scratch.matrix, scratch.pivots, scratch.tops, scratch.r, scratch.buffer, scratch.delta
        )
        mask, moved = numbers[iterates], zero
        for i in range(n):
            change = chosen(mask, delta[i])
            new.a[i] -= change
            moved = larger(moved, c.dq * sizes(change) / problem.scale[i])
        for i in range(n, len(old.x) - 1):
            new.x[i] -= chosen(mask, delta[i])
        advance(n, c, old, new)
        running = False
        for lane in range(WIDTH):
            if values[iterates, lane] == 0.0:
                continue
            scratch.counts[lane, 1] += 1
            size = entry(moved, lane)
            values[norm, lane] = size
            if not size < 1e100 or size <= tolerance:
                values[iterates, lane] = 0.0
                continue
            rate = memory[1, lane] if iteration == 1 else size / values[before, lane]
            values[left, lane] = size * rate / (1.0 - rate) if rate < 1.0 else size
            if values[left, lane] <= tolerance:
                values[iterates, lane] = 0.0
                continue
            if iteration > 2 and rate > 0.5 and size <= ROUNDING:
                if entry(_largest(r, 0, own.increments, zero), lane) <= BALANCED * values[force, lane]:
                    values[iterates, lane] = 0.0
                    continue
            if iteration > 1 and size > NOISE:
                memory[1, lane] = rate
            if iteration > 1 and rate > SLOW:
                if values[5, lane] == 1.0 and rate > 2.0:
                    values[iterates, lane] = 0.0
                    continue
                _renew(problem, c, t, within, new_stack, lane, scratch)
                values[5, lane] = 1.0
                if alone[lane] == 1:
                    values[iterates, lane] = 0.0
                    continue
            values[before, lane] = size
            running = True
        if not running:
            break
    for lane in range(WIDTH):
        done = values[norm, lane] <= tolerance or values[left, lane] <= tolerance
        if not done and values[norm, lane] <= MAGNIFIED:
            done = entry(_largest(r, 0, own.increments, zero), lane) <= BALANCED * values[force, lane]
        if not done:
            alone[lane] = 1
