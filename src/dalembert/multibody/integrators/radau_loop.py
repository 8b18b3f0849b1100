"""The compiled loop of Radau IIA over the steps of a motion: choice of the step, outputs, derivatives."""

from typing import NamedTuple

import numpy as np

from dalembert.multibody.integrators import radau_stages as stages
from dalembert.multibody.integrators.consistent import accelerate
from dalembert.multibody.integrators.lifting import set_signals
from dalembert.multibody.integrators.matrices import renew, room, weigh_masses
from dalembert.multibody.integrators.outputs import record
from dalembert.multibody.integrators.problem import DONE, NEWTON_FAILED, SINGULAR, TOO_MANY_STEPS
from dalembert.multibody.integrators.settling import VELOCITIES, accelerate_roughly, settle, settle_along
from dalembert.multibody.kernels.compiled import compiled, kernel
from dalembert.multibody.kernels.linear import storage
from dalembert.multibody.kernels.model import select, workspace
from dalembert.multibody.kernels.motion import Motion, copy, row, still

_AGED = 0.003  # contraction at which the next step begins with new matrices
_NEAR = 1.25  # ratio of a step to the one that the kept systems were factorised for
_FAR = 1.5  # ratio of a step to the one before, from which the latter alone predicts
_HALVINGS = 8  # of a fixed step that Newton's iteration does not converge on


class Settings(NamedTuple):
    """What the compiled loop needs of `Radau5`; ``step`` 0: chosen by the error; whether forces may be ``damped``."""

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
def _first_step(n, scale, span, tolerance, state):
    """A step in which coordinates move by a small part of their scales."""
    rate = max(_speed(n, scale, state.v), np.sqrt(_speed(n, scale, state.a)))
    return min(0.1 * span, 0.3 * tolerance**0.25 / (rate + 1e-300))


@kernel
def _read(n, s, new):
    """State at the end of a step: its last stage."""
    for k in range(len(new.x)):
        new.x[k] = s.x[2, k]
        if k < n:
            new.v[k], new.a[k] = s.v[2, k], s.a[2, k]


@compiled
def _differentiate(
    problem, pattern, matrices, directions, h, t, target, within, s, dolds, dnews, ds, b, dual_works
):  # fmt: skip
    """Derivatives of a step along all directions."""
    for d in range(len(dnews.x)):
        tilted, dold, dnew = select(directions, d), row(dolds, d), row(dnews, d)
        copy(dnew, dold)
        for i in range(3):
            set_signals(tilted, target if i == 2 else t + stages.C[i] * h, within, dual_works[i])
        stages.converge_along(problem, pattern, matrices, tilted, dual_works, h, s, dold, ds, b)
        _read(problem.n, ds, dnew)


@compiled
def _settle_all(
    problem, pattern, matrices, model, directions, t, within, state, dstates, moved, work, dual_work, lifted,
):  # fmt: skip
    """Settle a state and its derivatives; whether that went well."""
    set_signals(model, t, within, work)
    if not settle(problem, pattern, matrices, model, state, moved, work, VELOCITIES):
        return False
    for d in range(len(dstates.x)):
        tilted = select(directions, d)
        set_signals(tilted, t, within, dual_work)
        settle_along(problem, pattern, matrices, tilted, state, row(dstates, d), moved, dual_work, lifted, VELOCITIES)
    return True


@kernel
def _copy_all(source, dsource, target, dtarget):
    """Copy a state and its derivatives."""
    copy(source, target)
    for d in range(len(dsource.x)):
        for i in range(dsource.x.shape[1]):
            dtarget.x[d, i], dtarget.v[d, i], dtarget.a[d, i] = dsource.x[d, i], dsource.v[d, i], dsource.a[d, i]


@kernel
def _attempt(
    problem, pattern, matrices, model, dual, settings, t, target, within, before, earlier, stale, made, speed, old, new,
    s, past, weights, b, works, dual_work, moved,
):  # fmt: skip
    """A step from ``new``, which becomes ``old`` if the step is good; in one kernel, as each call counts references.

    Status, step that the kept systems are for, error against the tolerance, largest velocity, iterations, contraction,
    unknown that moved most.
    """
    n, h = problem.n, target - t
    if before > 0.0:
        stages.go_on(n, h, before, earlier if h <= _FAR * before else 0.0, past, s, weights)
    else:
        stages.begin(n, h, new, s)
    stages.integrate_stages(n, h, new, s)
    if stale:
        middle, place = t + stages.C[1] * h, Motion(s.x[1], s.v[1], s.a[1], s.a[1])
        if not renew(problem, pattern, matrices, dual, settings.damped, middle, within, place, dual_work):
            return SINGULAR, made, 0.0, speed, 0, 1.0, 0
    if stale or not (made <= _NEAR * h and h <= _NEAR * made):
        made = h
        if not stages.factorise(n, pattern, matrices, h):
            return SINGULAR, made, 0.0, speed, 0, 1.0, 0
    for i in range(3):
        set_signals(model, target if i == 2 else t + stages.C[i] * h, within, works[i])
    converged, iterations, rate, worst = stages.converge(
        problem, pattern, matrices, model, works, h, new, s, b, settings.newton_tolerance, h * speed
    )
    if not converged:
        return NEWTON_FAILED, made, 0.0, speed, iterations, rate, worst
    error = 0.0
    if settings.step == 0.0:
        speed = max(speed, _speed(n, problem.scale, s.v[2]))
        error = stages.estimate(problem, pattern, matrices, settings.damped, h, new, s, b, speed) / settings.tolerance
    if error <= 1.0:
        copy(new, old)
        _read(n, s, new)
        accelerate_roughly(problem, pattern, matrices, model, new, works[2], moved[2:])
    return DONE, made, error, speed, iterations, rate, worst


