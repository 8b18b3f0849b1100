"""Runs of generalized-alpha with fixed steps for eight samples side by side, and which of them have to run alone."""

import numpy as np

from dalembert.kernels.kernel import inner, vector_kernel
from dalembert.kernels.lanes import WIDTH, lane_vector, lane_zeros
from dalembert.kernels.words import Integers, Reals, Reals4
from dalembert.multibody.integrators.generalized_alpha.lanes_newton import (
    LanesNewton,
    converge_lanes,
    lanes_newton,
)
from dalembert.multibody.integrators.generalized_alpha.newton import keep_slope
from dalembert.multibody.integrators.shared.batch import Batch, restarts
from dalembert.multibody.integrators.shared.consistent import Consistency, consistency
from dalembert.multibody.integrators.shared.lane_states import (
    LaneSignals,
    accelerate_lanes,
    all_alone,
    count_lanes,
    lane_state,
    take_lane,
)
from dalembert.multibody.integrators.shared.problem import IntegrationProblem
from dalembert.multibody.kernels.block_table import addresses
from dalembert.multibody.kernels.states import (
    Histories,
    MotionState,
    MotionStates,
    coefficients,
    copy,
    interpolate,
    resting,
    row,
    rows,
)
from dalembert.multibody.model.lane_models import lane_model
from dalembert.multibody.model.turns import count_turns


def run_in_lanes(
    batch: Batch, step: float, radius: float, consistent: bool, tolerance: float
) -> tuple[MotionState, np.ndarray]:
    """Run up to eight samples; return their states (samples, times, N + 1), and which of them have to run alone."""
    problem, samples = batch.problem, batch.samples
    filled = [*range(len(samples)), *[0] * (WIDTH - len(samples))]
    models = [samples[number].real.need("rates").reduced() for number in filled]
    together = lane_model(samples).reduced()
    call, work = together.call(), models[0].call()
    # Lanes that only fill the group count nothing.
    turns = np.zeros(WIDTH, np.int64)
    turns[: len(samples)] = batch.begin_counting()
    newton = lanes_newton(
        problem,
        together.address,
        call.address,
        call.signals,
        LaneSignals(addresses(models), work.address, work.signals),
        turns,
    )
    ends, out = lane_zeros(2, 4, len(problem.scale)), resting(len(samples), *batch.shape)
    for lane, number in enumerate(filled):
        for part, values in enumerate(batch.states):
            ends[1, part, :, lane] = values[number]
    integrate_lanes(
        problem, problem.edges[0, : problem.stretches[0] + 1], restarts(samples, problem)[0], step, radius, consistent,
        tolerance, ends, Histories(*out), consistency(problem, work.address, work.address, 0), newton,
        resting(0, len(problem.scale)),
    )  # fmt: skip
    return out, newton.alone[: len(samples)] == 1


@vector_kernel
def integrate_lanes(
    problem: IntegrationProblem, edges: Reals, opens: Integers, step: float, radius: float, consistent: bool,
    tolerance: float, ends: Reals4, out: Histories, start: Consistency, scratch: LanesNewton,
    none: MotionStates,
) -> None:  # fmt: skip
    """Run eight samples from the first to the last edge, as :func:`generalized_alpha.integrate` runs one.

    ``ends`` (2, 4, N + 1, 8): x, v, a and w at both ends of a step. A lane is marked whose step needs to be halved.
    """
    n, due, state, alone = problem.n, 0, scratch.after, scratch.alone
    # A stack holds x, v, a and w of all lanes, entry by entry side by side: one load fills a vector. Its decisions
    # are made in `converge_lanes`; here all lanes share the grid of steps, the signals' smooth stretches and the times
    # of the output.
    old, new = ends[0], ends[1]
    slope = lane_vector(scratch.slope)
    for stretch in range(len(edges) - 1):
        begin, end = edges[stretch], edges[stretch + 1]
        within = 0.5 * (begin + end)
        fresh, last = opens[stretch] == 1, stretch + 2 == len(edges) or opens[stretch + 1] == 1
        if fresh:
            for i in range(len(slope)):
                slope[i] = 0.0
        # Accelerations at the start and behind jumps.
        if fresh and (stretch > 0 or consistent):
            accelerate_lanes(problem, begin, within, scratch.source, new, none, start, state, alone)
        if stretch == 0:
            count_lanes(begin, new, scratch.turns, state)
            while due < len(problem.times) and problem.times[due] <= begin:
                _record(n, 1.0, 1.0, new, new, out, due, scratch)
                due += 1
        steps = max(1, int(np.ceil((end - begin) / step - 1e-6)))
        length = (end - begin) / steps
        t = begin
        # A step that has to be halved leaves the common grid, so its lane runs alone: all lanes have one step length.
        c = coefficients(length, radius)
        for number in range(1, steps + 1):
            target = end if number == steps else begin + length * (1.0 * number)
            # A step begins with the state at the end of the one before, in all lanes.
            copy(lane_state(new), lane_state(old))
            # The signals of a step that ends at a jump are those before the jump.
            side = within if last or target < end else end
            converge_lanes(problem, c, target, side, tolerance, old, new, scratch)
            # Rates of accelerations and multipliers over the step, for the next prediction.
            keep_slope(n, c, lane_state(old), lane_state(new), slope)
            while due < len(problem.times) and problem.times[due] <= target + 1e-9 * length:
                _record(n, length, min(1.0, (problem.times[due] - t) / length), old, new, out, due, scratch)
                for lane in range(out.x.shape[0]):
                    count_turns(scratch.turns[lane], problem.times[due], row(rows(out, lane), due), due)
                due += 1
            count_lanes(target, new, scratch.turns, state)
            t = target
        if all_alone(alone):
            return


@inner
def _record(n, length, share, old, new, out, due, scratch):
    """Write the states of all lanes at an output time."""
    before, after = scratch.before, scratch.after
    # Lanes that only fill the group have no rows.
    for lane in range(out.x.shape[0]):
        take_lane(old, lane, before)
        take_lane(new, lane, after)
        interpolate(n, length, share, before, after, out.x[lane, due], out.v[lane, due], out.a[lane, due])
