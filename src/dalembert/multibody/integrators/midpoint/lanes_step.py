"""One step of the constrained midpoint rule for eight samples side by side.

Each lane decides for itself, by the rules of :mod:`midpoint_step`, in the same order of operations: a lane that has
converged is frozen. So a sample has the same bits in any group.
"""

from typing import NamedTuple

import numpy as np

from dalembert.kernels.kernel import inlined, inner
from dalembert.kernels.lanes import WIDTH, chosen, entry, lane_vector, lane_zeros, larger, sizes
from dalembert.kernels.words import Address, Integers, Reals2, Reals3
from dalembert.multibody.integrators.midpoint.midpoint_step import (
    CONVERGED,
    DIVERGED,
    MOST_ITERATIONS,
    StepRows,
    judge,
    passes,
    scale_constraints,
    step_residuals,
    take_off,
    takes_means,
)
from dalembert.multibody.integrators.shared.convergence import CLOSED, NOISE
from dalembert.multibody.integrators.shared.lane_states import (
    LaneFactors,
    LaneMasses,
    lane_factors,
    lane_masses,
    largest_lanes,
)
from dalembert.multibody.integrators.shared.matrices import Pattern, add_product
from dalembert.multibody.integrators.shared.problem import IntegrationProblem
from dalembert.multibody.kernels.elementary import where
from dalembert.multibody.kernels.sample_lanes import solve_samples
from dalembert.multibody.kernels.states import clear

PENDING, ITERATES, ARRIVED, NORM, BEFORE, RATE, FORCE, REMAINING, SPEED = range(9)
"""Rows of the numbers of lanes: see :class:`LanesStep`."""


class LanesStep(NamedTuple):
    """Work of a step of eight samples. ``model`` in lanes, calls for the ``middle`` and the ``end`` of a step. ``rows``
    (8, N + 1, 8) as :class:`midpoint_step.StepRows`; ``vectors`` (6, N + 1, 8); a force ``push`` (N + 1, 8) against it;
    factors of the matrix of the midpoint rule (``real``) and of that of the projection (``rigid``). ``alone`` (8,):
    lanes that are to run alone. ``numbers`` (9, 8): whether the step of a lane is to be done, whether it iterates,
    whether it has converged; size of the last correction and of the one before, contraction, forces at the prediction
    and now, largest speed so far.
    """

    model: Address
    middle: Address
    end: Address
    rows: Reals3
    vectors: Reals3
    push: Reals2
    masses: LaneMasses
    real: LaneFactors
    rigid: LaneFactors
    buffer: Reals2
    alone: Integers
    numbers: Reals2


def lanes_step(problem: IntegrationProblem, pattern: Pattern, model: int, middle: int, end: int) -> LanesStep:
    """Workspace for steps of eight samples."""
    width, layout, entries = len(problem.scale), pattern.layout, len(pattern.rows)
    masses = LaneMasses(pattern, np.zeros(entries + 1, np.int64), lane_zeros(entries))
    return LanesStep(
        model, middle, end, lane_zeros(8, width), lane_zeros(6, width), lane_zeros(width), masses,
        lane_factors(layout), lane_factors(layout), lane_zeros(layout.size + 3 * layout.reach),
        np.zeros(WIDTH, np.int64), lane_zeros(9),
    )  # fmt: skip


@inlined
def lane_rows(array):
    """The rows (8, N + 1, 8) of a step."""
    return StepRows(
        lane_vector(array[0]), lane_vector(array[1]), lane_vector(array[2]), lane_vector(array[3]),
        lane_vector(array[4]), lane_vector(array[5]), lane_vector(array[6]), lane_vector(array[7]),
    )  # fmt: skip


@inner
def _sizes(n, h, scale, f, gap, s, zero):
    """Largest correction of a coordinate and largest way of one in the step, against its scale."""
    norm, way = zero, zero
    for k in range(n):
        # What a correction of both accelerations moves a coordinate at most.
        norm = larger(norm, 0.25 * h * h * (sizes(f[k]) + sizes(gap[k])) / scale[k])
        way = larger(way, h * sizes(s.vm[k]) / scale[k])
    return norm, way


