"""The compiled loop of the constrained midpoint rule over the steps of a motion."""

from typing import NamedTuple

import numpy as np

from dalembert.multibody.integrators import energy_balance as balance
from dalembert.multibody.integrators import midpoint_step as midpoint
from dalembert.multibody.integrators.consistent import accelerate
from dalembert.multibody.integrators.ends import append, ends
from dalembert.multibody.integrators.lifting import set_signals
from dalembert.multibody.integrators.matrices import factorise_real, renew, room, weigh_masses
from dalembert.multibody.integrators.outputs import record
from dalembert.multibody.integrators.problem import DONE, NEWTON_FAILED, SINGULAR
from dalembert.multibody.integrators.settling import VELOCITIES, settle, settle_along
from dalembert.multibody.kernels.compiled import compiled, kernel, template
from dalembert.multibody.kernels.linear import storage
from dalembert.multibody.kernels.model import select, workspace
from dalembert.multibody.kernels.motion import copy, row, still

_AGED = 0.05  # contraction at which the next step begins with new matrices
_HALVINGS = 8  # of a step that Newton's iteration does not converge on


class Settings(NamedTuple):
    """What the compiled loop needs of an integrator; whether forces may be ``damped``; ``conserving`` the energy."""

    step: float
    newton_tolerance: float
    damped: bool
    conserving: bool


@kernel
def _read(n, s, new):
    """State at the end of a step; accelerations and multipliers to start from."""
    for k in range(s.shape[1]):
        new.x[k] = s[midpoint.X1, k]
        if k < n:
            new.v[k], new.a[k] = s[midpoint.V1, k], s[midpoint.B, k]


@template
def _differentiate(
    problem, pattern, matrices, directions, rigid, strength, h, t, target, within, s, new, moved, slopes, denergies,
    dold, dnews, ds, push, b, e, ahead, dual_works, lifted,
):  # fmt: skip
    """Derivatives of a step along all directions."""
    n = problem.n
    for d in range(len(dnews.x)):
        tilted, dnew = select(directions, d), row(dnews, d)
        copy(dnew, dold)
        set_signals(tilted, t + 0.5 * h, within, dual_works[0])
        set_signals(tilted, target, within, dual_works[1])
        midpoint.begin(n, h, dold, slopes[d], ds)
        denergies[d] += balance.converge_along(
            problem, pattern, matrices, tilted, rigid, rigid.shifts[d], strength, dual_works[0], dual_works[1], h,
            denergies[d], s, ds, push, b, e, ahead,
        )  # fmt: skip
        midpoint.learn(n, dold, ds, slopes[d])
        _read(n, ds, dnew)
        settle_along(problem, pattern, matrices, tilted, new, dnew, moved, dual_works[1], lifted, VELOCITIES)


