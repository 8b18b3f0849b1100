"""Generalized-alpha for the index-3 equations, with the derivatives of its discrete solution."""

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from dalembert.errors import InputError, unknown
from dalembert.multibody.kernels import signals
from dalembert.multibody.kernels.assembly import constraint_rates, residual, tangent
from dalembert.multibody.kernels.compiled import compiled, kernel
from dalembert.multibody.kernels.dual import STEP
from dalembert.multibody.kernels.linear import factorise, solve, storage
from dalembert.multibody.kernels.model import select, workspace
from dalembert.multibody.kernels.motion import Motion, advance, clear, coefficients, copy, interpolate, row, still

STARTS = ("consistent", "zero")
DONE, NEWTON_FAILED, SINGULAR, TOO_MANY_STEPS = range(4)
_MOST_ITERATIONS = 12
_SLOW = 0.3  # contraction at which an iteration is not worth going on with the kept factorisation
_AGED = 0.02  # contraction at which the next step begins with a new one
_HALVINGS = 8  # of a fixed step that Newton does not converge on
_UNITS = 1 << _HALVINGS
# Relative corrections that stop to shrink are rounding below the first size, and below the second one if a nearly
# singular position magnifies it.
_ROUNDING, _MAGNIFIED = 1e-12, 1e-9
_NOISE = 1e-13  # below this size the ratio of two corrections says nothing of the factorisation


@dataclass(frozen=True)
class GeneralizedAlpha:
    """Generalized-alpha integrator for index 3 (Arnold and Bruels 2007), of second order.

    Parameters
    ----------
    step : float
        Step in s; the first one when ``adaptive``.
    spectral_radius : float
        At infinity, in [0, 1]: 1 damps nothing, 0 damps the highest frequencies in one step. At 1 the index-3 method
        would keep an error of the multipliers for ever, with alternating sign; there velocities and accelerations are
        projected on the constraints after each step, which doubles its price.
    initial_acceleration : {"consistent", "zero"}
        Accelerations and multipliers at the start: those that satisfy the equations of motion, or none (a start of
        first order).
    adaptive : bool
        Choose the step by the estimated local error.
    tolerance : float
        Of the local error, relative to each coordinate's scale; for ``adaptive``.
    newton_tolerance : float
        Of the coordinates at each step, relative to their scale. An error of a coordinate is 2 / step times as large in
        the velocity and adds up over the steps; so the default is rounding.
    most_steps : int
        After which an adaptive run gives up.

    Examples
    --------
    >>> GeneralizedAlpha(step=1e-3).spectral_radius
    0.8
    """

    step: float = field(metadata={"unit": "s"})
    spectral_radius: float = field(default=0.8, metadata={"unit": ""})
    initial_acceleration: str = "consistent"
    adaptive: bool = False
    tolerance: float = field(default=1e-6, metadata={"unit": ""})
    newton_tolerance: float = field(default=2e-15, metadata={"unit": ""})
    most_steps: int = 10_000_000

    def __post_init__(self) -> None:
        if not (np.isfinite(self.step) and self.step > 0):
            raise InputError(f"GeneralizedAlpha: step is {self.step}; expected a positive number of seconds")
        if not 0 <= self.spectral_radius <= 1:
            raise InputError(
                f"GeneralizedAlpha: spectral_radius is {self.spectral_radius}; expected a number in [0, 1]"
            )
        if self.initial_acceleration not in STARTS:
            raise InputError(unknown("initial_acceleration", self.initial_acceleration, STARTS, "GeneralizedAlpha"))
        for name in ("tolerance", "newton_tolerance"):
            if not getattr(self, name) > 0:
                raise InputError(f"GeneralizedAlpha: {name} is {getattr(self, name)}; expected a positive number")


class Settings(NamedTuple):
    """What the compiled loop needs of `GeneralizedAlpha`."""

    step: float
    spectral_radius: float
    consistent: bool
    adaptive: bool
    tolerance: float
    newton_tolerance: float
    most_steps: int


