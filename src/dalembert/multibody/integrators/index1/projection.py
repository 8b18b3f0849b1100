"""Coordinates and velocities moved onto the constraints by the smallest kinetic energy.

q - w with M w + J^T m = 0 and Phi(q - w) = 0, by Newton's iteration; velocities alike (`docs/theory/index-1.md`).
"""

from dalembert.kernels.kernel import inner, kernel
from dalembert.kernels.words import Integers
from dalembert.multibody.integrators.index1.index1 import Terms, Tools, factorise_motion
from dalembert.multibody.integrators.shared.convergence import MAGNIFIED
from dalembert.multibody.integrators.shared.partitioning import fill_gap
from dalembert.multibody.integrators.shared.problem import POSITION, VELOCITY, IntegrationProblem, SampleModels
from dalembert.multibody.integrators.shared.settling import largest, weigh_along
from dalembert.multibody.kernels.assembly import set_signals
from dalembert.multibody.kernels.linear import solve
from dalembert.multibody.kernels.linear_lanes import solve_slopes
from dalembert.multibody.kernels.slopes import (
    Number,
    along_kernels,
    arrays_of,
    joined,
    read_states,
    slope_of,
    state_of,
    write_states,
)
from dalembert.multibody.kernels.states import MotionState, MotionStates, clear

_MOST_ITERATIONS = 15
_NOTHING = 1e-16


@inner
def _move(problem, level, tools, state, change):
    """Add the correction in ``tools.answer`` to the whole change, and take it off the state; its size."""
    n, answer, values, largest = problem.n, tools.answer, state.x if level == POSITION else state.v, 0.0
    for i in range(n):
        size = abs(answer[i]) / problem.scale[i]
        if largest == largest and not size <= largest:
            largest = size
        change.a[i] += answer[i]
        values[i] -= answer[i]
    for i in range(n, len(answer) - 1):
        change.x[i] += answer[i]
    return largest


def _project_along(
    like: Number, problem: IntegrationProblem, level: int, directions: Integers, t: float, within: float,
    state: MotionState, dstates: MotionStates, tools: Tools,
) -> None:  # fmt: skip
    """Derivatives of the projection of coordinates or of velocities (``level``), along all directions."""
    numbers, slopes = arrays_of(like, tools.slopes)
    for g in range(len(directions)):
        read_states(dstates, g, tools.slopes.slopes)
        _follow(problem, level, directions[g], t, within, state, state_of(slopes), tools, numbers, slopes[4:])
        write_states(tools.slopes.slopes, g, dstates)


project_along, project_together = along_kernels(_project_along)


@inner
def _follow(problem, level, model, t, within, state, dstate, tools, numbers, slopes):
    """The derivative of a projection along directions. ``dstate`` holds that of the state before the projection, and
    that of the one after it when done. The equations are those of the projection: M w + J^T m = 0 in the coordinates
    before, and the constraints after.
    """
    n, last, work, base, change = problem.n, len(state.x) - 1, tools.complex_work, tools.base, tools.change
    x, v, f, weighed, before = numbers[0], numbers[1], numbers[3], numbers[4], numbers[6]
    gap, answer, dw = slopes[0], slopes[1], slopes[2]
    set_signals(model, t, within, work)
    for i in range(last + 1):
        dw[i] = 0.0
        before[i] = joined(base.x[i], dstate.x[i]) if i < n else 0.0 * before[i]
    # Constraints are those of the coordinates after, so that the solution is corrected.
    for _ in range(3):  # the matrix is that of the coordinates before
        for i in range(last + 1):
            weighed[i] = joined(change.a[i] if i < n else change.x[i], dw[i])
        weigh_along(model, n, before, weighed, work, numbers, f)
        for i in range(n):
            # Rows of motion in the coordinates before the projection, rows of constraints in those after it.
            gap[i] = slope_of(f[i])
            x[i] = joined(state.x[i], dstate.x[i] - dw[i] if level == POSITION else dstate.x[i])
            v[i] = joined(state.v[i], dstate.v[i] - dw[i] if level == VELOCITY else dstate.v[i])
        fill_gap(model, n, level, x, v, numbers[2], work, f, weighed)
        for i in range(n, last):
            gap[i] = -slope_of(f[i])
        solve_slopes(problem.exact_layout, tools.exact, gap, answer)
        for i in range(last):
            dw[i] -= answer[i]
    values = dstate.x if level == POSITION else dstate.v
    for i in range(n):
        values[i] -= dw[i]


@kernel
def project(
    problem: IntegrationProblem, terms: Terms, models: SampleModels, t: float, within: float, state: MotionState,
    dstates: MotionStates,
    tools: Tools,
) -> bool:  # fmt: skip
    """Move coordinates, then velocities, onto the constraints in place; return True if both iterations converged.

    With the state's mass matrix M and Jacobian J, the coordinates move to q - w with M w + J^T m = 0 and
    Phi(q - w) = 0, by Newton's iteration with J kept. The velocities then move to v - w with M w + J^T m = 0 and
    J (v - w) + Phi_t = 0, which is linear.

    ``t``: time, s; ``within``: a time in the smooth interval of the motion to which ``t`` belongs, s: it decides on
    which side of a jump the signals are evaluated; ``state``: coordinates and velocities; ``dstates``: its derivatives,
    which are moved with it; of length 0 if there are none.
    """
    n, last, base, change = problem.n, len(state.x) - 1, tools.base, tools.change
    set_signals(models.real, t, within, tools.work)
    for level in (POSITION, VELOCITY):
        set_signals(models.tangents, t, within, tools.complex_work)
        for i in range(last + 1):  # at rest and unloaded: the forces of friction are none
            base.x[i] = state.x[i] if i < n else 0.0
            change.x[i], change.a[i] = 0.0, 0.0
        if not factorise_motion(problem, terms, models.tangents, base, tools):
            return False
        before = 1e300
        for _ in range(_MOST_ITERATIONS):
            fill_gap(models.real, n, level, state.x, state.v, state.a, tools.work, tools.gap, tools.second)
            # No forces: the correction is the smallest one in the metric of the masses.
            clear(tools.gap[:n])
            solve(problem.exact_layout, tools.exact, tools.gap, tools.answer)
            moved = _move(problem, level, tools, state, change)
            if moved <= _NOTHING or (moved <= MAGNIFIED and moved > 0.1 * before) or not moved < 1e100:
                break
            before = moved
        if not moved <= MAGNIFIED * (1.0 if level == POSITION else 1.0 + largest(state.v, 0, n)):
            return False
        if len(dstates.x) > 0:
            _project_along_at(tools.project_along, problem, level, models.directions, t, within, state, dstates, tools)
    return True


_project_along_at = project_along.at
