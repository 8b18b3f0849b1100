"""The compiled loop of Radau IIA over the steps of a motion: choice of the step, outputs, derivatives."""

import numpy as np

from dalembert.kernels.kernel import inner, kernel
from dalembert.kernels.words import Reals
from dalembert.multibody.integrators.radau.radau_coefficients import Coefficients
from dalembert.multibody.integrators.radau.radau_derivatives import Along, differentiate, settle_end_along
from dalembert.multibody.integrators.radau.radau_step import attempt, speed_of
from dalembert.multibody.integrators.radau.radau_workspace import RadauSettings, RadauStep
from dalembert.multibody.integrators.shared.consistent import Consistency, accelerate
from dalembert.multibody.integrators.shared.convergence import HALVINGS
from dalembert.multibody.integrators.shared.ends import append, support
from dalembert.multibody.integrators.shared.matrices import Matrices, renew, weigh_masses
from dalembert.multibody.integrators.shared.outputs import Outputs, record
from dalembert.multibody.integrators.shared.problem import (
    DONE,
    INEXACT,
    NEWTON_FAILED,
    SINGULAR,
    TOO_MANY_STEPS,
    VELOCITY,
    IntegrationProblem,
    Log,
    SampleModels,
    note_step,
)
from dalembert.multibody.integrators.shared.settling import settle
from dalembert.multibody.kernels.assembly import set_signals
from dalembert.multibody.kernels.states import Histories, MotionState, MotionStates, clear, copy, row
from dalembert.multibody.model.turns import STEP_END, count_turns

_AGED = 0.003  # contraction at which the next step begins with new matrices, and outputs have their own
_SHORTEST = 0.2  # of a step: the one after it (Hairer and Wanner 1996, IV.8); what is foreseen may vanish in the time


@inner
def _first_step(n, scale, span, tolerance, order, state):
    """A step in which coordinates move by a small part of their scales."""
    # From velocities and from accelerations: at rest only the latter tell how fast the motion will be.
    rate = max(speed_of(n, scale, state.v), np.sqrt(speed_of(n, scale, state.a)))
    return min(0.1 * span, 0.3 * tolerance ** (1.0 / order) / (rate + 1e-300))


@inner
def _settle_ends(problem, matrices, apart, far, models, damped, within, scratch, along):
    """Settle the ends that outputs of the last step need; whether that went well.

    Former ones with matrices apart of their own places, the newest one, too, where the kept ones are from ``far``.
    """
    last, newest = scratch.last, len(scratch.last.times) - 1
    for j in range(support(last), newest + 1):
        if last.settled[j]:
            continue
        t, state, own = last.times[j], row(last.states, j), matrices
        if far or j < newest:
            own = apart
            if not renew(problem, own, models.tangents, damped, t, within, state, scratch.complex_work):
                return False
        set_signals(models.real, t, within, scratch.work)
        if not settle(problem, own, models.real, state, scratch.moved, scratch.work, VELOCITY):
            return False
        if len(models.directions) > 0:
            _settle_end_along_at(along, problem, own, models.directions, within, scratch, j)
        last.settled[j] = True
    return True


_settle_end_along_at, _differentiate_at = settle_end_along.at, differentiate.at