class Problem(NamedTuple):
    """What does not change from sample to sample: sizes, scales, where matrix entries go, LAPACK, times.

    ``n`` coordinates; ``scale`` (N + 1,); ``slots`` and ``layout`` of the Newton matrix; those of the sensitivities,
    whose matrix is renewed at each step; ``times`` of the output. ``edges`` (samples, -) of the smooth stretches of
    motion, and how many ``stretches`` each sample has.
    """

    n: int
    scale: np.ndarray
    slots: tuple
    layout: tuple
    exact_slots: tuple
    exact_layout: tuple
    lapack: np.ndarray
    times: np.ndarray
    edges: np.ndarray
    stretches: np.ndarray


class Log(NamedTuple):
    """Of one run: steps, Newton iterations, factorisations, rejected steps; iterations a step while room lasts."""

    counts: np.ndarray
    iterations: np.ndarray
    ends: np.ndarray


class _Newton(NamedTuple):
    """Work of the Newton iteration.

    ``memory``: step for which the kept factorisation was made (0: none), contraction seen last. ``slope``: rate of
    change of accelerations and multipliers over the last step, for the prediction of the next one.
    """

    factors: tuple
    work: tuple
    dual_work: tuple
    r: np.ndarray
    delta: np.ndarray
    memory: np.ndarray
    slope: np.ndarray


@compiled
def _signals(model, t, within, work):
    signals.evaluate(
        model.signals.index, model.signals.data, model.signals.knots, model.callbacks, t, within, work.signals
    )


@kernel
def _lift(n, state, direction, target):
    """Complex state: the real one plus the imaginary step along a direction."""
    for i in range(len(state.x)):
        target[0, i] = complex(state.x[i], STEP * direction.x[i])
    for i in range(n):
        target[1, i] = complex(state.v[i], STEP * direction.v[i])
        target[2, i] = complex(state.a[i], STEP * direction.a[i])


@kernel
def _renew(problem, dual, c, new, newton):
    tangent(
        dual, problem.slots, problem.n, new.x, new.v, new.a, (c.dq, c.dv, 1.0), (1.0, 1.0 / c.dq), newton.dual_work,
        newton.factors.matrix,
    )  # fmt: skip
    newton.memory[0] = c.step if factorise(problem.layout, problem.lapack, newton.factors) else 0.0
    return newton.memory[0] != 0.0


@kernel
def _predict(n, c, old, slope, new):
    """Accelerations and multipliers of the new state, by those of the old one and their last change."""
    for i in range(n):
        new.a[i] = old.a[i] + c.step * slope[i]
    for i in range(n, len(old.x) - 1):
        new.x[i] = old.x[i] + c.step * slope[i]
    advance(n, c, old, new)


@kernel
def _learn(n, c, old, new, slope):
    """Change of accelerations and multipliers over a step."""
    for i in range(n):
        slope[i] = (new.a[i] - old.a[i]) / c.step
    for i in range(n, len(old.x) - 1):
        slope[i] = (new.x[i] - old.x[i]) / c.step


@kernel
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


@kernel
def _converge(problem, model, dual, c, tolerance, old, new, newton, log):
    """Newton iteration on new accelerations and multipliers: status, and iterations or the unknown that moved most."""
    n, memory = problem.n, newton.memory
    _predict(n, c, old, newton.slope, new)
    fresh = not (0.8 * memory[0] < c.step < 1.25 * memory[0]) or memory[1] > _AGED
    if fresh:
        log.counts[2] += 1
        if not _renew(problem, dual, c, new, newton):
            return SINGULAR, 0
        memory[1] = _AGED
    before, norm, worst = 0.0, 1.0, 0
    for iteration in range(1, _MOST_ITERATIONS + 1):
        residual(model, n, new.x, new.v, new.a, newton.work, 1.0 / c.dq, newton.r)
        solve(problem.layout, problem.lapack, newton.factors, newton.r, newton.delta)
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
            if not _renew(problem, dual, c, new, newton):
                return SINGULAR, worst
            fresh = True
        before = norm
    if norm <= _MAGNIFIED:
        return DONE, iteration
    memory[0] = 0.0
    return NEWTON_FAILED, worst


