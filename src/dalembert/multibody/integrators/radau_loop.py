"""The compiled loop of Radau IIA over the steps of a motion: choice of the step, outputs, derivatives."""

from typing import NamedTuple

import numpy as np

from dalembert.multibody.integrators import radau_stages as stages
from dalembert.multibody.integrators.consistent import accelerate
from dalembert.multibody.integrators.ends import append, ends, support
from dalembert.multibody.integrators.lifting import set_signals
from dalembert.multibody.integrators.matrices import renew, room, weigh_masses
from dalembert.multibody.integrators.outputs import record
from dalembert.multibody.integrators.problem import DONE, NEWTON_FAILED, SINGULAR, TOO_MANY_STEPS
from dalembert.multibody.integrators.settling import VELOCITIES, accelerate_roughly, settle, settle_along
from dalembert.multibody.kernels.compiled import compiled, kernel, template
from dalembert.multibody.kernels.linear import storage
from dalembert.multibody.kernels.model import select, workspace
from dalembert.multibody.kernels.motion import Motion, copy, row, still

_AGED = 0.003  # contraction at which the next step begins with new matrices, and outputs have their own
_SHORTEST = 0.2  # of a step: the one after it (Hairer and Wanner 1996, IV.8); what is foreseen may vanish in the time
_NEAR = 1.25  # ratio of a step to the one that the kept systems were factorised for
_FAR = 1.5  # ratio of a step to the one before, from which the latter alone predicts
_HALVINGS = 8  # of a fixed step that Newton's iteration does not converge on
_ENDS = np.int64(4)  # of steps, through which outputs are interpolated


class Settings(NamedTuple):
    """What the compiled loop needs of `RadauIIA`; ``step`` 0: chosen by the error; whether forces may be ``damped``."""

    step: float
    tolerance: float
    newton_tolerance: float
    most_steps: int
    damped: bool


@kernel
def _speed(n, scale, v):
    """Largest velocity against the scales, 1/s."""
    speed = 0.0
    for i in range(n):
        speed = max(speed, abs(v[i]) / scale[i])
    return speed


@compiled
def _first_step(n, scale, span, tolerance, order, state):
    """A step in which coordinates move by a small part of their scales."""
    rate = max(_speed(n, scale, state.v), np.sqrt(_speed(n, scale, state.a)))
    return min(0.1 * span, 0.3 * tolerance ** (1.0 / order) / (rate + 1e-300))


@kernel
def _read(n, s, new):
    """State at the end of a step: its last stage."""
    last = len(s.x) - 1
    for k in range(len(new.x)):
        new.x[k] = s.x[last, k]
        if k < n:
            new.v[k], new.a[k] = s.v[last, k], s.a[last, k]


@template
def _differentiate(
    problem, method, pattern, matrices, directions, h, t, target, within, s, dold, dnews, ds, b, dual_work, dsignals,
):  # fmt: skip
    """Derivatives of a step along all directions."""
    for d in range(len(dnews.x)):
        tilted, dnew = select(directions, d), row(dnews, d)
        copy(dnew, dold)
        stages.listen(method, tilted, t, h, target, within, dual_work, dsignals)
        stages.converge_along(problem, method, pattern, matrices, tilted, dual_work, dsignals, h, s, dold, ds, b)
        _read(problem.n, ds, dnew)


@template
def _settle_end(
    j, problem, pattern, matrices, model, directions, within, last, moved, work, dual_work, lifted,
):  # fmt: skip
    """Settle an end and its derivatives; whether that went well."""
    t, state = last.times[j], row(last.states, j)
    set_signals(model, t, within, work)
    if not settle(problem, pattern, matrices, model, state, moved, work, VELOCITIES):
        return False
    for d in range(len(directions.callbacks)):
        tilted = select(directions, d)
        set_signals(tilted, t, within, dual_work)
        dstate = row(row(last.derivatives, d), j)
        settle_along(problem, pattern, matrices, tilted, state, dstate, moved, dual_work, lifted, VELOCITIES)
    last.settled[j] = True
    return True