@kernel
def integrate(
    problem: IntegrationProblem, method: Coefficients, dstates: MotionStates, dout: Histories, new: MotionState,
    matrices: Matrices, apart: Matrices, step: RadauStep, outputs: Outputs, along: Along, consistency: Consistency,
    edges: Reals, settings: RadauSettings, models: SampleModels, start: MotionState, out: MotionStates, log: Log,
) -> tuple[int, float, int, float]:  # fmt: skip
    """Run one sample between ``edges`` (s): status, time reached, unknown that moved most, smallest error of a step.
    ``method`` are the coefficients. ``start`` (N + 1) and its derivatives ``dstates`` (directions, N + 1) are
    overwritten; ``out`` (times, N + 1) and ``dout`` (directions, times, N + 1) are filled at ``problem.times``. The
    rest is a workspace, which may be that of another sample before.
    """
    n, scale, times, counts = problem.n, problem.scale, problem.times, log.counts
    adaptive, order = settings.step == 0.0, len(method.c) + 1.0  # of the estimated error of a step
    last, complex_work = outputs.last, step.complex_work
    copy(start, new)
    clear(matrices.damping)  # is not evaluated where there is none
    clear(apart.damping)
    due = 0
    speed, h, length, taken, least = 1.0 / (edges[-1] - edges[0]), 0.0, 0.0, 0.0, np.inf
    for stretch in range(len(edges) - 1):
        t, end = edges[stretch], edges[stretch + 1]
        within = 0.5 * (t + end)
        # Each smooth stretch begins with consistent accelerations: they are the prediction of its first step, and part
        # of its estimated error.
        if not accelerate(problem, models, t, within, new, dstates, consistency):
            return SINGULAR, t, 0, 0.0
        if stretch == 0:
            set_signals(models.tangents, t, within, complex_work)  # those of a direction would count as masses
            weigh_masses(matrices, models.tangents, n, new, complex_work)
            length = _first_step(n, scale, end - t, settings.tolerance, order, new)
        steps = 1 if adaptive else max(1, int(np.ceil((end - t) / settings.step - 1e-6)))
        begin, nominal, number, level = t, (end - t) / steps, 0, 0
        far = False  # whether the kept matrices are from a place that outputs are far from
        stale, fresh, made, before, earlier, former = True, True, 0.0, 0.0, 0.0, 0.0
        last.known[0] = 0
        arrived, settled = True, stretch == 0
        while True:
            if arrived:  # in one place: what is inlined twice is compiled twice
                append(t, new, dstates, settled, last)
                count_turns(models.turns, t, new, STEP_END)
            arrived, settled, ready = False, False, False
            while due < len(times) and times[due] <= t + 1e-9 * taken:
                # Outputs interpolate through states at the ends of steps, which must satisfy the constraints at all
                # levels. They are settled only where an output needs them.
                ready = ready or _settle_ends(
                    problem, matrices, apart, far, models, settings.damped, within, outputs, along.settle_end
                )
                own = apart if far else matrices
                if not ready or not record(problem, own, far, models, outputs, within, out, dout, due):
                    return NEWTON_FAILED, times[due], 0, 0.0
                due += 1
            if number == steps:
                break
            goal = end if number == steps - 1 else begin + nominal * (number + 1)
            if not adaptive:
                length = (goal - t) / (1 << level)
            # A step that would leave less than a ten-thousandth of itself takes the rest with it.
            reached = (level == 0 and not adaptive) or t + length * 1.0001 >= goal
            target = goal if reached else t + length
            h = target - t
            status, made, error, fastest, iterations, rate, worst = attempt(
                problem, method, models, settings, t, target, within, before, earlier, stale, made, speed, new,
                matrices, step,
            )  # fmt: skip
            counts[1] += iterations
            if status == SINGULAR:
                return SINGULAR, t, 0, 0.0
            counts[2] += 1 if made == h else 0
            fresh, stale = fresh or stale, False
            converged = status == DONE
            if not converged or not error <= 1.0:
                counts[3] += 1
                earlier = 0.0
                # A new matrix is tried before a shorter step: it costs one factorisation, a shorter step at least two.
                stale = not converged  # so that matrices are not those of a place that the step does not reach
                if stale and not fresh:  # once more, as long
                    continue
                if adaptive:
                    # The estimated error is of order `order` in the step; 0.9 keeps the next one below the tolerance.
                    shorter = max(0.1, 0.9 * error ** (-1.0 / order)) if converged and error < 1e100 else 0.25
                    length = h * shorter
                    least = min(least, error) if converged else least
                    if length < 1e-12 * (end - begin):
                        return (INEXACT if converged else NEWTON_FAILED), t, worst, least
                elif level == HALVINGS:
                    return NEWTON_FAILED, t, worst, 0.0
                else:
                    level += 1
                continue
            if len(models.directions) > 0:
                _differentiate_at(
                    along.differentiate, problem, method, matrices, models.directions, t, target, within, step.s,
                    dstates, along,
                )  # fmt: skip
            arrived, speed, before, earlier, taken, least = True, fastest, h, before, h, np.inf
            note_step(log, iterations, target)
            t = target
            number += 1 if reached else 0
            level -= 1 if level > 0 else 0
            fresh, stale, far = False, rate > _AGED, rate > _AGED
            if adaptive:
                if counts[0] >= settings.most_steps and not reached:
                    return TOO_MANY_STEPS, t, 0, 0.0
                error = max(error, 1e-30)
                length = h * min(3.0, 0.9 * error ** (-1.0 / order))
                # Gustafsson's predictive control (Hairer and Wanner 1996, IV.8): the trend of the errors of two steps
                # foresees that of the next one. It may only shorten the step that the last error allows.
                if former > 0.0:
                    foreseen = 0.9 * h * (h / earlier) * (former / (error * error)) ** (1.0 / order)
                    length = min(length, max(foreseen, _SHORTEST * h))
                former = max(error, 1e-2)
    copy(new, start)
    return DONE, edges[-1], 0, 0.0