@kernel
def _subtract(n, correction, state):
    """Take a correction off the accelerations and multipliers, which are also the algorithmic accelerations."""
    for i in range(n):
        state.a[i] -= correction[i]
        state.w[i] = state.a[i]
    for i in range(n, len(state.x) - 1):
        state.x[i] -= correction[i]


@compiled
def _differentiate(problem, dual, directions, c, t, within, old, new, dolds, dnews, exact, dual_work, lifted, buffers):
    """Derivatives of the converged step: one exact tangent, and one linear solution a direction."""
    n, size = problem.n, len(old.x) - 1
    r, delta, answer = buffers
    tangent(
        dual, problem.exact_slots, n, new.x, new.v, new.a, (c.dq, c.dv, 1.0), (1.0, 1.0 / c.dq), dual_work, exact.matrix
    )
    regular = factorise(problem.exact_layout, problem.lapack, exact)
    for d in range(len(dolds.x)):
        model = select(directions, d)
        dold, dnew = row(dolds, d), row(dnews, d)
        copy(dnew, dold)
        advance(n, c, dold, dnew)
        _lift(n, new, dnew, lifted)
        _signals(model, t, within, dual_work)
        residual(model, n, lifted[0], lifted[1], lifted[2], dual_work, 1.0 / c.dq, r)
        for i in range(size):
            delta[i] = r[i].imag / STEP
        solve(problem.exact_layout, problem.lapack, exact, delta, answer)
        _subtract(n, answer, dnew)
        advance(n, c, dold, dnew)
    return regular


@kernel
def _initial_matrix(problem, dual, state, dual_work, constraints, exact):
    """Factorised matrix of motion beside the constraints at acceleration level; whether it is regular."""
    arguments = (dual, problem.exact_slots, problem.n, state.x, state.v, state.a)
    tangent(*arguments, (1.0, 0.0, 0.0), (0.0, 1.0), dual_work, constraints)
    tangent(*arguments, (0.0, 0.0, 1.0), (1.0, 0.0), dual_work, exact.matrix)
    for i in range(len(constraints)):
        exact.matrix[i] += constraints[i]
    return factorise(problem.exact_layout, problem.lapack, exact)


@compiled
def _accelerate(problem, model, dual, directions, t, within, state, dstates, projected, work, dual_work, lifted, exact):
    """Accelerations and multipliers that satisfy the equations of motion, and their derivatives.

    Where ``projected``, the velocities are first moved onto the constraints, by the smallest kinetic energy.
    """
    n, last = problem.n, len(state.x) - 1
    delta, answer, rate, second = np.zeros(last + 1), np.zeros(last + 1), np.zeros(last + 1), np.zeros(last + 1)
    constraints = np.zeros(len(exact.matrix))
    _signals(model, t, within, work)
    _signals(dual, t, within, dual_work)
    for iteration in range(6):  # linear but for friction that depends on the multipliers
        # The last correction is rounding: the derivatives below are taken with the matrix of the state that it leaves.
        if iteration < 5 and not _initial_matrix(problem, dual, state, dual_work, constraints, exact):
            return False
        if iteration == 0 and projected:
            _project(problem, model, directions, t, within, state, dstates, work, dual_work, lifted, exact)
        residual(model, n, state.x, state.v, state.a, work, 1.0, delta)
        constraint_rates(model, n, state.x, state.v, state.a, work, rate, second)
        for i in range(n, last):
            delta[i] = second[i]
        solve(problem.exact_layout, problem.lapack, exact, delta, answer)
        _subtract(n, answer, state)
    r, drate, dsecond = lifted[3], lifted[4], lifted[5]
    for d in range(len(dstates.x)):
        tilted, dstate = select(directions, d), row(dstates, d)
        _signals(tilted, t, within, dual_work)
        _lift(n, state, dstate, lifted)
        residual(tilted, n, lifted[0], lifted[1], lifted[2], dual_work, 1.0, r)
        constraint_rates(tilted, n, lifted[0], lifted[1], lifted[2], dual_work, drate, dsecond)
        for i in range(last):
            delta[i] = (r[i].imag if i < n else dsecond[i].imag) / STEP
        solve(problem.exact_layout, problem.lapack, exact, delta, answer)
        _subtract(n, answer, dstate)
    return True