@compiled
def integrate(problem, pattern, edges, settings, rigid, model, dual, directions, start, dstates, out, dout, log):
    """Run one sample between ``edges`` (s): status, time reached, and the unknown that moved most.

    ``rigid`` are the rigid motions whose momenta a force that conserves energy leaves.
    ``directions`` is a stack of complex models, one a direction of differentiation. ``start`` (N + 1) and its
    derivatives ``dstates`` (directions, N + 1) are overwritten; ``out`` (times, N + 1) and ``dout`` (directions, times,
    N + 1) are filled at ``problem.times``.
    """
    n, width = problem.n, len(start.x)
    new, between, dold, dbetween = still(width), still(width), still(width), still(width)
    last, weights = ends(np.int64(2), dstates), np.zeros((4, 2, 3))
    copy(start, new)
    works, dual_works = (workspace(model), workspace(model)), (workspace(dual), workspace(dual))
    matrices, exact = room(pattern, np.int64(0)), storage(problem.exact_layout)
    s, ds = np.zeros((midpoint.ROWS, width)), np.zeros((midpoint.ROWS, width))
    slope, slopes = np.zeros((2, width)), np.zeros((len(dstates.x), 2, width))
    b, ahead = midpoint.buffers(width)
    push, moved, lifted = np.zeros(width), np.zeros((6, width)), np.zeros((10, width), np.complex128)
    e = balance.room(len(rigid.spin), width)
    energy, denergies = 0.0, np.zeros(len(dstates.x))
    due = np.int64(0)  # no literal, for which there would be another compilation
    speed, h = 1.0 / (edges[-1] - edges[0]), 0.0
    for stretch in range(len(edges) - 1):
        t, end = edges[stretch], edges[stretch + 1]
        within = 0.5 * (t + end)
        if not accelerate(
            problem, model, dual, directions, t, within, new, dstates, works[0], dual_works[0], lifted, exact
        ):
            return SINGULAR, t, 0
        if stretch == 0:
            weigh_masses(pattern, matrices, dual, n, new, dual_works[0])
            energy = balance.first_energy(model, n, new, works[0], e.totals)
            for d in range(len(denergies)):
                tilted = select(directions, d)
                set_signals(tilted, t, within, dual_works[0])
                denergies[d] = balance.first_energy_along(
                    tilted, n, new, row(dstates, d), dual_works[0], lifted, e.lifted_totals
                )
        steps = max(1, int(np.ceil((end - t) / settings.step - 1e-6)))
        begin, nominal, number, level = t, (end - t) / steps, 0, 0
        stale, fresh, made = True, True, 0.0
        slope[:] = 0.0
        slopes[:] = 0.0
        last.known[0] = 0
        append(t, new, dstates, True, last)
        while True:
            while due < len(problem.times) and problem.times[due] <= t + 1e-9 * h:
                written = record(
                    problem, pattern, matrices, False, model, dual, directions, last, within, out, dout, due, between,
                    dbetween, weights, moved, works[0], dual_works[0], lifted,
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
            target = goal if level == 0 else t + (goal - t) / (1 << level)
            h = target - t
            if not abs(h - made) <= 1e-10 * h:
                log.counts[2] += 1
                made = h
                if not factorise_real(n, pattern, matrices, 2.0 / h):
                    return SINGULAR, t, 0
            set_signals(model, t + 0.5 * h, within, works[0])
            set_signals(model, target, within, works[1])
            midpoint.begin(n, h, new, slope, s)
            converged, iterations, rate, worst, strength, gain = balance.converge(
                problem, pattern, matrices, model, rigid, settings.conserving, works[0], works[1], h, energy, s, push,
                b, e, settings.newton_tolerance, h * speed,
            )  # fmt: skip
            log.counts[1] += iterations
            if converged:
                _read(n, s, between)
                converged = settle(problem, pattern, matrices, model, between, moved, works[1], VELOCITIES)
            if not converged:
                log.counts[3] += 1
                h = 0.0
                slope[:] = 0.0
                if not fresh:  # once more with matrices of this place
                    stale = True
                elif level == _HALVINGS:
                    return NEWTON_FAILED, t, worst
                else:
                    level += 1
                continue
            midpoint.learn(n, new, s, slope)
            copy(between, new)
            energy += gain
            for k in range(n):
                speed = max(speed, abs(s[midpoint.VM, k]) / problem.scale[k])
            _differentiate(
                problem, pattern, matrices, directions, rigid, strength, h, t, target, within, s, new, moved, slopes,
                denergies, dold, dstates, ds, push, b, e, ahead, dual_works, lifted,
            )  # fmt: skip
            append(target, new, dstates, True, last)
            if log.counts[0] < len(log.iterations):
                log.iterations[log.counts[0]] = iterations
                log.ends[log.counts[0]] = target
            log.counts[0] += 1
            number += 1 if level == 0 else 0
            level -= 1 if level > 0 else 0
            t, fresh, stale = target, False, rate > _AGED
    copy(new, start)
    return DONE, edges[-1], 0