@template
def _settle_ends(
    problem, pattern, matrices, apart, far, model, dual, directions, damped, within, last, moved, work, dual_work,
    lifted,
):  # fmt: skip
    """Settle the ends that outputs of the last step need; whether that went well.

    Former ones with matrices ``apart`` of their own places, the newest one, too, where the kept ones are from ``far``.
    """
    newest = len(last.times) - 1
    for j in range(support(last), newest + 1):
        if last.settled[j]:
            continue
        own = matrices
        if far or j < newest:
            own = apart
            if not renew(problem, pattern, own, dual, damped, last.times[j], within, row(last.states, j), dual_work):
                return False
        if not _settle_end(j, problem, pattern, own, model, directions, within, last, moved, work, dual_work, lifted):
            return False
    return True


@kernel
def _attempt(
    problem, method, pattern, matrices, model, dual, settings, t, target, within, before, earlier, stale, made, speed,
    new, s, past, weights, b, work, signals, dual_work, moved,
):  # fmt: skip
    """A step from ``new``, which moves if the step is good; in one kernel, as each call counts references.

    Status, step that the kept systems are for, error against the tolerance, largest velocity, iterations, contraction,
    unknown that moved most.
    """
    n, h = problem.n, target - t
    if before > 0.0:
        stages.go_on(n, h, method, before, earlier if h <= _FAR * before else 0.0, past, s, b, weights)
    else:
        stages.begin(n, h, method, new, s)
    stages.integrate_stages(n, h, method, new, s)
    if stale:
        m = len(method.c) // 2
        middle, place = t + method.c[m] * h, Motion(s.x[m], s.v[m], s.a[m], s.a[m])
        if not renew(problem, pattern, matrices, dual, settings.damped, middle, within, place, dual_work):
            return SINGULAR, made, 0.0, speed, 0, 1.0, 0
    if stale or not (made <= _NEAR * h and h <= _NEAR * made):
        made = h
        if not stages.factorise(n, method, pattern, matrices, h):
            return SINGULAR, made, 0.0, speed, 0, 1.0, 0
    stages.listen(method, model, t, h, target, within, work, signals)
    converged, iterations, rate, worst = stages.converge(
        problem, method, pattern, matrices, model, settings.damped, work, signals, h, new, s, b,
        settings.newton_tolerance, speed, settings.tolerance if settings.step == 0.0 else 0.0,
    )  # fmt: skip
    if not converged:
        return NEWTON_FAILED, made, 0.0, speed, iterations, rate, worst
    error, end = 0.0, len(method.c) - 1
    if settings.step == 0.0:
        speed = max(speed, _speed(n, problem.scale, s.v[end]))
        error = stages.estimate(problem, method, pattern, matrices, settings.damped, h, new, s, b, speed)
        error /= settings.tolerance
    if error <= 1.0:
        _read(n, s, new)
        last = stages.at_stage(work, signals, end)
        accelerate_roughly(problem, pattern, matrices, model, new, last, moved[2:])
    return DONE, made, error, speed, iterations, rate, worst


