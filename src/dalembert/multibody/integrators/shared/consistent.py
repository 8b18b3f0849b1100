"""States that satisfy the equations of motion and the constraints at the levels of velocity and acceleration.

Accelerations and multipliers solve M a + J^T l = Q together with Phi'' = 0: the system of `docs/theory/index-1.md`
without feedback, for starts, jumps of loads, and projected velocities.
"""

from typing import NamedTuple

import numpy as np

from dalembert.kernels.kernel import inner, kernel
from dalembert.kernels.words import Address, Integers, Reals, Reals2
from dalembert.multibody.integrators.shared.problem import IntegrationProblem, SampleModels
from dalembert.multibody.integrators.shared.settling import weigh_along
from dalembert.multibody.kernels.assembly import constraint_rates, residual, set_signals, tangent
from dalembert.multibody.kernels.linear import Factors, factorise, solve, storage
from dalembert.multibody.kernels.linear_lanes import solve_slopes
from dalembert.multibody.kernels.slopes import (
    Number,
    SlopeWork,
    along_kernels,
    arrays_of,
    perturb,
    read_states,
    slope_of,
    slope_work,
    state_of,
    write_states,
)
from dalembert.multibody.kernels.states import MotionState, MotionStates, clear, subtract


class Consistency(NamedTuple):
    """Work of consistent accelerations: calls in real numbers and along directions, a matrix, and vectors.

    ``along``: address of the kernel for the derivatives, 0 if there are none.
    """

    work: Address
    complex_work: Address
    exact: Factors
    constraints: Reals
    vectors: Reals2
    slopes: SlopeWork
    along: Address


def consistency(
    problem: IntegrationProblem, work: int, along_work: int, directions: int, together: bool = False
) -> Consistency:
    """Workspace for consistent accelerations, with derivatives along directions one by one, or ``together``."""
    exact, width = storage(problem.exact_layout), problem.exact_layout.size + 1
    kernel = accelerate_together if together else accelerate_along
    constraints, vectors = np.zeros(len(exact.matrix)), np.zeros((4, width))
    slopes = slope_work(width, 6, 9, together)
    return Consistency(work, along_work, exact, constraints, vectors, slopes, kernel.address if directions else 0)


@inner
def fill_motion(problem, tangent_model, state, work, constraints, matrix):
    """Fill ``matrix`` with that of motion beside the Jacobian of the constraints, which ``constraints`` then holds.

    It is taken at the time that the signals in ``work``, a call in complex numbers, hold.
    """
    slots, n, x, v, a = problem.exact_slots, problem.n, state.x, state.v, state.a
    # The constraint rows alone, by the coordinates: J, and with the multipliers of the motion rows J^T by symmetry.
    tangent(tangent_model, slots, n, x, v, a, (1.0, 0.0, 0.0), (0.0, 1.0), work, constraints)
    add_masses(problem, tangent_model, state, work, constraints, matrix)


@inner
def add_masses(problem, tangent_model, state, work, constraints, matrix):
    """Fill ``matrix`` with that of motion beside the Jacobian in ``constraints``."""
    slots, n, x, v, a = problem.exact_slots, problem.n, state.x, state.v, state.a
    # The motion rows alone, by the accelerations and multipliers: M and J^T.
    tangent(tangent_model, slots, n, x, v, a, (0.0, 0.0, 1.0), (1.0, 0.0), work, matrix)
    for i in range(len(constraints)):
        matrix[i] += constraints[i]