@inner
def converge_lanes(problem, h, tolerance, least, s, scratch):
    """Newton's iteration on a step of the lanes that are pending: `midpoint_step.converge`. ``least`` (8,) of each."""
    b, values, masses = scratch.vectors, scratch.numbers, lane_masses(scratch.masses)
    n, size, scale, layout = problem.n, len(s.x0) - 1, problem.scale, scratch.masses.pattern.layout
    f, gap, rate, second, first, other = (
        lane_vector(b[0]), lane_vector(b[1]), lane_vector(b[2]), lane_vector(b[3]), lane_vector(b[4]),
        lane_vector(b[5]),
    )  # fmt: skip
    numbers, push, real, rigid = lane_vector(values), lane_vector(scratch.push), scratch.real, scratch.rigid
    zero, closed, means = 0.0 * s.v0[size], 0.0, takes_means(scratch.model, scratch.middle)
    for k in range(n):
        closed = max(closed, CLOSED * scale[k])
    # Lanes that run alone, or whose step is done, take part in the arithmetic, but their numbers do not change.
    for lane in range(WIDTH):
        values[ITERATES, lane], values[ARRIVED, lane] = values[PENDING, lane], 0.0
        values[BEFORE, lane], values[RATE, lane] = 0.0, 1.0
    for iteration in range(1, MOST_ITERATIONS + 1):
        step_residuals(scratch.model, n, s, scratch.middle, scratch.end, f, gap, rate, second)
        # The force that balances the energy; zero in the variational method.
        for k in range(n):
            f[k] += push[k]
            first[k] = s.b[k] - s.a[k]
        for k in range(n, size):  # rounding would come back as velocities, 1/h times as large
            gap[k] = where(sizes(gap[k]) <= closed, zero, gap[k])
        numbers[REMAINING] = largest_lanes(f, 0, n, zero)
        if iteration == 1:  # of the prediction, and of the constraints
            numbers[FORCE] = larger(numbers[REMAINING], largest_lanes(s.x0, n, size, zero))
        # The difference of both equations, as for one sample; then Newton's correction by the kept matrices.
        add_product(n, masses, masses.mass, first, 1.0, gap)
        scale_constraints(n, size, h, f, gap, rate)
        solve_samples(layout, real.matrix, real.pivots, real.tops, b[0], scratch.buffer, b[4])
        if means:
            clear(other)
        else:
            solve_samples(layout, rigid.matrix, rigid.pivots, rigid.tops, b[1], scratch.buffer, b[5])
        for k in range(size):
            # A frozen lane takes off zero, which keeps its bits.
            first[k], other[k] = chosen(numbers[ITERATES], first[k]), chosen(numbers[ITERATES], other[k])
        take_off(n, size, h, first, other, f, gap, s)
        norm, way = _sizes(n, h, scale, f, gap, s, zero)
        # From here on scalars: each lane decides by its numbers, as one sample does.
        running = False
        for lane in range(WIDTH):
            if values[ITERATES, lane] == 1.0:
                moved, reached = entry(norm, lane), max(least[lane], entry(way, lane))
                if iteration > 1 and moved > NOISE * reached:
                    values[RATE, lane] = moved / values[BEFORE, lane]
                progress = judge(
                    iteration, tolerance * reached, moved, values[BEFORE, lane], values[RATE, lane],
                    values[REMAINING, lane], values[FORCE, lane],
                )  # fmt: skip
                # The last iteration may still leave rounding that a nearly singular position magnifies.
                is_last = progress == DIVERGED or iteration == MOST_ITERATIONS
                if progress == CONVERGED or (is_last and passes(moved, values[REMAINING, lane], values[FORCE, lane])):
                    values[ARRIVED, lane] = 1.0
                values[BEFORE, lane] = moved
                values[ITERATES, lane] = 0.0 if progress == CONVERGED or is_last else 1.0
                running = running or values[ITERATES, lane] == 1.0
        if not running:
            break
