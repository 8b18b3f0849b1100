"""The compiled loop of Radau IIA over the steps of a motion: choice of the step, outputs, derivatives."""

from typing import NamedTuple

import numpy as np

from dalembert.multibody.integrators import radau_stages as stages
from dalembert.multibody.integrators.consistent import accelerate
from dalembert.multibody.integrators.lifting import set_signals
from dalembert.multibody.integrators.matrices import renew, room, weigh_masses
from dalembert.multibody.integrators.outputs import record
from dalembert.multibody.integrators.problem import DONE, NEWTON_FAILED, SINGULAR, TOO_MANY_STEPS
from dalembert.multibody.integrators.settling import VELOCITIES, settle, settle_along
from dalembert.multibody.kernels.compiled import compiled, kernel
from dalembert.multibody.kernels.linear import storage
from dalembert.multibody.kernels.model import select, workspace
from dalembert.multibody.kernels.motion import copy, row, still

_AGED = 0.02  # contraction at which the next step begins with new matrices
_SLOW = 0.2  # contraction that was not worth a kept factorisation
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


@compiled
def _read(n, s, start, new):
    """State at the end of a step: its last stage."""
    for k in range(len(new.x)):
        new.x[k] = s.x[2, k]
        if k < n:
            new.v[k], new.a[k] = s.v[2, k], s.a[2, k]


@compiled
def _differentiate(
    problem, pattern, matrices, directions, h, t, target, within, s, new, moved, dolds, dnews, ds, b, dual_works, lifted
):
    """Derivatives of a step along all directions."""
    n = problem.n
    for d in range(len(dnews.x)):
        tilted, dold, dnew = select(directions, d), row(dolds, d), row(dnews, d)
        copy(dnew, dold)
        for i in range(3):
            set_signals(tilted, target if i == 2 else t + stages.C[i] * h, within, dual_works[i])
        stages.converge_along(problem, pattern, matrices, tilted, dual_works, h, s, dold, ds, b)
        _read(n, ds, dold, dnew)
        settle_along(problem, pattern, matrices, tilted, new, dnew, moved, dual_works[2], lifted, VELOCITIES)


@compiled
def integrate(problem, pattern, edges, settings, model, dual, directions, start, dstates, out, dout, log):
    """Run one sample between ``edges`` (s): status, time reached, and the unknown that moved most.

    ``directions`` is a stack of complex models, one a direction of differentiation. ``start`` (N + 1) and its
    derivatives ``dstates`` (directions, N + 1) are overwritten; ``out`` (times, N + 1) and ``dout`` (directions, times,
    N + 1) are filled at ``problem.times``.
    """
    n, width, adaptive = problem.n, len(start.x), settings.step == 0.0
    old, new, between, dbetween = still(width), still(width), still(width), still(width)
    copy(start, new)
    dolds = stages.copies(dstates)
    works = workspace(model), workspace(model), workspace(model)
    dual_works = workspace(dual), workspace(dual), workspace(dual)
    matrices, exact = room(pattern), storage(problem.exact_layout)
    s, ds, b = stages.stages(width), stages.stages(width), stages.buffers(width)
    lifted, moved = np.zeros((10, width), np.complex128), np.zeros((2, width))
    due = np.int64(0)  # no literal, for which there would be another compilation
    speed, h, length = 1.0 / (edges[-1] - edges[0]), 0.0, 0.0
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
        stale, fresh, made, before = True, True, 0.0, 0.0
        while True:
            while due < len(problem.times) and problem.times[due] <= t + 1e-9 * h:
                written = record(
                    problem, pattern, matrices, model, directions, h, t - h, within, old, new, dolds, dstates, out,
                    dout, due, between, dbetween, moved, works[0], dual_works[0], lifted,
                )  # fmt: skip
                if not written:
                    return NEWTON_FAILED, problem.times[due], 0
                due += 1
            if number == steps:
                break
            if stale:
                if not renew(problem, pattern, matrices, dual, settings.damped, t, within, new, dual_works[0]):
                    return SINGULAR, t, 0
                stale, fresh, made = False, True, 0.0
            goal = end if number == steps - 1 else begin + nominal * (number + 1)
            if not adaptive:
                length = (goal - t) / (1 << level)
            reached = (level == 0 and not adaptive) or t + length * 1.0001 >= goal
            target = goal if reached else t + length
            h = target - t
            if not abs(h - made) <= 1e-10 * h:
                log.counts[2] += 1
                made = h
                if not stages.factorise(n, pattern, matrices, h):
                    return SINGULAR, t, 0
            for i in range(3):
                set_signals(model, target if i == 2 else t + stages.C[i] * h, within, works[i])
            if before > 0.0:
                stages.go_on(n, h, before, old, s)
            else:
                stages.begin(n, h, new, s)
            converged, iterations, rate, worst = stages.converge(
                problem, pattern, matrices, model, works, h, new, s, b, settings.newton_tolerance, h * speed
            )
            log.counts[1] += iterations
            error, own = 0.0, speed
            if converged and adaptive:
                own = max(speed, _speed(n, problem.scale, s.v[2]))
                error = stages.estimate(problem, pattern, matrices, h, new, s, b, own) / settings.tolerance
            if converged and error <= 1.0:
                _read(n, s, new, between)
                converged = settle(problem, pattern, matrices, model, between, moved, works[2], VELOCITIES)
            if not converged or not error <= 1.0:
                log.counts[3] += 1
                h, before = 0.0, 0.0
                if not fresh and not converged:  # once more with matrices of this place
                    stale = True
                elif adaptive:
                    length = made * (max(0.1, 0.9 * error**-0.25) if converged and error < 1e100 else 0.25)
                    if length < 1e-12 * (end - begin):
                        return NEWTON_FAILED, t, worst
                elif level == _HALVINGS:
                    return NEWTON_FAILED, t, worst
                else:
                    level += 1
                continue
            speed, before = own, h
            copy(new, old)
            copy(between, new)
            _differentiate(
                problem, pattern, matrices, directions, h, t, target, within, s, new, moved, dolds, dstates, ds, b,
                dual_works, lifted,
            )  # fmt: skip
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
                growth = min(3.0, 0.9 * (error + 1e-30) ** -0.25)
                length = h * growth if growth < 1.0 or growth > 1.2 or (stale and growth > 1.05) else h
    copy(new, start)
    return DONE, edges[-1], 0
