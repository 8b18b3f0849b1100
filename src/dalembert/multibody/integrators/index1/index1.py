"""The equations of index 1: accelerations and multipliers that the state of a mechanism demands.

[M, J^T; J, 0] [a; l] = [Q; -(J v)_q v - 2 J_t v - Phi_tt - 2 alpha Phi' - beta^2 Phi] (`docs/theory/index-1.md`).
"""

from typing import NamedTuple

from dalembert.kernels.kernel import inner, kernel
from dalembert.kernels.words import Address, Integers, Reals
from dalembert.multibody.integrators.index1.least_squares import (
    Surplus,
    invert_on_range,
    keep_in_range,
    turn_range,
)
from dalembert.multibody.integrators.shared.consistent import fill_motion
from dalembert.multibody.integrators.shared.partitioning import Partition
from dalembert.multibody.integrators.shared.problem import IntegrationProblem, SampleModels
from dalembert.multibody.integrators.shared.settling import balanced, largest
from dalembert.multibody.kernels.assembly import constraint_rates, residual, set_signals
from dalembert.multibody.kernels.linear import Factors, factorise
from dalembert.multibody.kernels.linear import solve as solve_linear
from dalembert.multibody.kernels.linear_lanes import solve_slopes
from dalembert.multibody.kernels.slopes import (
    Number,
    SlopeWork,
    along_kernels,
    arrays_of,
    one,
    perturb,
    read_states,
    slope_of,
    state_of,
    write_states,
)
from dalembert.multibody.kernels.states import MotionState, MotionStates, row, subtract

AS_THEY_COME, PROJECTED, PARTITIONED = range(3)  # what is done about positions and velocities off the constraints
_MOST_ITERATIONS = 12
_QUADRATIC = 1e-9  # relative correction after which a quadratic iteration is at rounding


class Terms(NamedTuple):
    """Feedback of the constraints (1/s), whether they are redundant, what is done about drift, and a limit for it.

    ``nonlinear``: whether a friction depends on the multipliers.
    """

    alpha: float
    beta: float
    redundant: bool
    way: int
    limit: float
    nonlinear: bool


class Tools(NamedTuple):
    """Work of the index-1 methods, made once a run. ``work``, ``complex_work``: calls in real and in complex numbers.
    ``partition`` is that of the coordinates; ``surplus`` serves redundant constraints, ``base`` and ``change``
    projections. ``along``: address of the kernel for derivatives, 0 if there are none. The last four are addresses of
    kernels that only some stabilisations need, else 0.
    """

    work: Address
    complex_work: Address
    exact: Factors
    slopes: SlopeWork
    gap: Reals
    answer: Reals
    second: Reals
    still: Reals
    partition: Partition
    surplus: Surplus
    base: MotionState
    change: MotionState
    along: Address
    choose: Address
    settle: Address
    project: Address
    project_along: Address


@inner
def factorise_motion(problem, terms, tangent_model, state, tools):
    """Factorise the matrix of motion beside that of the constraints; whether it is regular.

    It is taken in the time that the signals in ``tools.complex_work`` hold.
    """
    matrix = tools.exact.matrix
    fill_motion(problem, tangent_model, state, tools.complex_work, tools.surplus.partition.matrix, matrix)
    if terms.redundant:
        return _invert_at(tools.surplus.invert, problem, tools.surplus, matrix)
    return factorise(problem.exact_layout, tools.exact)


@inner
def _fill_gap(model, n, terms, x, v, a, work, gap, rate, second):
    """Residuals: M a + J^T l - Q, and Phi'' + 2 alpha Phi' + beta^2 Phi for the constraints."""
    residual(model, n, x, v, a, work, 1.0, gap)
    constraint_rates(model, n, x, v, a, work, rate, second)
    for i in range(n, len(gap) - 1):
        # Baumgarte's feedback: errors of the constraints decay as those of a damped oscillator. Without feedback both
        # factors are zero.
        gap[i] = second[i] + 2.0 * terms.alpha * rate[i] + terms.beta * terms.beta * gap[i]