@compiled
def integrate(problem, method, pattern, edges, settings, model, dual, directions, start, dstates, out, dout, log):
    """Run one sample between ``edges`` (s): status, time reached, and the unknown that moved most.

    ``method`` are the coefficients; ``directions`` is a stack of complex models, one a direction of differentiation.
    ``start`` (N + 1) and its derivatives ``dstates`` (directions, N + 1) are overwritten; ``out`` (times, N + 1) and
    ``dout`` (directions, times, N + 1) are filled at ``problem.times``.
    """
    n, width, adaptive, count = problem.n, len(start.x), settings.step == 0.0, len(method.c)
    order = count + 1.0  # of the estimated error of a step
    new, between, dbetween, dold = still(width), still(width), still(width), still(width)
    copy(start, new)
    last = ends(_ENDS, dstates)
    work, dual_work = workspace(model), workspace(dual)
    signals = np.zeros((count, *work.signals.shape))
    dsignals = np.zeros((count, *work.signals.shape), np.complex128)
    matrices, apart, exact = room(pattern, len(method.pairs)), room(pattern, np.int64(0)), storage(problem.exact_layout)
    s, past, ds = stages.stages(count, width), stages.stages(count, width), stages.stages(count, width)
    b, weights = stages.buffers(count, width), np.zeros((count + 1, 2 * count))
    lifted, moved, shares = (
        np.zeros((10, width), np.complex128),
        np.zeros((6, width)),
        np.zeros((4, len(last.times), 3)),
    )
    due = np.int64(0)  # no literal, for which there would be another compilation
    speed, h, length, taken = 1.0 / (edges[-1] - edges[0]), 0.0, 0.0, 0.0
    for stretch in range(len(edges) - 1):
        t, end = edges[stretch], edges[stretch + 1]
        within = 0.5 * (t + end)
        if not accelerate(problem, model, dual, directions, t, within, new, dstates, work, dual_work, lifted, exact):
            return SINGULAR, t, 0
        if stretch == 0:
            weigh_masses(pattern, matrices, dual, n, new, dual_work)
            weigh_masses(pattern, apart, dual, n, new, dual_work)
            length = _first_step(n, problem.scale, end - t, settings.tolerance, order, new)
        steps = 1 if adaptive else max(1, int(np.ceil((end - t) / settings.step - 1e-6)))
        begin, nominal, number, level = t, (end - t) / steps, 0, 0
        far = False
        stale, fresh, made, before, earlier, former = True, True, 0.0, 0.0, 0.0, 0.0
        last.known[0] = 0
        append(t, new, dstates, stretch == 0, last)
        while True:
            ready = False
            while due < len(problem.times) and problem.times[due] <= t + 1e-9 * taken:
                ready = ready or _settle_ends(
                    problem, pattern, matrices, apart, far, model, dual, directions, settings.damped, within, last,
                    moved, work, dual_work, lifted,
                )  # fmt: skip
                if not ready or not record(
                    problem, pattern, apart if far else matrices, far, model, dual, directions, last, within, out,
                    dout, due, between, dbetween, shares, moved, work, dual_work, lifted,
                ):  # fmt: skip
                    return NEWTON_FAILED, problem.times[due], 0
                due += 1
            if number == steps:
                break
            goal = end if number == steps - 1 else begin + nominal * (number + 1)
            if not adaptive:
                length = (goal - t) / (1 << level)
            reached = (level == 0 and not adaptive) or t + length * 1.0001 >= goal
            target = goal if reached else t + length
            h = target - t
            status, made, error, own, iterations, rate, worst = _attempt(
                problem, method, pattern, matrices, model, dual, settings, t, target, within, before, earlier, stale,
                made, speed, new, s, past, weights, b, work, signals, dual_work, moved,
            )  # fmt: skip
            log.counts[1] += iterations
            if status == SINGULAR:
                return SINGULAR, t, 0
            log.counts[2] += 1 if made == h else 0
            fresh, stale = fresh or stale, False
            converged = status == DONE
            if not converged or not error <= 1.0:
                log.counts[3] += 1
                earlier = 0.0
                stages.go_back(past, s)
                stale = not converged  # so that matrices are not those of a place that the step does not reach
                if stale and not fresh:  # once more, as long
                    continue
                if adaptive:
                    shorter = max(0.1, 0.9 * error ** (-1.0 / order)) if converged and error < 1e100 else 0.25
                    length = h * shorter
                    if length < 1e-12 * (end - begin):
                        return NEWTON_FAILED, t, worst
                elif level == _HALVINGS:
                    return NEWTON_FAILED, t, worst
                else:
                    level += 1
                continue
            _differentiate(
                problem, method, pattern, matrices, directions, h, t, target, within, s, dold, dstates, ds, b,
                dual_work, dsignals,
            )  # fmt: skip
            append(target, new, dstates, False, last)
            speed, before, earlier, taken = own, h, before, h
            if log.counts[0] < len(log.iterations):
                log.iterations[log.counts[0]] = iterations
                log.ends[log.counts[0]] = target
            log.counts[0] += 1
            t = target
            number += 1 if reached else 0
            level -= 1 if level > 0 else 0
            fresh, stale, far = False, rate > _AGED, rate > _AGED
            if adaptive:
                if log.counts[0] >= settings.most_steps and not reached:
                    return TOO_MANY_STEPS, t, 0
                error = max(error, 1e-30)
                length = h * min(3.0, 0.9 * error ** (-1.0 / order))
                if former > 0.0:
                    foreseen = 0.9 * h * (h / earlier) * (former / (error * error)) ** (1.0 / order)
                    length = min(length, max(foreseen, _SHORTEST * h))
                former = max(error, 1e-2)
    copy(new, start)
    return DONE, edges[-1], 0
