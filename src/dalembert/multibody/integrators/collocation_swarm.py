"""What remains in a collocation step for many trial accelerations at once, as swarms ask for it.

Trials lie close together. So each is solved with the factorisations of one state, their prediction: as many iterations
as rounding needs, without a new matrix.
"""

from typing import NamedTuple

import numpy as np

from dalembert.multibody.integrators.collocation_step import place
from dalembert.multibody.integrators.lifting import set_signals
from dalembert.multibody.integrators.partitioning import ACCELERATION, POSITION, VELOCITY
from dalembert.multibody.kernels import joints
from dalembert.multibody.kernels.assembly import gather, residual_here
from dalembert.multibody.kernels.compiled import compiled, inlined, kernel
from dalembert.multibody.kernels.linear import Factors, Layout, solve
from dalembert.multibody.kernels.motion import Motion, copy, row, still
from dalembert.multibody.kernels.vector import LANES

_MOST_ITERATIONS = 20
_CLOSED = 1e-13  # correction to come, against the size of what it corrects, that is none: far below what remains
_ROUNDING = 1e-11  # last correction, if they shrink no more


class Kept(NamedTuple):
    """Of the prediction: its accelerations, and of each Gauss point there the state, its derivatives by them, inverses.

    ``points`` (g, N + 1) and ``slopes`` (g unknowns, N + 1): ``a`` by the polynomial, ``w`` by the equations of motion.
    """

    middle: np.ndarray
    points: Motion
    slopes: Motion
    dependent: np.ndarray
    exact: np.ndarray


@compiled
def keep(walk, kept, s):
    """Keep what was measured at a Gauss point."""
    base, unknowns = row(kept.points, s), len(walk.c)
    copy(row(walk.points, s), base)
    for i in range(len(base.x)):
        base.a[i] += walk.gaps[s, i]
        for k in range(unknowns):
            slope = row(kept.slopes, s * unknowns + k)
            slope.x[i], slope.v[i] = walk.dpoint.x[k, i], walk.dpoint.v[k, i]
            slope.w[i] = walk.dpoint.a[k, i]
            slope.a[i] = slope.w[i] + walk.slopes[s, k, i]
    kept.dependent[s] = walk.partition.dependent.matrix
    kept.exact[s] = walk.exact.matrix


@kernel
def _start(base, kept, s, trial, state):
    """State of a trial, to first order."""
    copy(base, state)
    for k in range(len(trial)):
        change, own = trial[k] - kept.middle[k], s * len(trial) + k
        for i in range(len(state.x)):
            state.x[i] += change * kept.slopes.x[own, i]
            state.v[i] += change * kept.slopes.v[own, i]
            state.a[i] += change * kept.slopes.a[own, i]
            state.w[i] += change * kept.slopes.w[own, i]


@inlined
def _fill_gap(block, callbacks, n, level, x, v, a, work, gap):
    """The constraints, or their first or second rates, into the entries of ``gap`` from n on."""
    for e in range(len(block.index)):
        gather(block.index, e, joints.WIDTH, x, v, a, work)
        first = joints.MULTIPLIERS
        if level == POSITION:
            joints.residual(work.x, work.v, work.a, work.signals, callbacks, block.data, block.meta, e, work.r)
        else:
            first = 3 if level == ACCELERATION else 0
            joints.rates(work.x, work.v, work.a, work.signals, block.data, block.meta, e, work.r)
        for i in range(3):
            gap[block.index[e, joints.MULTIPLIERS + i]] = work.r[first + i]


@inlined
def _judge(iteration, largest, before):
    """1: solved; -1: it will not be; 0: go on."""
    if not largest < 1e100:
        return -1
    if largest <= _CLOSED:
        return 1
    if iteration > 0:
        rate = largest / before
        if rate < 1.0 and largest * rate / (1.0 - rate) <= _CLOSED:
            return 1
        if rate > 0.5:
            return 1 if largest <= _ROUNDING else -1
    return 0


