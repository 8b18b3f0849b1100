"""States of eight samples side by side, moved onto the constraints: :mod:`settling`, where each lane ends by itself."""

from dalembert.kernels.kernel import inner
from dalembert.kernels.lanes import WIDTH, chosen, entry, lane_vector, lanes2, larger, sizes
from dalembert.kernels.views import address_of
from dalembert.multibody.integrators.shared.lane_states import lane_masses, largest_lanes
from dalembert.multibody.integrators.shared.problem import ACCELERATION, POSITION, VELOCITY
from dalembert.multibody.integrators.shared.settling import LOOSE, MOST_ITERATIONS, finished, move, weigh
from dalembert.multibody.kernels.assembly import constraint_rates, residual
from dalembert.multibody.kernels.sample_lanes import solve_samples

ITERATES, BEFORE, SIZE, FAILED = range(4)
"""Rows of the numbers of lanes: see :func:`settle_lanes`."""


@inner
def _sizes(n, level, answer, state, moved, zero):
    """Largest correction, and largest entry of what it corrects, or of its move, in each lane."""
    values, size = state.x if level == POSITION else (state.v if level == VELOCITY else state.a), zero + 1e-300
    for i in range(n):
        size = larger(size, sizes(values[i]))
        if level < ACCELERATION:
            size = larger(size, sizes(moved[level, i]))
    return largest_lanes(answer, 0, n, zero), size


@inner
def settle_lanes(problem, masses, factors, model, state, vectors, buffer, work, first, wanted, values):
    """Settle the states of the lanes that are ``wanted`` (8,), as `settling.settle` does for one sample.

    ``state``: of lanes; ``vectors`` (6, N + 1, 8), ``buffer``: workspace. ``values`` (4, 8): whether a lane iterates,
    its correction before, the size of what it corrects; then whether it failed: there it has to run alone.
    """
    n, last, layout = problem.n, len(state.x) - 1, masses.pattern.layout
    moved, weights = lanes2(address_of(vectors), 6, last + 1), lane_masses(masses)
    f, rate, second, answer = moved[2], moved[3], moved[4], moved[5]
    iterates, zero = lane_vector(values), 0.0 * state.v[last]
    for i in range(last + 1):
        moved[0, i] = moved[1, i] = zero
    for lane in range(WIDTH):
        values[FAILED, lane] = 0.0
    # Level by level as for one sample: coordinates, velocities, then accelerations with the multipliers.
    for level in range(first if last > n else ACCELERATION, 3):
        for lane in range(WIDTH):
            values[ITERATES, lane], values[BEFORE, lane] = wanted[lane], 0.0
        for iteration in range(MOST_ITERATIONS):
            if level < ACCELERATION:
                weigh(model, n, weights, state.x, moved[level], work, f, second)
            else:
                residual(model, n, state.x, state.v, state.a, work, 1.0, f)
            if level > POSITION:
                constraint_rates(model, n, state.x, state.v, state.a, work, rate, second)
                for i in range(n, last):
                    f[i] = rate[i] if level == VELOCITY else second[i]
            solve_samples(layout, factors.matrix, factors.pivots, factors.tops, vectors[2], buffer, vectors[5])
            # A lane that has ended takes off zero, which keeps its bits.
            for i in range(last):
                answer[i] = chosen(iterates[ITERATES], answer[i])
            move(n, level, answer, state, moved)
            norm, size = _sizes(n, level, answer, state, moved, zero)
            running = False
            for lane in range(WIDTH):
                if values[ITERATES, lane] == 1.0:
                    moves, extent, before = entry(norm, lane), entry(size, lane), values[BEFORE, lane]
                    # Each lane ends by its contraction, or where it has lost its numbers.
                    is_done = finished(iteration, moves, before, extent)
                    is_last = is_done or not moves < 1e100
                    if not is_last:
                        values[BEFORE, lane] = before = moves
                        is_last = iteration == MOST_ITERATIONS - 1
                    if is_last and not is_done and not before <= LOOSE * extent:
                        # Balance of forces may still excuse it: that is decided where the sample runs alone.
                        values[FAILED, lane] = 1.0
                    values[ITERATES, lane] = 0.0 if is_last else 1.0
                    running = running or not is_last
            if not running:
                break
