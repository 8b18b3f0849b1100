"""Newton's iteration on the accelerations and multipliers of one step, with a factorisation that is kept over steps.

The equations of motion and the constraints hold at the end of the step (index 3, `docs/theory/generalized-alpha.md`).
The constraint rows are divided by ``dq`` = beta h^2 (1 - alpha_f) / (1 - alpha_m), so that the matrix

    [M + dv C + dq K, J^T; J, 0]

stays well conditioned as h approaches 0. The iteration solves the reduced system for increments. What these change of
the coordinates changes the accelerations, divided by ``dq``, so that the formulas of the step hold for all coordinates
alike.
"""

from typing import NamedTuple

import numpy as np

from dalembert.kernels.kernel import inlined, inner
from dalembert.kernels.words import Address, Reals
from dalembert.multibody.integrators.shared.convergence import BALANCED, MAGNIFIED, NOISE, ROUNDING, largest_entry
from dalembert.multibody.integrators.shared.problem import DONE, NEWTON_FAILED, SINGULAR, IntegrationProblem
from dalembert.multibody.kernels.assembly import displace, reduced_residual, reduced_tangent, restore, set_signals
from dalembert.multibody.kernels.linear import Factors, factorise, solve, storage
from dalembert.multibody.kernels.states import advance, shift

MOST_ITERATIONS = 12
SLOW = 0.3  # contraction at which an iteration is not worth going on with the kept factorisation
AGED = 0.02  # contraction at which the next step begins with a new one


class Newton(NamedTuple):
    """Work of the Newton iteration. ``memory``: step for which the kept factorisation was made (0: none), contraction
    seen last. ``slope``: rate of change of accelerations and multipliers over the last step, for the prediction of the
    next one. ``weights``: reciprocals of the scales, since a division takes as long as a dozen products.
    ``r`` and ``delta`` have the rows of the reduced system, ``change`` is the correction of all unknowns: the
    same array without nodes.
    """

    factors: Factors
    work: Address
    complex_work: Address
    r: Reals
    delta: Reals
    change: Reals
    memory: Reals
    slope: Reals
    weights: Reals


def newton(problem: IntegrationProblem, work: int, complex_work: int) -> Newton:
    """Workspace for the iteration."""
    layout, width = problem.reduced.layout, len(problem.scale)
    r, delta = np.zeros((2, layout.size + 1))
    change = delta if problem.reduced.increments == problem.n else np.zeros(width)
    return Newton(
        storage(layout), work, complex_work, r, delta, change, np.zeros(2), np.zeros(width), 1.0 / problem.scale
    )


@inner
def _renew(problem, tangent_model, c, t, within, new, newton):
    set_signals(tangent_model, t, within, newton.complex_work)
    # The derivative of the residual along da, with dv = c.dv da and dq = c.dq da of the formulas of the step: M + dv C
    # + dq K. The constraint rows are divided by dq, so that their columns J^T and rows J have one scale.
    own = problem.reduced
    reduced_tangent(
        tangent_model, own.slots, own.increments, own.layout.size, new.x, new.v, new.a, (c.dq, c.dv, 1.0),
        (1.0, 1.0 / c.dq), newton.complex_work, newton.factors.matrix,
    )  # fmt: skip
    newton.memory[0] = c.step if factorise(own.layout, newton.factors) else 0.0
    return newton.memory[0] != 0.0


@inlined
def _predict(n, c, model, old, newton, new):
    """Accelerations and multipliers of the new state, by those of the old one and their last change."""
    slope, change = newton.slope, newton.change
    # Linear extrapolation of what Newton solves for. Coordinates and velocities follow from the formulas of the step,
    # never by themselves, so that they hold exactly at each iteration.
    for i in range(n):
        new.a[i] = old.a[i] + c.step * slope[i]
    for i in range(n, len(old.x) - 1):
        new.x[i] = old.x[i] + c.step * slope[i]
    advance(n, c, old, new)
    # The predicted coordinates of a rotation are no rotation matrix: they are first moved onto the internal
    # constraints, which the reduced system does not contain.
    if restore(model, c.dq, new.x, newton.work, change):
        shift(n, c, change, new)