@kernel
def _follow(block, callbacks, n, scale, partition, layout, inverse, level, state, values, work, gap, change):
    """Dependent entries of a level, with a kept inverse; whether they were found."""
    before = 1.0
    for iteration in range(_MOST_ITERATIONS):
        _fill_gap(block, callbacks, n, level, state.x, state.v, state.a, work, gap)
        for i in range(layout.size):
            change[i] = gap[n + partition.rows[i]]
        solve(layout, inverse, change, gap)
        largest = 0.0
        for i in range(layout.size):
            own = partition.columns[i]
            values[own] -= gap[i]
            moved = abs(gap[i]) / (scale[own] + abs(values[own]))
            if largest == largest and not moved <= largest:
                largest = moved
        verdict = _judge(iteration, largest, before)
        if verdict != 0:
            return verdict > 0
        before = largest
    return False


@inlined
def _drive(problem, model, inverse, state, work, gap, change):
    """Accelerations ``w`` and multipliers that satisfy the equations, with a kept inverse; whether they were found."""
    n, last, before = problem.n, len(state.x) - 1, 1.0
    for iteration in range(_MOST_ITERATIONS):
        residual_here(model, n, state.x, state.v, state.w, work, 1.0, gap)
        _fill_gap(model.joints, model.callbacks, n, ACCELERATION, state.x, state.v, state.w, work, gap)
        solve(problem.exact_layout, inverse, gap, change)
        largest, size = 0.0, 0.0
        for i in range(n):
            state.w[i] -= change[i]
            size = max(size, abs(state.w[i]))
            moved = abs(change[i])
            if largest == largest and not moved <= largest:
                largest = moved
        for i in range(n, last):
            state.x[i] -= change[i]
        verdict = _judge(iteration, largest / (size + 1e-300), before)
        if verdict != 0:
            return verdict > 0
        before = largest / (size + 1e-300)
    return False


@kernel
def _solve(problem, model, partition, layout, dependent, exact, state, work, gap, change):
    """Dependent entries of all levels, and the accelerations ``w``; whether they were found."""
    n, scale, block, callbacks = problem.n, problem.scale, model.joints, model.callbacks
    for level in range(POSITION, ACCELERATION + 1):
        values = state.x if level == POSITION else (state.v if level == VELOCITY else state.a)
        if not _follow(
            block, callbacks, n, scale, partition, layout, dependent, level, state, values, work, gap, change
        ):
            return False
    return _drive(problem, model, exact, state, work, gap, change)


@compiled
def squares(problem, rule, model, schedule, number, walk, kept, trials, fitness):
    """Weighted squares of what remains, (trials,), of accelerations (trials, unknowns); infinite where not found."""
    n, own, whole = problem.n, walk.partition, problem.exact_layout
    layout = Layout(whole.kind, own.rank[0], whole.reach, -(-own.rank[0] // LANES) * LANES, whole.order)
    state, width = still(len(problem.scale)), len(problem.scale)
    gap, change = np.zeros(width), np.zeros(width)
    h = schedule.ends[number] - schedule.begins[number]
    fitness[:] = 0.0
    for s in range(len(rule.nodes)):
        t = schedule.begins[number] + rule.nodes[s] * h
        set_signals(model, t, schedule.within[number], walk.work)
        base = row(kept.points, s)
        dependent = Factors(kept.dependent[s], own.dependent.pivots, own.dependent.tops, own.dependent.buffer)
        exact = Factors(kept.exact[s], walk.exact.pivots, walk.exact.tops, walk.exact.buffer)
        for b in range(len(trials)):
            if not fitness[b] < np.inf:
                continue
            _start(base, kept, s, trials[b], state)
            place(n, own, h, rule.nodes[s], rule.shapes[s], walk.old, trials[b], state)
            if _solve(problem, model, own, layout, dependent, exact, state, walk.work, gap, change):
                total = 0.0
                for i in range(n):
                    total += (state.a[i] - state.w[i]) ** 2
                fitness[b] += rule.weights[s] * total
            else:
                fitness[b] = np.inf
