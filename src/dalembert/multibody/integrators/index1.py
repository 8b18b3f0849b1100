"""The equations of index 1: accelerations and multipliers that the state of a mechanism demands."""

from typing import NamedTuple

import numpy as np

from dalembert.multibody.integrators.least_squares import invert_on_range, range_of, turn_range
from dalembert.multibody.integrators.lifting import lift, set_signals
from dalembert.multibody.integrators.partitioning import Partition, room
from dalembert.multibody.kernels.assembly import constraint_rates, residual, tangent
from dalembert.multibody.kernels.compiled import compiled, kernel, template
from dalembert.multibody.kernels.dual import STEP
from dalembert.multibody.kernels.linear import Factors, factorise, storage
from dalembert.multibody.kernels.linear import solve as solve_linear
from dalembert.multibody.kernels.model import Work, select, workspace
from dalembert.multibody.kernels.motion import Motion, row, still, subtract

AS_THEY_COME, PROJECTED, PARTITIONED = range(3)  # what is done about positions and velocities off the constraints
_MOST_ITERATIONS = 12
_QUADRATIC = 1e-9  # relative correction after which a quadratic iteration is at rounding


class Terms(NamedTuple):
    """Feedback of the constraints (1/s), whether they are redundant, what is done about drift, and a limit for it."""

    alpha: float
    beta: float
    redundant: bool
    way: int
    limit: float


class Tools(NamedTuple):
    """Work of the index-1 methods, made once a run.

    ``partition`` is that of the coordinates; ``surplus`` that of redundant constraints, whose Jacobian's range has the
    ``basis`` (m, m) in its first columns. ``base`` and ``change`` serve projections.
    """

    work: Work
    dual_work: Work
    exact: Factors
    lifted: np.ndarray
    gap: np.ndarray
    answer: np.ndarray
    second: np.ndarray
    partition: Partition
    surplus: Partition
    basis: np.ndarray
    base: Motion
    change: Motion


@template
def make_tools(problem, model, dual):
    """Work for a model."""
    width = problem.exact_layout.size + 1
    m = width - 1 - problem.n
    return Tools(
        workspace(model), workspace(dual), storage(problem.exact_layout), np.zeros((7, width), np.complex128),
        np.zeros(width), np.zeros(width), np.zeros(width), room(problem), room(problem), np.zeros((m, m)),
        still(width), still(width),
    )  # fmt: skip


@compiled
def factorise_motion(problem, terms, dual, state, tools):
    """Factorise the matrix of motion beside that of the constraints; whether it is regular.

    It is taken in the time that the signals in ``tools.dual_work`` hold.
    """
    arguments = (dual, problem.exact_slots, problem.n, state.x, state.v, state.a)
    constraints = tools.surplus.matrix
    tangent(*arguments, (1.0, 0.0, 0.0), (0.0, 1.0), tools.dual_work, constraints)
    tangent(*arguments, (0.0, 0.0, 1.0), (1.0, 0.0), tools.dual_work, tools.exact.matrix)
    for i in range(len(constraints)):
        tools.exact.matrix[i] += constraints[i]
    if terms.redundant:
        basis = range_of(problem, tools.surplus)
        tools.basis[:, : basis.shape[1]] = basis
        return invert_on_range(problem, basis, tools.exact.matrix)
    return factorise(problem.exact_layout, tools.exact)


@kernel
def _fill_gap(model, n, terms, x, v, a, work, gap, rate, second):
    """What the equations of motion and the constraints at the level of acceleration leave."""
    residual(model, n, x, v, a, work, 1.0, gap)
    constraint_rates(model, n, x, v, a, work, rate, second)
    for i in range(n, len(gap) - 1):
        gap[i] = second[i] + 2.0 * terms.alpha * rate[i] + terms.beta * terms.beta * gap[i]


@kernel
def _size(values, begin, end):
    """Largest size of some entries; not a number if one is none."""
    largest = 0.0
    for i in range(begin, end):
        if largest == largest and not abs(values[i]) <= largest:
            largest = abs(values[i])
    return largest


@compiled
def demand(problem, terms, model, dual, directions, t, within, state, dstates, tools):
    """Fill accelerations and multipliers of a state by the equations of index 1, and their derivatives; whether it can.

    [M J^T; J 0] [a; l] = [f; -(second rate without a) - 2 alpha (first rate) - beta^2 (constraint)]. The equations are
    linear in both but for friction that depends on the multipliers; the state's own ones are the first guess.
    """
    n, last = problem.n, len(state.x) - 1
    nonlinear = len(model.frictions.index) > 0
    set_signals(model, t, within, tools.work)
    set_signals(dual, t, within, tools.dual_work)
    moved = 1.0
    for iteration in range(_MOST_ITERATIONS if nonlinear else 2):  # linear: once more for rounding
        if (iteration == 0 or nonlinear) and not factorise_motion(problem, terms, dual, state, tools):
            return False
        _fill_gap(model, n, terms, state.x, state.v, state.a, tools.work, tools.gap, tools.answer, tools.second)
        solve_linear(problem.exact_layout, tools.exact, tools.gap, tools.answer)
        subtract(n, tools.answer, state)
        moved = max(
            _size(tools.answer, 0, n) / (_size(state.a, 0, n) + 1e-300),
            _size(tools.answer, n, last) / (_size(state.x, n, last) + 1e-300),
        )
        if iteration > 0 and moved <= _QUADRATIC:
            break
    if not _size(state.a, 0, n) + _size(state.x, n, last) < 1e100 or (nonlinear and not moved <= 1e-6):
        return False
    r, drate, dsecond = tools.lifted[3], tools.lifted[4], tools.lifted[5]
    for d in range(len(dstates.x)):
        tilted, dstate = select(directions, d), row(dstates, d)
        set_signals(tilted, t, within, tools.dual_work)
        if terms.redundant:
            turn_range(problem, tilted, state, dstate, tools.dual_work, tools.lifted, tools.surplus, tools.basis)
        lift(n, state, dstate, tools.lifted)
        _fill_gap(
            tilted, n, terms, tools.lifted[0], tools.lifted[1], tools.lifted[2], tools.dual_work, r, drate, dsecond
        )
        for i in range(last):
            tools.gap[i] = r[i].imag / STEP
        solve_linear(problem.exact_layout, tools.exact, tools.gap, tools.answer)
        subtract(n, tools.answer, dstate)
    return True