@inlined
def keep_slope(n, c, old, new, slope):
    """Change of accelerations and multipliers over a step, in real numbers or in lanes."""
    inverse = 1.0 / c.step
    for i in range(n):
        slope[i] = inverse * (new.a[i] - old.a[i])
    for i in range(n, len(old.x) - 1):
        slope[i] = inverse * (new.x[i] - old.x[i])


@inlined
def _correct(n, c, weights, change, old, new):
    """Apply a Newton correction: its size against the scales 1/weight, and the coordinate that moved most."""
    norm, worst = 0.0, 0
    for i in range(n):
        new.a[i] -= change[i]
        moved = c.dq * weights[i] * abs(change[i])
        if norm == norm and not moved <= norm:  # the first that is not a number stays
            norm, worst = moved, i
    for i in range(n, len(old.x) - 1):
        new.x[i] -= change[i]
    advance(n, c, old, new)
    return norm, worst


@inlined
def converge(problem, model, tangent_model, c, t, within, tolerance, old, new, newton, log):
    """Newton iteration on new accelerations and multipliers: status, and iterations or the unknown that moved most."""
    n, own, memory = problem.n, problem.reduced, newton.memory
    _predict(n, c, model, old, newton, new)
    # The matrix of an earlier step serves while the step is about as long and the last contraction was good: in a
    # smooth motion one factorisation lasts for many steps.
    fresh = not (0.8 * memory[0] < c.step < 1.25 * memory[0]) or memory[1] > AGED
    if fresh:
        log.counts[2] += 1
        if not _renew(problem, tangent_model, c, t, within, new, newton):
            return SINGULAR, 0
        memory[1] = AGED
    before, norm, left, worst, force = 0.0, 1.0, 1.0, 0, 0.0
    for iteration in range(1, MOST_ITERATIONS + 1):
        reduced_residual(model, own.increments, new.x, new.v, new.a, newton.work, 1.0 / c.dq, newton.r)
        if iteration == 1:  # of the prediction, and of the constraints
            force = max(largest_entry(newton.r, 0, own.increments), largest_entry(new.x, n, len(old.x) - 1))
        # In the order of Newton: increments by the kept matrix, what they change of the coordinates by the chart of
        # each node, then the step by its formulas.
        solve(own.layout, newton.factors, newton.r, newton.delta)
        displace(model, c.dq, new.x, newton.delta, newton.work, newton.change)
        log.counts[1] += 1
        norm, worst = _correct(n, c, newton.weights, newton.change, old, new)
        if not norm < 1e100 or norm <= tolerance:
            break
        # Of a linear contraction rate, norm rate / (1 - rate) bounds the sum of all corrections to come. So an
        # iteration can end without the one that would only confirm it.
        rate = memory[1] if iteration == 1 else norm / before
        left = norm * rate / (1.0 - rate) if rate < 1.0 else norm
        if left <= tolerance:
            break
        # Small corrections that do not shrink are rounding only if the forces are in balance.
        if iteration > 2 and rate > 0.5 and norm <= ROUNDING:
            if largest_entry(newton.r, 0, own.increments) <= BALANCED * force:
                break
        if iteration > 1 and norm > NOISE:
            memory[1] = rate
        if iteration > 1 and rate > SLOW:
            # A new matrix that diverges helps no more: the step must be shorter.
            if fresh and rate > 2.0:
                break
            log.counts[2] += 1
            if not _renew(problem, tangent_model, c, t, within, new, newton):
                return SINGULAR, worst
            fresh = True
        before = norm
    done = norm <= tolerance or left <= tolerance
    if done or (norm <= MAGNIFIED and largest_entry(newton.r, 0, own.increments) <= BALANCED * force):
        return DONE, iteration
    # The matrix belongs to a state that the step does not reach.
    memory[0] = 0.0
    return NEWTON_FAILED, worst