@compiled
def integrate(problem, pattern, edges, settings, model, dual, directions, start, dstates, out, dout, log):
    """Run one sample between ``edges`` (s): status, time reached, and the unknown that moved most.

    ``directions`` is a stack of complex models, one a direction of differentiation. ``start`` (N + 1) and its
    derivatives ``dstates`` (directions, N + 1) are overwritten; ``out`` (times, N + 1) and ``dout`` (directions, times,
    N + 1) are filled at ``problem.times``.
    """
    n, width, adaptive = problem.n, len(start.x), settings.step == 0.0
    old, new, between, dbetween = still(width), still(width), still(width), still(width)
    first, last = still(width), still(width)  # the same where there are outputs, settled
    copy(start, new)
    dolds, dfirst, dlast = stages.copies(dstates), stages.copies(dstates), stages.copies(dstates)
    works = workspace(model), workspace(model), workspace(model)
    dual_works = workspace(dual), workspace(dual), workspace(dual)
    matrices, exact = room(pattern), storage(problem.exact_layout)
    s, past, ds, b = stages.stages(width), stages.stages(width), stages.stages(width), stages.buffers(width)
    lifted, moved, weights = np.zeros((10, width), np.complex128), np.zeros((6, width)), np.zeros((4, 6))
    due = np.int64(0)  # no literal, for which there would be another compilation
    speed, h, length, taken = 1.0 / (edges[-1] - edges[0]), 0.0, 0.0, 0.0
    for stretch in range(len(edges) - 1):
        t, end = edges[stretch], edges[stretch + 1]
        within = 0.5 * (t + end)
        if not accelerate(
            problem, model, dual, directions, t, within, new, dstates, False, works[0], dual_works[0], lifted, exact
        ):
            return SINGULAR, t, 0
        if stretch == 0:
            weigh_masses(pattern, matrices, dual, n, new, dual_works[0])
            length = _first_step(n, problem.scale, end - t, settings.tolerance, new)
        steps = 1 if adaptive else max(1, int(np.ceil((end - t) / settings.step - 1e-6)))
        begin, nominal, number, level = t, (end - t) / steps, 0, 0
        stale, fresh, made, before, earlier = True, True, 0.0, 0.0, 0.0
        settled, ready = False, False  # both ends of the last step; the end of the one before it
        while True:
            while due < len(problem.times) and problem.times[due] <= t + 1e-9 * taken:
                if not settled:  # seldom: most steps have no output
                    if ready or taken == 0.0:
                        _copy_all(last, dlast, first, dfirst)
                    else:
                        _copy_all(old, dolds, first, dfirst)
                    _copy_all(new, dstates, last, dlast)
                    settled = taken == 0.0 or (
                        (
                            ready
                            or _settle_all(
                                problem, pattern, matrices, model, directions, t - taken, within, first, dfirst, moved,
                                works[0], dual_works[0], lifted,
                            )
                        )
                        and _settle_all(
                            problem, pattern, matrices, model, directions, t, within, last, dlast, moved, works[0],
                            dual_works[0], lifted,
                        )
                    )  # fmt: skip
                if not settled or not record(
                    problem, pattern, matrices, model, directions, taken, t - taken, within, first, last, dfirst,
                    dlast, out, dout, due, between, dbetween, moved, works[0], dual_works[0], lifted,
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
                problem, pattern, matrices, model, dual, settings, t, target, within, before, earlier, stale, made,
                speed, old, new, s, past, weights, b, works, dual_works[0], moved,
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
                    length = h * (max(0.1, 0.9 * error**-0.25) if converged and error < 1e100 else 0.25)
                    if length < 1e-12 * (end - begin):
                        return NEWTON_FAILED, t, worst
                elif level == _HALVINGS:
                    return NEWTON_FAILED, t, worst
                else:
                    level += 1
                continue
            _differentiate(
                problem, pattern, matrices, directions, h, t, target, within, s, dolds, dstates, ds, b, dual_works
            )
            speed, before, earlier, taken = own, h, before, h
            ready, settled = settled, False
            if log.counts[0] < len(log.iterations):
                log.iterations[log.counts[0]] = iterations
                log.ends[log.counts[0]] = target
            log.counts[0] += 1
            t = target
            number += 1 if reached else 0
            level -= 1 if level > 0 else 0
            fresh, stale = False, rate > _AGED
            if adaptive:
                if log.counts[0] >= settings.most_steps and not reached:
                    return TOO_MANY_STEPS, t, 0
                length = h * min(3.0, 0.9 * (error + 1e-30) ** -0.25)
    copy(new, start)
    return DONE, edges[-1], 0