@compiled
def _project(problem, model, directions, t, within, state, dstates, work, dual_work, lifted, exact):
    """Velocities on the constraints, v - w with M w + J^T m = 0 and J w = rate of the constraints, and derivatives."""
    n, last = problem.n, len(state.x) - 1
    w, answer, rate, second = np.zeros(last + 1), np.zeros(last + 1), np.zeros(last + 1), np.zeros(last + 1)
    constraint_rates(model, n, state.x, state.v, state.a, work, rate, second)
    solve(problem.exact_layout, problem.lapack, exact, rate, w)
    for i in range(n):
        state.v[i] -= w[i]
    forces, still, drate, dsecond = lifted[3], lifted[4], lifted[5], lifted[6]
    for d in range(len(dstates.x)):
        tilted, dstate = select(directions, d), row(dstates, d)
        _signals(tilted, t, within, dual_work)
        _lift(n, state, dstate, lifted)
        constraint_rates(tilted, n, lifted[0], lifted[1], lifted[2], dual_work, drate, dsecond)
        for i in range(last + 1):
            lifted[1, i] = 0.0
            lifted[2, i] = w[i] if i < n else 0.0
            if i >= n:
                lifted[0, i] = w[i]
        residual(tilted, n, lifted[0], lifted[1], lifted[2], dual_work, 1.0, forces)
        for i in range(last + 1):
            lifted[2, i] = 0.0
            if i >= n:
                lifted[0, i] = 0.0
        residual(tilted, n, lifted[0], lifted[1], lifted[2], dual_work, 1.0, still)
        for i in range(last):
            answer[i] = (forces[i].imag - still[i].imag if i < n else -drate[i].imag) / STEP
        solve(problem.exact_layout, problem.lapack, exact, answer, rate)
        for i in range(n):
            dstate.v[i] += rate[i]


@compiled
def integrate(problem, settings, models, duals, directions, states, dstates, out, dout, log, ends):
    """Run a stack of samples from ``problem.edges[sample, 0]`` to the last edge; fill the states at the output times.

    Parameters
    ----------
    problem, settings : Problem, Settings
    models, duals : Model
        Stacks in real and in complex numbers, one a sample.
    directions : Model
        Stack of complex models, one a direction of differentiation; empty if there is more than one sample.
    states : Motion
        At the start, (samples, N + 1); overwritten.
    dstates : Motion
        Derivatives at the start, (directions, N + 1); overwritten.
    out, dout : Motion
        Arrays (samples, times, N + 1) and (directions, times, N + 1); ``w`` is not used.
    log : Log
        Of the last sample.
    ends : array, shape (samples, 3)
        Status (`DONE`, or the reason), time reached, unknown that moved most.
    """
    for sample in range(len(states.x)):
        clear(log.counts)
        ends[sample, 0], ends[sample, 1], ends[sample, 2] = _integrate(
            problem, problem.edges[sample, : problem.stretches[sample] + 1], settings, select(models, sample),
            select(duals, sample), directions, row(states, sample), dstates, row(out, sample), dout, log,
        )  # fmt: skip


