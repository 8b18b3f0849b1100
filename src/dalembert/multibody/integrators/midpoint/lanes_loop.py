"""Runs of the constrained midpoint rule for eight samples side by side, and which of them have to run alone."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from dalembert.kernels.kernel import inlined, inner, vector_kernel
from dalembert.kernels.lanes import WIDTH, lane_vector, lane_zeros, lanes2, larger, sizes
from dalembert.kernels.views import address_of
from dalembert.kernels.words import Integers, Integers2, Reals, Reals2, Reals3, Reals4
from dalembert.multibody.integrators.midpoint.energy_balance import FreeRigidMotions
from dalembert.multibody.integrators.midpoint.lanes_balance import (
    ENERGY,
    GAIN,
    LanesBalance,
    balance_lanes,
    lanes_balance,
)
from dalembert.multibody.integrators.midpoint.lanes_step import (
    ARRIVED,
    PENDING,
    RATE,
    SPEED,
    LanesStep,
    converge_lanes,
    lane_rows,
    lanes_step,
)
from dalembert.multibody.integrators.midpoint.midpoint_loop import AGED, WARY
from dalembert.multibody.integrators.midpoint.midpoint_step import StepRows, has_means
from dalembert.multibody.integrators.midpoint.prediction import begin, begin_by_means, keep_lanes, open_means
from dalembert.multibody.integrators.shared.batch import Batch
from dalembert.multibody.integrators.shared.consistent import Consistency, consistency
from dalembert.multibody.integrators.shared.ends import Ends, ends, interpolate_ends, weigh_ends
from dalembert.multibody.integrators.shared.lane_states import (
    LaneSignals,
    accelerate_lanes,
    all_alone,
    count_lanes,
    keep_factors,
    lane_state,
    set_lane_signals,
    take_lane,
)
from dalembert.multibody.integrators.shared.matrices import (
    Doubles,
    Matrices,
    factorise_real,
    pattern_of,
    renew,
    scratch,
    weigh_masses,
)
from dalembert.multibody.integrators.shared.problem import POSITION, VELOCITY, IntegrationProblem
from dalembert.multibody.integrators.shared.settling_lanes import FAILED, settle_lanes
from dalembert.multibody.kernels.assembly import set_signals
from dalembert.multibody.kernels.block_table import addresses
from dalembert.multibody.kernels.elementary import where
from dalembert.multibody.kernels.linear import Factors
from dalembert.multibody.kernels.records import call_at
from dalembert.multibody.kernels.states import Histories, MotionState, MotionStates, resting, row, rows
from dalembert.multibody.model.lane_models import lane_model
from dalembert.multibody.model.lowered import Lowered
from dalembert.multibody.model.turns import count_turns

MIDDLE, MIDDLE_VELOCITY, ACCELERATIONS = (StepRows._fields.index(name) for name in ("xm", "vm", "a"))
"""Rows of a step."""
Balanced = tuple[float, FreeRigidMotions]
"""Energy of a sample at the start, in J, and the rigid motions that are free."""


class LaneMatrices(NamedTuple):
    """Mass, damping and stiffness of each lane (8, entries), for which step it is factorised (8,), and the work of one
    lane: a list of the entries with masses, and two factorised systems. ``damped`` (8,): whether forces may damp;
    ``is_stale``, ``is_fresh`` (8,): whether a lane needs new matrices, and whether they are of this place; ``wary``
    (8,): steps that begin with new ones.
    """

    mass: Reals2
    damping: Reals2
    stiffness: Reals2
    made: Reals
    heavy: Integers2
    rigid: Factors
    real: Factors
    doubles: Doubles
    damped: Integers
    is_stale: Integers
    is_fresh: Integers
    wary: Integers


class LanesRun(NamedTuple):
    """Work of a run. ``middle``, ``end``: signals of both calls in lanes (signals, 3, 8), which come from ``source``.
    ``stacks`` (3, 4, N + 1, 8): states at the end of the step before, of the last one, and of the one that is tried;
    ``slope`` (2, N + 1, 8): what a step missed; ``settled`` (4, 8), ``moved`` (6, N + 1, 8): work of settled states;
    ``least`` (8,); ``last``: times of the ends; ``weights`` (4, 2, 3) of both; ``turns`` (8,).
    """

    step: LanesStep
    matrices: LaneMatrices
    source: LaneSignals
    middle: Reals3
    end: Reals3
    stacks: Reals4
    slope: Reals3
    moved: Reals3
    settled: Reals2
    least: Reals
    last: Ends
    weights: Reals3
    alone: MotionState
    turns: Integers


def run_in_lanes(
    batch: Batch, step: float, tolerance: float, damped: Callable[[Lowered], bool], balances: Sequence[Balanced] = ()
) -> tuple[MotionState, np.ndarray]:
    """Run up to eight samples; return their states (samples, times, N + 1), and which of them have to run alone.

    ``damped``: whether forces of a sample depend on velocities. ``balances``: energy of each sample at the start and
    its rigid motions; empty if the energy is not balanced.
    """
    problem, samples = batch.problem, batch.samples
    filled = [*range(len(samples)), *[0] * (WIDTH - len(samples))]
    models = [samples[number].real.need("rates") for number in filled]
    roles = ("residual", "rates", "energy") if balances else ("residual", "rates")
    together = lane_model(samples, *roles)
    if balances:
        together.averaged(samples[0].structure.takes_means)
    energies = [balances[number][0] for number in filled] if balances else []
    motions = [balances[number][1] for number in filled] if balances else []
    middle, end, call = together.call(), together.call(), models[0].call()
    pattern, width = pattern_of(samples[0].structure), len(problem.scale)
    own = lanes_step(problem, pattern, together.address, middle.address, end.address)
    # Lanes that only fill the group count nothing.
    turns = np.zeros(WIDTH, np.int64)
    turns[: len(samples)] = batch.begin_counting()
    one, entries = scratch(pattern, 0), len(pattern.rows)
    depends = np.array([damped(samples[number]) for number in filled], dtype=np.int64)
    flags = np.zeros((3, WIDTH), np.int64)
    # Factors are kept side by side in the step; one workspace serves to make those of each lane.
    mass, damping, stiffness = np.zeros((3, WIDTH, entries))
    matrices = LaneMatrices(
        mass, damping, stiffness, np.zeros(WIDTH), np.zeros((WIDTH, entries + 1), np.int64), one.rigid, one.real,
        one.doubles, depends, flags[0], flags[1], flags[2],
    )  # fmt: skip
    work = LanesRun(
        own, matrices, LaneSignals(addresses(models), call.address, call.signals), middle.signals, end.signals,
        lane_zeros(3, 4, width), lane_zeros(2, width), lane_zeros(6, width), lane_zeros(4), np.zeros(WIDTH),
        ends(2, resting(0, width)), np.zeros((4, 2, 3)), resting(width), turns,
    )  # fmt: skip
    out = resting(len(samples), *batch.shape)
    # Lanes that only fill the group run the first sample.
    for lane, number in enumerate(filled):
        for part, values in enumerate(batch.states):
            work.stacks[1, part, :, lane] = values[number]
    integrate_lanes(
        problem, problem.edges[0, : problem.stretches[0] + 1], step, tolerance, Histories(*out),
        consistency(problem, call.address, call.address, 0), resting(0, width), lanes_balance(width, motions, energies),
        work,
    )  # fmt: skip
    return out, own.alone[: len(samples)] == 1


_balance_at = balance_lanes.at


@inlined
def _matrices(pattern, stack, lane):
    """The matrices of one lane."""
    return Matrices(
        pattern, stack.heavy[lane], stack.mass[lane], stack.damping[lane], stack.stiffness[lane], stack.rigid,
        stack.real, stack.doubles,
    )  # fmt: skip


@inner
def _weigh_lanes(n, pattern, t, within, work):
    """Weigh the masses of each lane, which are constant, and list the entries with a mass in any of them."""
    masses, state, count = work.step.masses, work.alone, 0
    for lane in range(WIDTH):
        lane_matrices, model = _matrices(pattern, work.matrices, lane), work.source.models[lane]
        take_lane(work.stacks[1], lane, state)
        set_signals(model, t, within, work.source.call)
        weigh_masses(lane_matrices, model, n, state, work.source.call)
        for e in range(len(lane_matrices.mass)):
            masses.mass[e, lane] = lane_matrices.mass[e]
    # Entries without a mass would add zeros, which change no bit.
    for e in range(len(masses.mass)):
        is_heavy = False
        for lane in range(WIDTH):
            is_heavy = is_heavy or masses.mass[e, lane] != 0.0
        # Behind the masses stand the columns of the multipliers.
        if is_heavy and masses.pattern.rows[e] < n and masses.pattern.columns[e] < n:
            masses.heavy[count] = e
            count += 1
    masses.heavy[len(masses.mass)] = count


@inner
def _renew_lane(problem, pattern, t, within, h, lane, means, work):
    """Bring the matrices of a lane to this place and to this step, where they are not; False where that fails."""
    stack, step, state = work.matrices, work.step, work.alone
    own, model = _matrices(pattern, stack, lane), work.source.models[lane]
    if stack.is_stale[lane] == 1:
        place, call_at(work.source.call).step = t, 0.0
        if means:  # as in `midpoint_loop.integrate`
            place, call_at(work.source.call).step = t + 0.5 * h, h
            for i in range(len(state.x)):
                state.x[i], state.v[i], state.a[i] = (
                    step.rows[MIDDLE, i, lane], step.rows[MIDDLE_VELOCITY, i, lane], step.rows[ACCELERATIONS, i, lane]
                )  # fmt: skip
        else:
            take_lane(work.stacks[1], lane, state)
        if not renew(problem, own, model, stack.damped[lane] == 1, place, within, state, work.source.call):
            return False
        if not keep_factors(pattern.layout, own.rigid, lane, step.rigid):
            return False
        # The matrix of the midpoint rule is made of the same masses, damping and stiffness.
        stack.is_stale[lane], stack.is_fresh[lane], stack.made[lane] = 0, 1, 0.0
    # Steps of one stretch differ by the rounding of their ends, which grows with the time.
    if not abs(h - stack.made[lane]) <= 1e-10 * h:
        stack.made[lane] = h
        if not factorise_real(problem.n, own, 2.0 / h):
            return False
        return keep_factors(pattern.layout, own.real, lane, step.real)
    return True


@inner
def _record(problem, is_end, within, out, due, work):
    """Write the states of all lanes at an output time: `outputs.record`."""
    t, step, width, e = problem.times[due], work.step, work.stacks.shape[2], work.last
    state, newest = lane_state(work.stacks[2]), lane_state(work.stacks[1])
    if is_end:
        for i in range(width):
            state.x[i], state.v[i], state.a[i] = newest.x[i], newest.v[i], newest.a[i]
    else:
        weigh_ends(e, 0, t, work.weights)
        at = address_of(work.stacks)
        both = MotionStates(
            # Rows of x, v and a of both ends: whole states lie between them.
            lanes2(at, 8, width)[::4], lanes2(at, 8, width)[1::4], lanes2(at, 8, width)[2::4],
            lanes2(at, 8, width)[3::4],
        )  # fmt: skip
        interpolate_ends(problem.n, 0, work.weights, both, state)
        # On the constraints, with its accelerations, by the matrices of the step.
        set_lane_signals(t, within, work.source, work.end)
        for lane in range(WIDTH):
            work.least[lane] = 1.0 - step.alone[lane]
        settle_lanes(
            problem, step.masses, step.rigid, step.model, state, work.moved, step.buffer, step.end, POSITION,
            work.least, work.settled,
        )  # fmt: skip
        for lane in range(WIDTH):
            if work.settled[FAILED, lane] == 1.0:
                step.alone[lane] = 1
    for lane in range(out.x.shape[0]):
        take_lane(work.stacks[2], lane, work.alone)
        target = row(rows(out, lane), due)
        for i in range(width):
            target.x[i], target.v[i], target.a[i] = work.alone.x[i], work.alone.v[i], work.alone.a[i]
        count_turns(work.turns[lane], t, work.alone, due)


@inner
def _advance(problem, pattern, t, target, last, within, tolerance, balance, work):
    """Take the step of all lanes that do not run alone; those whose step would have to be halved are marked."""
    n, step, stack, h = problem.n, work.step, work.matrices, target - t
    values, s = step.numbers, lane_rows(step.rows)
    start, tried, numbers = lane_state(work.stacks[1]), lane_state(work.stacks[2]), lane_vector(step.numbers)
    missed = lanes2(address_of(work.slope), 2, len(s.x0))
    # The start of the step stays where it is for lanes that try again, and for outputs within the step.
    before = lane_state(work.stacks[0])
    for i in range(len(s.x0)):
        before.x[i], before.v[i], before.a[i] = start.x[i], start.v[i], start.a[i]
    means = balance.converge != 0 and has_means(step.model)
    for lane in range(WIDTH):
        values[PENDING, lane] = 1.0 - step.alone[lane]
        stack.is_fresh[lane] = 0
    # Once with the matrices that are kept; lanes that fail once more with matrices of this place.
    for _ in range(2):
        if means:
            begin_by_means(n, h, last, before, missed, s)
        else:
            begin(n, h, before, missed, s)
        for lane in range(WIDTH):
            if values[PENDING, lane] == 1.0 and not _renew_lane(problem, pattern, t, within, h, lane, means, work):
                step.alone[lane], values[PENDING, lane] = 1, 0.0
            # The way of the fastest step so far bounds what a correction may leave.
            work.least[lane] = h * values[SPEED, lane]
        # Forces are those of the middle, prescribed motions and their rates those of the end.
        set_lane_signals(t + 0.5 * h, within, work.source, work.middle)
        set_lane_signals(target, within, work.source, work.end)
        call_at(step.middle).step = h if balance.converge != 0 else 0.0
        if balance.converge == 0:
            converge_lanes(problem, h, tolerance, work.least, s, step)
        else:
            _balance_at(balance.converge, problem, h, tolerance, work.least, step, balance)
        for i in range(len(s.x0)):
            tried.x[i] = s.x1[i]
            if i < n:
                tried.v[i], tried.a[i] = s.v1[i], s.b[i]
        for lane in range(WIDTH):
            work.least[lane] = values[ARRIVED, lane]
        # Settled, the end of the step fulfils the constraints to rounding at the level of velocities.
        settle_lanes(
            problem, step.masses, step.rigid, step.model, tried, work.moved, step.buffer, step.end,
            VELOCITY, work.least, work.settled,
        )  # fmt: skip
        again = False
        for lane in range(WIDTH):
            values[ARRIVED, lane] = work.least[lane] - work.settled[FAILED, lane]
            # What settles as a mechanism at rest does is decided where the sample runs alone.
            if work.settled[FAILED, lane] == 1.0:
                step.alone[lane], values[PENDING, lane] = 1, 0.0
            failed = values[PENDING, lane] == 1.0 and values[ARRIVED, lane] == 0.0
            # With matrices of this place only a shorter step helps, which the other lanes do not take.
            if failed and stack.is_fresh[lane] == 1:
                step.alone[lane], failed = 1, False
            values[PENDING, lane] = 1.0 if failed else 0.0
            again = again or failed
            # A slow contraction asks for new matrices at the next step.
            if values[ARRIVED, lane] == 1.0:
                stack.is_stale[lane] = 1 if values[RATE, lane] > AGED or (means and stack.wary[lane] > 0) else 0
                stack.wary[lane] = max(0, stack.wary[lane] - 1)
            elif failed:
                stack.is_stale[lane], stack.wary[lane] = 1, WARY
        # Lanes that have arrived keep their state and what the step missed; those that try again forget this.
        arrived, pending = numbers[ARRIVED] != 0.0, numbers[PENDING] != 0.0
        # The energy that the next step must have: that of the start and the work since.
        energies = lane_vector(balance.numbers)
        energies[ENERGY] = where(arrived, energies[ENERGY] + energies[GAIN], energies[ENERGY])
        keep_lanes(n, h, last, means, arrived, pending, before, s, missed)
        for i in range(n):
            start.v[i] = where(arrived, tried.v[i], start.v[i])
            start.a[i] = where(arrived, tried.a[i], start.a[i])
            numbers[SPEED] = where(arrived, larger(numbers[SPEED], sizes(s.vm[i]) / problem.scale[i]), numbers[SPEED])
        for i in range(len(s.x0)):
            start.x[i] = where(arrived, tried.x[i], start.x[i])
        if not again:
            break


@vector_kernel
def integrate_lanes(
    problem: IntegrationProblem, edges: Reals, step: float, tolerance: float, out: Histories, consistent: Consistency,
    none: MotionStates, balance: LanesBalance, work: LanesRun,
) -> None:  # fmt: skip
    """Run eight samples from the first to the last edge, as :func:`midpoint_loop.integrate` runs one.

    ``work`` holds the states at the start. A lane is marked whose step needs to be halved.
    """
    times, pattern, own = problem.times, work.step.masses.pattern, work.step
    due, h, width = 0, 0.0, work.stacks.shape[2]
    slope = lanes2(address_of(work.slope), 2, width)
    for lane in range(WIDTH):
        own.numbers[SPEED, lane] = 1.0 / (edges[-1] - edges[0])
    for stretch in range(len(edges) - 1):
        t, end = edges[stretch], edges[stretch + 1]
        within = 0.5 * (t + end)
        accelerate_lanes(problem, t, within, work.source, work.stacks[1], none, consistent, work.alone, own.alone)
        if stretch == 0:
            _weigh_lanes(problem.n, pattern, t, within, work)
        steps = max(1, int(np.ceil((end - t) / step - 1e-6)))
        opening, nominal = t, (end - t) / steps
        # Behind a jump nothing that was kept is of this place.
        for lane in range(WIDTH):
            work.matrices.is_stale[lane], work.matrices.wary[lane] = 1, 0
        for i in range(width):
            slope[0, i] = slope[1, i] = 0.0
        if balance.converge != 0 and has_means(own.model):
            open_means(problem.n, lane_state(work.stacks[1]), slope)
        work.last.times[1], h, last = t, 0.0, 0.0
        for number in range(steps + 1):
            count_lanes(t, work.stacks[1], work.turns, work.alone)
            while due < len(times) and times[due] <= t + 1e-9 * h:
                # Behind a jump nothing is known before the stretch.
                share = 1.0
                if number > 0:
                    share = (times[due] - work.last.times[0]) / (work.last.times[1] - work.last.times[0])
                _record(problem, share > 1.0 - 1e-9, within, out, due, work)
                due += 1
            if number == steps:
                break
            target = end if number == steps - 1 else opening + nominal * (number + 1)
            h = target - t
            _advance(problem, pattern, t, target, last, within, tolerance, balance, work)
            last = h
            work.last.times[0], work.last.times[1] = t, target
            t = target
            if all_alone(own.alone):
                return
