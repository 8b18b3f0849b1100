"""The compiled loop of the constrained midpoint rule over the steps of a motion."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from dalembert.kernels.kernel import inner, kernel
from dalembert.kernels.words import Reals, Reals2
from dalembert.multibody.integrators.midpoint import energy_balance as balancing
from dalembert.multibody.integrators.midpoint import midpoint_step as midpoint
from dalembert.multibody.integrators.midpoint import prediction
from dalembert.multibody.integrators.midpoint.energy_balance import Balance
from dalembert.multibody.integrators.midpoint.midpoint_derivatives import Derivatives, derivatives, differentiate
from dalembert.multibody.integrators.midpoint.midpoint_step import MidpointStep
from dalembert.multibody.integrators.shared.consistent import Consistency, accelerate, consistency
from dalembert.multibody.integrators.shared.convergence import HALVINGS
from dalembert.multibody.integrators.shared.ends import append
from dalembert.multibody.integrators.shared.matrices import (
    Matrices,
    Pattern,
    factorise_real,
    renew,
    scratch,
    weigh_masses,
)
from dalembert.multibody.integrators.shared.outputs import Outputs, outputs, record
from dalembert.multibody.integrators.shared.problem import (
    DONE,
    NEWTON_FAILED,
    SINGULAR,
    VELOCITY,
    IntegrationProblem,
    Log,
    SampleModels,
    note_step,
)
from dalembert.multibody.integrators.shared.settling import settle
from dalembert.multibody.kernels.assembly import set_signals
from dalembert.multibody.kernels.block_table import Call
from dalembert.multibody.kernels.records import call_at
from dalembert.multibody.kernels.states import Histories, MotionState, MotionStates, clear, copy, row
from dalembert.multibody.model.turns import STEP_END, count_turns

AGED = 0.05  # contraction at which the next step begins with new matrices
WARY = 8  # steps that begin with new matrices after one that failed with kept ones
_ENDS = 2  # of steps, between which outputs are interpolated


class MidpointSettings(NamedTuple):
    """What the compiled loop needs of an integrator; whether forces may be ``damped``; the ``energy`` at the start."""

    step: float
    newton_tolerance: float
    damped: bool
    energy: float


class MidpointWorkspace(NamedTuple):
    """Work of one sample; ``slope`` (2, N + 1) is what a step missed.

    The loop takes each part by itself: a record of them all triples its compilation.
    """

    matrices: Matrices
    consistency: Consistency
    step: MidpointStep
    balance: Balance
    slope: Reals2
    outputs: Outputs
    derivatives: Derivatives


def workspace(
    problem: IntegrationProblem, pattern: Pattern, calls: Sequence[Call], along_calls: Sequence[Call],
    balance: Balance,
    denergies: np.ndarray, dstates: MotionState, together: bool,
) -> MidpointWorkspace:  # fmt: skip
    """Workspace for one sample; two calls in real numbers and two along directions, for middle and end of a step."""
    directions, width = dstates.x.shape
    (work, end_work), (along, end_along) = ([call.address for call in own] for own in (calls, along_calls))
    out = outputs(_ENDS, dstates, work, along, together)
    return MidpointWorkspace(
        scratch(pattern, 0), consistency(problem, work, along, directions, together),
        midpoint.step_workspace(width, work, end_work), balance, np.zeros((2, width)), out,
        derivatives(along, end_along, denergies, width, balance.converge != 0, together),
    )  # fmt: skip


_balance_at, _differentiate_at = balancing.converge.at, differentiate.at


@inner
def _clear(array):
    """Fill a matrix with zeros."""
    for i in range(len(array)):
        clear(array[i])


@kernel
def integrate(
    problem: IntegrationProblem, edges: Reals, settings: MidpointSettings, models: SampleModels, new: MotionState,
    dnews: MotionStates,
    out: MotionStates, dout: Histories, log: Log, matrices: Matrices, consistent: Consistency, step: MidpointStep,
    balance: Balance, slope: Reals2, outputs: Outputs, along: Derivatives,
) -> tuple[int, float, int]:  # fmt: skip
    """Run one sample between ``edges`` (s): status, time reached, and the unknown that moved most. ``new`` (N + 1), the
    state at the start, and its derivatives ``dnews`` (directions, N + 1) are overwritten; ``out`` (times, N + 1) and
    ``dout`` (directions, times, N + 1) are filled at ``problem.times``.
    """
    n, times, scale, counts, s = problem.n, problem.times, problem.scale, log.counts, step.rows
    between, moved, last = outputs.between, outputs.moved, outputs.last
    slopes, complex_work = along.slopes, along.middle
    energy, due = settings.energy, 0
    strength, gain = 0.0, 0.0
    speed, h = 1.0 / (edges[-1] - edges[0]), 0.0
    means = balance.converge != 0 and midpoint.has_means(models.real)
    for stretch in range(len(edges) - 1):
        t, end = edges[stretch], edges[stretch + 1]
        within = 0.5 * (t + end)
        # Consistent accelerations and multipliers at the start and behind each jump are the prediction of the first
        # step.
        if not accelerate(problem, models, t, within, new, dnews, consistent):
            return SINGULAR, t, 0
        if stretch == 0:
            set_signals(models.tangents, t, within, complex_work)  # those of a direction would count as masses
            weigh_masses(matrices, models.tangents, n, new, complex_work)
        steps = max(1, int(np.ceil((end - t) / settings.step - 1e-6)))
        # Steps of one length: a symmetric method keeps its invariants only then.
        begin, nominal, number, level = t, (end - t) / steps, 0, 0
        stale, fresh, made, wary = True, True, 0.0, 0
        _clear(slope)
        for d in range(len(slopes)):
            _clear(slopes[d])
        before = 0.0
        if means:
            prediction.open_means(n, new, slope)
            for d in range(len(slopes)):
                prediction.open_means(n, row(dnews, d), slopes[d])
        last.known[0] = 0
        arrived = True
        while True:
            if arrived:  # in one place: what is inlined twice is compiled twice
                append(t, new, dnews, True, last)
                count_turns(models.turns, t, new, STEP_END)
            while due < len(times) and times[due] <= t + 1e-9 * h:
                if not record(problem, matrices, False, models, outputs, within, out, dout, due):
                    return NEWTON_FAILED, times[due], 0
                due += 1
            if number == steps:
                break
            # A step that fails is halved towards the end of its nominal one, and doubled again afterwards.
            goal = end if number == steps - 1 else begin + nominal * (number + 1)
            target = goal if level == 0 else t + (goal - t) / (1 << level)
            h = target - t
            call_at(step.middle).step = h if balance.converge != 0 else 0.0
            if means:
                prediction.begin_by_means(n, h, before, new, slope, s)
            else:
                prediction.begin(n, h, new, slope, s)
            if stale:
                state, place, call_at(complex_work).step = new, t, 0.0
                if means:
                    # Stiff directions of slender beams turn in the step, and damping depends on both ends.
                    state, place, call_at(complex_work).step = MotionState(s.xm, s.vm, s.a, s.a), t + 0.5 * h, h
                if not renew(problem, matrices, models.tangents, settings.damped, place, within, state, complex_work):
                    return SINGULAR, t, 0
                stale, fresh, made = False, True, 0.0
            # The matrix of the midpoint rule depends on h, that of the projection does not.
            if not abs(h - made) <= 1e-10 * h:
                counts[2] += 1
                made = h
                if not factorise_real(n, matrices, 2.0 / h):
                    return SINGULAR, t, 0
            # Forces are those of the middle, prescribed motions and their rates those of the end.
            set_signals(models.real, t + 0.5 * h, within, step.middle)
            set_signals(models.real, target, within, step.end)
            if balance.converge == 0:
                converged, iterations, rate, worst = midpoint.converge(
                    problem, matrices, models.real, h, step, settings.newton_tolerance, h * speed
                )
            else:
                converged, iterations, rate, worst, strength, gain = _balance_at(
                    balance.converge, problem, matrices, models.real, h, energy, step, balance,
                    settings.newton_tolerance, h * speed,
                )  # fmt: skip
            counts[1] += iterations
            if converged:
                midpoint.read(n, s, between)
                # The end of the step fulfils the constraints to the tolerance of Newton; settled, to rounding, at the
                # level of velocities, so that nothing drifts.
                converged = settle(problem, matrices, models.real, between, moved, step.end, VELOCITY)
            if not converged:
                counts[3] += 1
                h, arrived = 0.0, False
                if not means:
                    _clear(slope)
                if not fresh:  # once more with matrices of this place
                    stale, wary = True, WARY
                elif level == HALVINGS:
                    return NEWTON_FAILED, t, worst
                else:
                    level += 1
                    stale = means  # the middle of the shorter step lies elsewhere
                continue
            # What this prediction missed is added to the next one: a forecast of second order without a stored history.
            if means:
                prediction.keep_means(n, h, before, s, slope)
            else:
                prediction.keep_missed(n, new, s, slope)
            copy(between, new)
            # The energy that the next step must have: that of the start and the work since.
            energy += gain
            for k in range(n):
                speed = max(speed, abs(s.vm[k]) / scale[k])
            if len(models.directions) > 0:
                _differentiate_at(
                    along.differentiate, problem, matrices, models.directions, step, balance, strength, h, before, t,
                    target, within, new, dnews, moved, along,
                )  # fmt: skip
            note_step(log, iterations, target)
            before = h
            number += 1 if level == 0 else 0
            level -= 1 if level > 0 else 0
            t, fresh, stale, arrived = target, False, rate > AGED or (means and wary > 0), True
            wary -= 1 if wary > 0 else 0
    return DONE, edges[-1], 0