@compiled
def _integrate(problem, edges, settings, model, dual, directions, state, dstates, out, dout, log):
    """Run one sample: status, time reached, and the unknown that moved most."""
    n, width = problem.n, len(state.x)
    old, new = still(width), still(width)
    copy(state, new)
    dolds = Motion(
        np.zeros_like(dstates.x), np.zeros_like(dstates.x), np.zeros_like(dstates.x), np.zeros_like(dstates.x)
    )
    work, dual_work = workspace(model), workspace(dual)
    newton = _Newton(
        storage(problem.layout), work, dual_work, np.zeros(width), np.zeros(width), np.zeros(2), np.zeros(width)
    )
    exact = storage(problem.exact_layout)
    lifted = np.zeros((7, width), np.complex128)
    buffers = lifted[3], np.zeros(width), np.zeros(width)
    differentiated = len(dstates.x) > 0
    due = 0
    length = settings.step
    for stretch in range(len(edges) - 1):
        begin, end = edges[stretch], edges[stretch + 1]
        within = 0.5 * (begin + end)
        clear(newton.slope)
        if stretch > 0 or settings.consistent:
            if not _accelerate(
                problem, model, dual, directions, begin, within, new, dstates, False, work, dual_work, lifted, exact
            ):
                return SINGULAR, begin, 0
        if stretch == 0:
            while due < len(problem.times) and problem.times[due] <= begin:
                _record(n, 1.0, 1.0, new, new, dstates, dstates, out, dout, due)
                due += 1
        steps = max(1, int(np.ceil((end - begin) / settings.step - 1e-6)))
        nominal = (end - begin) / steps
        unit, level = 0, 0
        t = begin
        if not settings.adaptive:
            length = nominal
        while (settings.adaptive and t < end) or (not settings.adaptive and unit < steps * _UNITS):
            if settings.adaptive:
                if t + length * 1.0001 >= end:
                    length = end - t
                target = t + length if length < end - t else end
            else:
                stride = _UNITS >> level
                length = nominal / (1 << level)
                target = end if unit + stride == steps * _UNITS else begin + nominal * ((unit + stride) / _UNITS)
            copy(new, old)
            c = coefficients(length, settings.spectral_radius)
            _signals(model, target, within, work)
            _signals(dual, target, within, dual_work)
            status, detail = _converge(problem, model, dual, c, settings.newton_tolerance, old, new, newton, log)
            error = 0.0
            if status == DONE and settings.adaptive:
                for i in range(n):
                    gap = abs(c.beta - 1 / 6) * length * length * abs(new.w[i] - old.w[i])
                    error = max(error, gap / (settings.tolerance * problem.scale[i]))
            if status != DONE or error > 1.0:
                log.counts[3] += 1
                copy(old, new)
                clear(newton.slope)
                if settings.adaptive:
                    length *= max(0.2, 0.9 * error ** (-1 / 3)) if status == DONE else 0.25
                    if length < 1e-12 * (end - begin):
                        return NEWTON_FAILED, t, detail
                elif level == _HALVINGS:
                    return status, t, detail
                else:
                    level += 1
                continue
            if log.counts[0] < len(log.iterations):
                log.iterations[log.counts[0]] = detail
                log.ends[log.counts[0]] = target
            log.counts[0] += 1
            _learn(n, c, old, new, newton.slope)
            if differentiated:
                _differentiate(
                    problem, dual, directions, c, target, within, old, new, dolds, dstates, exact, dual_work, lifted,
                    buffers,
                )  # fmt: skip
            if settings.spectral_radius == 1.0 and width - 1 > n:
                if not _accelerate(
                    problem, model, dual, directions, target, within, new, dstates, True, work, dual_work, lifted, exact
                ):
                    return SINGULAR, target, 0
            while due < len(problem.times) and problem.times[due] <= target + 1e-9 * length:
                share = min(1.0, (problem.times[due] - t) / length)
                _record(n, length, share, old, new, dolds, dstates, out, dout, due)
                due += 1
            t = target
            if settings.adaptive:
                if log.counts[0] >= settings.most_steps:
                    return TOO_MANY_STEPS, t, 0
                growth = min(2.0, 0.9 * (error + 1e-30) ** (-1 / 3))
                if growth < 1.0 or growth > 1.2:
                    length *= growth
            else:
                unit += stride
                if level > 0 and unit % (2 * stride) == 0:
                    level -= 1
    copy(new, state)
    return DONE, edges[-1], 0


@compiled
def _record(n, length, share, old, new, dolds, dnews, out, dout, due):
    """Write the states at an output time."""
    interpolate(n, length, share, old, new, out.x[due], out.v[due], out.a[due])
    for d in range(len(dnews.x)):
        interpolate(n, length, share, row(dolds, d), row(dnews, d), dout.x[d, due], dout.v[d, due], dout.a[d, due])
