"""States that satisfy the equations of motion and the constraints at the levels of velocity and acceleration.

Accelerations and multipliers solve M a + J^T l = Q together with Phi'' = 0: the system of `docs/theory/index-1.md`
without feedback, for starts, jumps of loads, and projected velocities.
"""

from typing import NamedTuple

import numpy as np

from dalembert.kernels.kernel import inlined, inner, kernel
from dalembert.kernels.words import Address, Complexes2, Integers, Reals, Reals2
from dalembert.multibody.integrators.problem import Models, Problem
from dalembert.multibody.kernels.assembly import constraint_rates, residual, set_signals, tangent
from dalembert.multibody.kernels.elementary import STEP
from dalembert.multibody.kernels.linear import Factors, factorise, solve, storage
from dalembert.multibody.kernels.motion import MotionState, MotionStates, perturb, row, subtract


class Consistency(NamedTuple):
    """Work of consistent accelerations: calls in real and in complex numbers, a matrix, and vectors.

    ``along``: address of the kernel for the derivatives, 0 if there are none.
    """

    work: Address
    complex_work: Address
    exact: Factors
    constraints: Reals
    vectors: Reals2
    complex_state: Complexes2
    along: Address


def consistency(problem: Problem, work: int, complex_work: int, directions: int) -> Consistency:
    """Room for consistent accelerations."""
    exact, width = storage(problem.exact_layout), problem.exact_layout.size + 1
    along = accelerate_along.address if directions else 0
    constraints, vectors = np.zeros(len(exact.matrix)), np.zeros((5, width))
    return Consistency(work, complex_work, exact, constraints, vectors, np.zeros((7, width), complex), along)


@inlined
def _initial_matrix(problem, complex_model, state, c):
    """Factorised matrix of motion beside the constraints at acceleration level; whether it is regular."""
    slots, n = problem.exact_slots, problem.n
    tangent(
        complex_model, slots, n, state.x, state.v, state.a, (1.0, 0.0, 0.0), (0.0, 1.0), c.complex_work, c.constraints
    )
    tangent(
        complex_model, slots, n, state.x, state.v, state.a, (0.0, 0.0, 1.0), (1.0, 0.0), c.complex_work, c.exact.matrix
    )
    for i in range(len(c.constraints)):
        c.exact.matrix[i] += c.constraints[i]
    return factorise(problem.exact_layout, c.exact)


@kernel
def accelerate(
    problem: Problem, models: Models, t: float, within: float, state: MotionState, dstates: MotionStates, c: Consistency
) -> bool:
    """Accelerations and multipliers that satisfy the equations of motion, and their derivatives.

    Where the problem says so, the velocities are first moved onto the constraints, by the smallest kinetic energy:
    v - w with M w + J^T m = 0 and J w = rate of the constraints.
    """
    n, last = problem.n, len(state.x) - 1
    delta, answer, rate, second, w = c.vectors[0], c.vectors[1], c.vectors[2], c.vectors[3], c.vectors[4]
    set_signals(models.real, t, within, c.work)
    set_signals(models.complex, t, within, c.complex_work)
    for iteration in range(6):  # linear but for friction that depends on the multipliers
        # The last correction is rounding: the derivatives below are taken with the matrix of the state that it leaves.
        if iteration < 5 and not _initial_matrix(problem, models.complex, state, c):
            return False
        if iteration == 0 and problem.projected:
            for i in range(last + 1):
                rate[i] = 0.0
            constraint_rates(models.real, n, state.x, state.v, state.a, c.work, rate, second)
            for i in range(n):
                rate[i] = 0.0
            solve(problem.exact_layout, c.exact, rate, w)
            for i in range(n):
                state.v[i] -= w[i]
            if len(models.directions) > 0:
                _along_at(c.along, problem, models.directions, t, within, state, dstates, c, True)
        residual(models.real, n, state.x, state.v, state.a, c.work, 1.0, delta)
        constraint_rates(models.real, n, state.x, state.v, state.a, c.work, rate, second)
        for i in range(n, last):
            delta[i] = second[i]
        solve(problem.exact_layout, c.exact, delta, answer)
        subtract(n, answer, state)
    if len(models.directions) > 0:
        _along_at(c.along, problem, models.directions, t, within, state, dstates, c, False)
    return True


@kernel
def accelerate_along(
    problem: Problem, directions: Integers, t: float, within: float, state: MotionState, dstates: MotionStates,
    c: Consistency, projects: bool,
) -> None:  # fmt: skip
    """Derivatives of consistent accelerations, or (``projects``) of the projected velocities, along all directions."""
    for d in range(len(directions)):
        set_signals(directions[d], t, within, c.complex_work)
        if projects:
            _project_along(problem, directions[d], state, row(dstates, d), c)
        else:
            _accelerate_along(problem, directions[d], state, row(dstates, d), c)


_along_at = accelerate_along.at


@inner
def _accelerate_along(problem, perturbed, state, dstate, c):
    n, last, complex_state = problem.n, len(state.x) - 1, c.complex_state
    delta, answer, r, rates, seconds = c.vectors[0], c.vectors[1], complex_state[3], complex_state[4], complex_state[5]
    perturb(n, state, dstate, complex_state)
    residual(perturbed, n, complex_state[0], complex_state[1], complex_state[2], c.complex_work, 1.0, r)
    constraint_rates(perturbed, n, complex_state[0], complex_state[1], complex_state[2], c.complex_work, rates, seconds)
    for i in range(last):
        delta[i] = (r[i].imag if i < n else seconds[i].imag) / STEP
    solve(problem.exact_layout, c.exact, delta, answer)
    subtract(n, answer, dstate)


@inner
def _project_along(problem, perturbed, state, dstate, c):
    """The derivative of v - w, by the equations of the projection in complex numbers."""
    n, last, complex_state, w = problem.n, len(state.x) - 1, c.complex_state, c.vectors[4]
    answer, rate = c.vectors[1], c.vectors[2]
    forces, still, drate, dsecond = complex_state[3], complex_state[4], complex_state[5], complex_state[6]
    perturb(n, state, dstate, complex_state)
    constraint_rates(perturbed, n, complex_state[0], complex_state[1], complex_state[2], c.complex_work, drate, dsecond)
    for i in range(last + 1):
        complex_state[1, i] = 0.0
        complex_state[2, i] = w[i] if i < n else 0.0
        if i >= n:
            complex_state[0, i] = w[i]
    residual(perturbed, n, complex_state[0], complex_state[1], complex_state[2], c.complex_work, 1.0, forces)
    for i in range(last + 1):
        complex_state[2, i] = 0.0
        if i >= n:
            complex_state[0, i] = 0.0
    residual(perturbed, n, complex_state[0], complex_state[1], complex_state[2], c.complex_work, 1.0, still)
    for i in range(last):
        answer[i] = (forces[i].imag - still[i].imag if i < n else -drate[i].imag) / STEP
    solve(problem.exact_layout, c.exact, answer, rate)
    for i in range(n):
        dstate.v[i] += rate[i]
