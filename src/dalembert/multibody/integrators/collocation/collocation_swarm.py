"""What remains in a collocation step for many trial accelerations at once, as swarms ask for it.

Trials lie close together. So each is solved with the factorisations of one state, their prediction: as many iterations
as rounding needs, without a new matrix.
"""

from typing import NamedTuple

import numpy as np

from dalembert.kernels.kernel import inlined, inner, kernel
from dalembert.kernels.words import Address, Reals, Reals2
from dalembert.multibody.integrators.collocation.collocation_rule import Rule
from dalembert.multibody.integrators.collocation.collocation_step import CollocationRun, ScheduleStep, place
from dalembert.multibody.integrators.shared.partitioning import fill_gap
from dalembert.multibody.integrators.shared.problem import ACCELERATION, POSITION, VELOCITY, IntegrationProblem
from dalembert.multibody.kernels.assembly import constraint_rates, residual, set_signals
from dalembert.multibody.kernels.linear import Factors, resized, solve
from dalembert.multibody.kernels.states import MotionState, MotionStates, copy, resting, row

_MOST_ITERATIONS = 20
_CLOSED = 1e-13  # correction to come, against the size of what it corrects, that is none: far below what remains
_ROUNDING = 1e-11  # last correction, if they shrink no more


class Kept(NamedTuple):
    """Of the prediction: its accelerations, and of each Gauss point there the state, its derivatives by them, inverses.
    ``points`` (g, N + 1) and ``slopes`` (g unknowns, N + 1): ``a`` by the polynomial, ``w`` by the equations of motion.
    ``trial``: the state of a trial; ``vectors``: gaps, changes and what is not needed, (3, N + 1).
    """

    middle: Reals
    points: MotionStates
    slopes: MotionStates
    dependent: Reals2
    exact: Reals2
    trial: MotionState
    vectors: Reals2


def kept_workspace(walk: CollocationRun) -> Kept:
    """Workspace for what is kept of the prediction that ``walk`` holds."""
    (points, width), unknowns = walk.gaps.shape, len(walk.c)
    dependent = np.zeros((points, len(walk.partition.dependent.matrix)))
    exact = np.zeros((points, len(walk.consistency.exact.matrix)))
    states = resting(points, width), resting(points * unknowns, width)
    return Kept(walk.c.copy(), *states, dependent, exact, resting(width), np.zeros((3, width)))


def keep(walk: CollocationRun, kept: Kept, s: int) -> None:
    """Keep what was measured at a Gauss point."""
    unknowns = len(walk.c)
    own = slice(s * unknowns, (s + 1) * unknowns)
    for target, source in zip(kept.points, walk.points, strict=True):
        # The gap is a - w: accelerations by the equations of motion are the measured ones less it.
        target[s] = source[s]
    kept.points.a[s] += walk.gaps[s]
    kept.slopes.x[own], kept.slopes.v[own], kept.slopes.w[own] = walk.dpoint.x, walk.dpoint.v, walk.dpoint.a
    kept.slopes.a[own] = walk.dpoint.a + walk.slopes[s, :unknowns]
    kept.dependent[s] = walk.partition.dependent.matrix
    kept.exact[s] = walk.consistency.exact.matrix


@inner
def _start(base, kept, s, trial, state):
    """State of a trial, to first order."""
    copy(base, state)
    for k in range(len(trial)):
        # First order in the distance from the prediction; the iterations below correct the rest.
        change, own = trial[k] - kept.middle[k], s * len(trial) + k
        for i in range(len(state.x)):
            state.x[i] += change * kept.slopes.x[own, i]
            state.v[i] += change * kept.slopes.v[own, i]
            state.a[i] += change * kept.slopes.a[own, i]
            state.w[i] += change * kept.slopes.w[own, i]


@inlined
def _judge(iteration, largest, before):
    """1: solved; -1: it will not be; 0: go on."""
    if not largest < 1e100:
        return -1
    if largest <= _CLOSED:
        return 1
    if iteration > 0:
        # A simplified Newton iteration converges linearly: the sum of the corrections to come decides.
        rate = largest / before
        if rate < 1.0 and largest * rate / (1.0 - rate) <= _CLOSED:
            return 1
        if rate > 0.5:
            return 1 if largest <= _ROUNDING else -1
    return 0


@inner
def _follow(model, n, scale, partition, layout, inverse, level, state, values, work, gap, change, spare):
    """Dependent entries of a level, with a kept inverse; whether they were found."""
    before = 1.0
    for iteration in range(_MOST_ITERATIONS):
        # Independent entries stay; the kept inverse of the dependent part gives the correction of the others.
        fill_gap(model, n, level, state.x, state.v, state.a, work, gap, spare)
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


@inner
def _drive(problem, model, inverse, state, work, gap, change, spare):
    """Accelerations ``w`` and multipliers that satisfy the equations, with a kept inverse; whether they were found."""
    n, last, before = problem.n, len(state.x) - 1, 1.0
    for iteration in range(_MOST_ITERATIONS):
        residual(model, n, state.x, state.v, state.w, work, 1.0, gap)
        constraint_rates(model, n, state.x, state.v, state.w, work, spare, gap)
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


@inner
def _solve(problem, model, partition, layout, dependent, exact, state, work, gap, change, spare):
    """Dependent entries of all levels, and the accelerations ``w``; whether they were found."""
    n, scale = problem.n, problem.scale
    # Each level needs those before: rates of the constraints depend on the coordinates.
    for level in range(POSITION, ACCELERATION + 1):
        values = state.x if level == POSITION else (state.v if level == VELOCITY else state.a)
        if not _follow(model, n, scale, partition, layout, dependent, level, state, values, work, gap, change, spare):
            return False
    return _drive(problem, model, exact, state, work, gap, change, spare)


@kernel
def squares(
    problem: IntegrationProblem,
    rule: Rule,
    model: Address,
    step: ScheduleStep,
    walk: CollocationRun,
    kept: Kept,
    trials: Reals2,
    misfit: Reals,
) -> None:
    """Weighted squares of what remains, (trials,), of accelerations (trials, unknowns); infinite where not found."""
    n, own, c, state = problem.n, walk.partition, walk.consistency, kept.trial
    gap, change, spare = kept.vectors[0], kept.vectors[1], kept.vectors[2]
    layout, columns = resized(problem.exact_layout, own.rank[0]), own.columns[own.rank[0] : n]
    h = step.end - step.begin
    for b in range(len(trials)):
        misfit[b] = 0.0
    for s in range(len(rule.nodes)):
        t = step.begin + rule.nodes[s] * h
        set_signals(model, t, step.within, c.work)
        base = row(kept.points, s)
        # Point by point, all trials: the signals and the factorisations of a point are loaded once.
        dependent = Factors(kept.dependent[s], own.dependent.pivots, own.dependent.tops, own.dependent.buffer)
        exact = Factors(kept.exact[s], c.exact.pivots, c.exact.tops, c.exact.buffer)
        for b in range(len(trials)):
            if not misfit[b] < np.inf:
                continue
            _start(base, kept, s, trials[b], state)
            place(columns, h, rule.nodes[s], rule.shapes[s], walk.old, trials[b], state)
            if _solve(problem, model, own, layout, dependent, exact, state, c.work, gap, change, spare):
                total = 0.0
                for i in range(n):
                    total += (state.a[i] - state.w[i]) ** 2
                misfit[b] += rule.weights[s] * total
            else:
                misfit[b] = np.inf