@kernel
def accelerate(
    problem: IntegrationProblem,
    models: SampleModels,
    t: float,
    within: float,
    state: MotionState,
    dstates: MotionStates,
    c: Consistency,
) -> bool:
    """Accelerations and multipliers that satisfy the equations of motion, and their derivatives. Where the problem says
    so, the velocities are first moved onto the constraints, by the smallest kinetic energy: v - w with M w + J^T m = 0
    and J w = rate of the constraints.
    """
    n = problem.n
    delta, answer, rate, w = c.vectors[0], c.vectors[1], c.vectors[2], c.vectors[3]
    set_signals(models.real, t, within, c.work)
    set_signals(models.tangents, t, within, c.complex_work)
    for iteration in range(6):  # linear but for friction that depends on the multipliers
        # The last correction is rounding: the derivatives below are taken with the matrix of the state that it leaves.
        if iteration < 5:
            fill_motion(problem, models.tangents, state, c.complex_work, c.constraints, c.exact.matrix)
            if not factorise(problem.exact_layout, c.exact):
                return False
        if iteration == 0 and problem.projected:
            # The right side has no forces: only the rates of the constraints, J v + Phi_t.
            clear(rate)
            constraint_rates(models.real, n, state.x, state.v, state.a, c.work, rate, delta)
            solve(problem.exact_layout, c.exact, rate, w)
            for i in range(n):
                state.v[i] -= w[i]
            if len(models.directions) > 0:
                _along_at(c.along, problem, models.directions, t, within, state, dstates, c, True)
        # Rows of motion from the residual, rows of constraints from their second rates: the system of index 1.
        residual(models.real, n, state.x, state.v, state.a, c.work, 1.0, delta)
        constraint_rates(models.real, n, state.x, state.v, state.a, c.work, rate, delta)
        solve(problem.exact_layout, c.exact, delta, answer)
        subtract(n, answer, state)
    if len(models.directions) > 0:
        _along_at(c.along, problem, models.directions, t, within, state, dstates, c, False)
    return True


def _accelerate_along(
    like: Number, problem: IntegrationProblem, directions: Integers, t: float, within: float, state: MotionState,
    dstates: MotionStates, c: Consistency, projects: bool,
) -> None:  # fmt: skip
    """Derivatives of consistent accelerations, or (``projects``) of the projected velocities, along all directions."""
    # The rows of a group lie side by side in the work, for as long as it is computed.
    numbers, slopes = arrays_of(like, c.slopes)
    dstate = state_of(slopes)
    for g in range(len(directions)):
        read_states(dstates, g, c.slopes.slopes)
        set_signals(directions[g], t, within, c.complex_work)
        if projects:
            _project_along(problem, directions[g], state, dstate, c, numbers, slopes[4:])
        else:
            differentiate_acceleration(problem, directions[g], state, dstate, c, numbers, slopes[4:])
        write_states(c.slopes.slopes, g, dstates)


accelerate_along, accelerate_together = along_kernels(_accelerate_along)
_along_at = accelerate_along.at


@inner
def differentiate_acceleration(problem, perturbed, state, dstate, c, numbers, slopes):
    """Derivative of accelerations and multipliers along directions, by the matrix in ``c``."""
    n, x, v, a, r, delta, answer = problem.n, numbers[0], numbers[1], numbers[2], numbers[3], slopes[0], slopes[1]
    # The equations are linear in accelerations and multipliers: one solution is the derivative.
    perturb(n, state, dstate, numbers)
    residual(perturbed, n, x, v, a, c.complex_work, 1.0, r)
    constraint_rates(perturbed, n, x, v, a, c.complex_work, numbers[4], r)
    for i in range(len(state.x) - 1):
        delta[i] = slope_of(r[i])
    solve_slopes(problem.exact_layout, c.exact, delta, answer)
    subtract(n, answer, dstate)


@inner
def _project_along(problem, perturbed, state, dstate, c, numbers, slopes):
    """The derivative of v - w, by the equations of the projection."""
    n, w, x, drate, f, weighed = problem.n, c.vectors[3], numbers[0], numbers[3], numbers[4], numbers[5]
    perturb(n, state, dstate, numbers)
    constraint_rates(perturbed, n, x, numbers[1], numbers[2], c.complex_work, drate, f)
    for i in range(len(w)):
        weighed[i] = w[i]
    weigh_along(perturbed, n, x, weighed, c.complex_work, numbers[6:], f)
    for i in range(len(w) - 1):
        slopes[0][i] = slope_of(f[i]) if i < n else -slope_of(drate[i])
    solve_slopes(problem.exact_layout, c.exact, slopes[0], slopes[1])
    for i in range(n):
        dstate.v[i] += slopes[1][i]