@inner
def _rests(problem, model, state, tools):
    """Whether accelerations are nothing but rounding of forces in balance."""
    residual(model, problem.n, state.x, state.v, state.a, tools.work, 1.0, tools.gap)
    return balanced(model, problem.n, state, tools.work, tools.gap, tools.answer, tools.second, tools.still)


@kernel
def demand(
    problem: IntegrationProblem, terms: Terms, models: SampleModels, t: float, within: float, state: MotionState,
    dstates: MotionStates,
    tools: Tools,
) -> bool:  # fmt: skip
    """Fill accelerations and multipliers of a state by the equations of index 1, and their derivatives; whether it can.
    [M J^T; J 0] [a; l] = [f; -(second rate without a) - 2 alpha (first rate) - beta^2 (constraint)]. The equations are
    linear in both but for friction that depends on the multipliers; the state's own ones are the first guess.
    """
    n, last, nonlinear = problem.n, len(state.x) - 1, terms.nonlinear
    set_signals(models.real, t, within, tools.work)
    set_signals(models.tangents, t, within, tools.complex_work)
    moved = 1.0
    for iteration in range(_MOST_ITERATIONS if nonlinear else 2):  # linear: once more for rounding
        # Friction that depends on the multipliers changes the matrix at each iteration.
        if (iteration == 0 or nonlinear) and not factorise_motion(problem, terms, models.tangents, state, tools):
            return False
        if iteration == 0 and terms.redundant:
            # Multipliers of least norm: the part of the first guess that redundant constraints do not see is removed.
            keep_in_range(problem, tools.surplus, state)
        _fill_gap(models.real, n, terms, state.x, state.v, state.a, tools.work, tools.gap, tools.answer, tools.second)
        solve_linear(problem.exact_layout, tools.exact, tools.gap, tools.answer)
        subtract(n, tools.answer, state)
        moved = max(
            largest(tools.answer, 0, n) / (largest(state.a, 0, n) + 1e-300),
            largest(tools.answer, n, last) / (largest(state.x, n, last) + 1e-300),
        )
        # The iteration is quadratic: what is left after this correction is its square.
        if iteration > 0 and moved <= _QUADRATIC:
            break
    if not largest(state.a, 0, n) + largest(state.x, n, last) < 1e100:
        return False
    if nonlinear and not moved <= 1e-6 and not _rests(problem, models.real, state, tools):
        return False
    if len(dstates.x) > 0:
        _demand_along_at(tools.along, problem, terms, models.directions, t, within, state, dstates, tools)
    return True


def _demand_along(
    like: Number, problem: IntegrationProblem, terms: Terms, directions: Integers, t: float, within: float,
    state: MotionState, dstates: MotionStates, tools: Tools,
) -> None:  # fmt: skip
    """Derivatives of the accelerations and multipliers that a state demands, along all directions."""
    n, last, (numbers, slopes) = problem.n, len(state.x) - 1, arrays_of(like, tools.slopes)
    dstate, gap, answer = state_of(slopes), slopes[4], slopes[5]
    for g in range(len(directions)):
        set_signals(directions[g], t, within, tools.complex_work)
        if terms.redundant:  # then directions are taken one by one
            _turn_at(
                tools.surplus.turn, problem, directions[g], state, row(dstates, g), tools.complex_work,
                one(tools.slopes)[0], tools.surplus,
            )  # fmt: skip
        # Linear in accelerations and multipliers, by the matrix of the state: no iteration.
        read_states(dstates, g, tools.slopes.slopes)
        perturb(n, state, dstate, numbers)
        _fill_gap(
            directions[g], n, terms, numbers[0], numbers[1], numbers[2], tools.complex_work, numbers[3], numbers[4],
            numbers[5],
        )  # fmt: skip
        for i in range(last):
            gap[i] = slope_of(numbers[3][i])
        solve_slopes(problem.exact_layout, tools.exact, gap, answer)
        subtract(n, answer, dstate)
        write_states(tools.slopes.slopes, g, dstates)


demand_along, demand_together = along_kernels(_demand_along)
_invert_at, _turn_at = invert_on_range.at, turn_range.at
_demand_along_at = demand_along.at
