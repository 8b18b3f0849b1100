"""States that satisfy the equations of motion and the constraints at the levels of velocity and acceleration."""

import numpy as np

from dalembert.multibody.integrators.lifting import lift, set_signals
from dalembert.multibody.kernels.assembly import constraint_rates, residual, tangent
from dalembert.multibody.kernels.compiled import compiled, template
from dalembert.multibody.kernels.dual import STEP
from dalembert.multibody.kernels.linear import factorise, solve
from dalembert.multibody.kernels.model import select
from dalembert.multibody.kernels.motion import row, subtract


@template
def _initial_matrix(problem, dual, state, dual_work, constraints, exact):
    """Factorised matrix of motion beside the constraints at acceleration level; whether it is regular."""
    arguments = (dual, problem.exact_slots, problem.n, state.x, state.v, state.a)
    tangent(*arguments, (1.0, 0.0, 0.0), (0.0, 1.0), dual_work, constraints)
    tangent(*arguments, (0.0, 0.0, 1.0), (1.0, 0.0), dual_work, exact.matrix)
    for i in range(len(constraints)):
        exact.matrix[i] += constraints[i]
    return factorise(problem.exact_layout, exact)


@compiled
def accelerate(problem, model, dual, directions, t, within, state, dstates, work, dual_work, lifted, exact):
    """Accelerations and multipliers that satisfy the equations of motion, and their derivatives.

    Where the problem says so, the velocities are first moved onto the constraints, by the smallest kinetic energy.
    """
    n, last = problem.n, len(state.x) - 1
    delta, answer, rate, second = np.zeros(last + 1), np.zeros(last + 1), np.zeros(last + 1), np.zeros(last + 1)
    constraints = np.zeros(len(exact.matrix))
    set_signals(model, t, within, work)
    set_signals(dual, t, within, dual_work)
    for iteration in range(6):  # linear but for friction that depends on the multipliers
        # The last correction is rounding: the derivatives below are taken with the matrix of the state that it leaves.
        if iteration < 5 and not _initial_matrix(problem, dual, state, dual_work, constraints, exact):
            return False
        if iteration == 0 and problem.projected:
            _project(problem, model, directions, t, within, state, dstates, work, dual_work, lifted, exact)
        residual(model, n, state.x, state.v, state.a, work, 1.0, delta)
        constraint_rates(model, n, state.x, state.v, state.a, work, rate, second)
        for i in range(n, last):
            delta[i] = second[i]
        solve(problem.exact_layout, exact, delta, answer)
        subtract(n, answer, state)
    r, drate, dsecond = lifted[3], lifted[4], lifted[5]
    for d in range(len(dstates.x)):
        tilted, dstate = select(directions, d), row(dstates, d)
        set_signals(tilted, t, within, dual_work)
        lift(n, state, dstate, lifted)
        residual(tilted, n, lifted[0], lifted[1], lifted[2], dual_work, 1.0, r)
        constraint_rates(tilted, n, lifted[0], lifted[1], lifted[2], dual_work, drate, dsecond)
        for i in range(last):
            delta[i] = (r[i].imag if i < n else dsecond[i].imag) / STEP
        solve(problem.exact_layout, exact, delta, answer)
        subtract(n, answer, dstate)
    return True


@template
def _project(problem, model, directions, t, within, state, dstates, work, dual_work, lifted, exact):
    """Velocities on the constraints, v - w with M w + J^T m = 0 and J w = rate of the constraints, and derivatives."""
    n, last = problem.n, len(state.x) - 1
    w, answer, rate, second = np.zeros(last + 1), np.zeros(last + 1), np.zeros(last + 1), np.zeros(last + 1)
    constraint_rates(model, n, state.x, state.v, state.a, work, rate, second)
    solve(problem.exact_layout, exact, rate, w)
    for i in range(n):
        state.v[i] -= w[i]
    forces, still, drate, dsecond = lifted[3], lifted[4], lifted[5], lifted[6]
    for d in range(len(dstates.x)):
        tilted, dstate = select(directions, d), row(dstates, d)
        set_signals(tilted, t, within, dual_work)
        lift(n, state, dstate, lifted)
        constraint_rates(tilted, n, lifted[0], lifted[1], lifted[2], dual_work, drate, dsecond)
        for i in range(last + 1):
            lifted[1, i] = 0.0
            lifted[2, i] = w[i] if i < n else 0.0
            if i >= n:
                lifted[0, i] = w[i]
        residual(tilted, n, lifted[0], lifted[1], lifted[2], dual_work, 1.0, forces)
        for i in range(last + 1):
            lifted[2, i] = 0.0
            if i >= n:
                lifted[0, i] = 0.0
        residual(tilted, n, lifted[0], lifted[1], lifted[2], dual_work, 1.0, still)
        for i in range(last):
            answer[i] = (forces[i].imag - still[i].imag if i < n else -drate[i].imag) / STEP
        solve(problem.exact_layout, exact, answer, rate)
        for i in range(n):
            dstate.v[i] += rate[i]
