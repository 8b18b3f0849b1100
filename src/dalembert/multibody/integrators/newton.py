"""Newton's iteration on the accelerations and multipliers of one step, with a factorisation that is kept over steps."""

from typing import NamedTuple

from dalembert.kernels.kernel import inlined, inner
from dalembert.kernels.words import Address, Reals
from dalembert.multibody.integrators.problem import DONE, NEWTON_FAILED, SINGULAR
from dalembert.multibody.kernels.assembly import residual, set_signals, tangent
from dalembert.multibody.kernels.linear import Factors, factorise, solve
from dalembert.multibody.kernels.motion import advance

_MOST_ITERATIONS = 12
_SLOW = 0.3  # contraction at which an iteration is not worth going on with the kept factorisation
_AGED = 0.02  # contraction at which the next step begins with a new one
# Relative corrections that stop to shrink are rounding below the first size, and below the second one if a nearly
# singular position magnifies it.
_ROUNDING, _MAGNIFIED = 1e-12, 1e-9
_NOISE = 1e-13  # below this size the ratio of two corrections says nothing of the factorisation


class Newton(NamedTuple):
    """Work of the Newton iteration.

    ``memory``: step for which the kept factorisation was made (0: none), contraction seen last. ``slope``: rate of
    change of accelerations and multipliers over the last step, for the prediction of the next one.
    """

    factors: Factors
    work: Address
    dual_work: Address
    r: Reals
    delta: Reals
    memory: Reals
    slope: Reals


@inner
def _renew(problem, dual, c, t, within, new, newton):
    set_signals(dual, t, within, newton.dual_work)
    tangent(
        dual, problem.slots, problem.n, new.x, new.v, new.a, (c.dq, c.dv, 1.0), (1.0, 1.0 / c.dq), newton.dual_work,
        newton.factors.matrix,
    )  # fmt: skip
    newton.memory[0] = c.step if factorise(problem.layout, newton.factors) else 0.0
    return newton.memory[0] != 0.0


@inlined
def _predict(n, c, old, slope, new):
    """Accelerations and multipliers of the new state, by those of the old one and their last change."""
    for i in range(n):
        new.a[i] = old.a[i] + c.step * slope[i]
    for i in range(n, len(old.x) - 1):
        new.x[i] = old.x[i] + c.step * slope[i]
    advance(n, c, old, new)


@inlined
def learn(n, c, old, new, slope):
    """Change of accelerations and multipliers over a step."""
    for i in range(n):
        slope[i] = (new.a[i] - old.a[i]) / c.step
    for i in range(n, len(old.x) - 1):
        slope[i] = (new.x[i] - old.x[i]) / c.step


@inlined
def _correct(n, c, scale, delta, old, new):
    """Apply a Newton correction: its size against the scales, and the coordinate that moved most."""
    norm, worst = 0.0, 0
    for i in range(n):
        new.a[i] -= delta[i]
        moved = c.dq * abs(delta[i]) / scale[i]
        if norm == norm and not moved <= norm:  # the first that is not a number stays
            norm, worst = moved, i
    for i in range(n, len(old.x) - 1):
        new.x[i] -= delta[i]
    advance(n, c, old, new)
    return norm, worst


@inlined
def converge(problem, model, dual, c, t, within, tolerance, old, new, newton, log):
    """Newton iteration on new accelerations and multipliers: status, and iterations or the unknown that moved most."""
    n, memory = problem.n, newton.memory
    _predict(n, c, old, newton.slope, new)
    fresh = not (0.8 * memory[0] < c.step < 1.25 * memory[0]) or memory[1] > _AGED
    if fresh:
        log.counts[2] += 1
        if not _renew(problem, dual, c, t, within, new, newton):
            return SINGULAR, 0
        memory[1] = _AGED
    before, norm, worst = 0.0, 1.0, 0
    for iteration in range(1, _MOST_ITERATIONS + 1):
        residual(model, n, new.x, new.v, new.a, newton.work, 1.0 / c.dq, newton.r)
        solve(problem.layout, newton.factors, newton.r, newton.delta)
        log.counts[1] += 1
        norm, worst = _correct(n, c, problem.scale, newton.delta, old, new)
        if not norm < 1e100 or norm <= tolerance:
            break
        rate = memory[1] if iteration == 1 else norm / before
        if rate < 1.0 and norm * rate / (1.0 - rate) <= tolerance:
            break
        if iteration > 2 and rate > 0.5 and norm <= _ROUNDING:
            break
        if iteration > 1 and norm > _NOISE:
            memory[1] = rate
        if iteration > 1 and rate > _SLOW:
            if fresh and rate > 2.0:
                break
            log.counts[2] += 1
            if not _renew(problem, dual, c, t, within, new, newton):
                return SINGULAR, worst
            fresh = True
        before = norm
    if norm <= _MAGNIFIED:
        return DONE, iteration
    memory[0] = 0.0
    return NEWTON_FAILED, worst
