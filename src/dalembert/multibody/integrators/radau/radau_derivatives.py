"""Derivatives of the converged steps of Radau IIA along directions, and of the states at the ends of steps."""

from dalembert.kernels.kernel import inner, kernel
from dalembert.kernels.words import Integers
from dalembert.multibody.integrators.radau.radau_coefficients import Coefficients
from dalembert.multibody.integrators.radau.radau_newton import (
    MOST_ITERATIONS,
    correct_coordinates,
    largest,
    take_coordinates,
    take_velocities,
)
from dalembert.multibody.integrators.radau.radau_stages import (
    Buffers,
    Stages,
    begin,
    integrate_stages,
    read,
    set_stage_signals,
)
from dalembert.multibody.integrators.shared.matrices import Matrices
from dalembert.multibody.integrators.shared.outputs import Outputs
from dalembert.multibody.integrators.shared.problem import VELOCITY, IntegrationProblem
from dalembert.multibody.integrators.shared.settling import settle_along, weigh_along
from dalembert.multibody.kernels.assembly import constraint_rates, residual, set_signals
from dalembert.multibody.kernels.elementary import STEP
from dalembert.multibody.kernels.states import MotionState, MotionStates, copy, row, rows


@kernel
def differentiate(
    problem: IntegrationProblem, method: Coefficients, matrices: Matrices, directions: Integers, t: float,
    target: float,
    within: float, s: Stages, dold: MotionState, dnews: MotionStates, ds: Stages, b: Buffers, complex_works: Integers,
) -> None:  # fmt: skip
    """Derivatives of a step along all directions: those of the equations of its stages (`docs/theory/radau.md`)."""
    h = target - t
    for d in range(len(directions)):
        dnew = row(dnews, d)
        copy(dnew, dold)
        set_stage_signals(method, directions[d], t, h, target, within, complex_works)
        _converge_along(problem, method, matrices, directions[d], complex_works, h, s, dold, ds, b)
        read(problem.n, ds, dnew)


@inner
def _converge_along(problem, method, matrices, perturbed, works, h, s, dstart, ds, b):
    """Derivatives ``ds`` of the converged stages along a direction, by the same iteration on imaginary parts."""
    n, size, count = problem.n, len(dstart.x) - 1, len(method.c)
    at = b.complex_state
    # The derivative of the stages solves the same linear system for every direction. Its exact matrix couples all
    # stages, so the split iteration of the step serves again, with the matrices that the step has.
    begin(n, h, method, dstart, ds)
    integrate_stages(n, h, method, dstart, ds)
    before = 0.0
    for _ in range(4 * MOST_ITERATIONS):
        for i in range(count):
            for k in range(size + 1):
                at[0, k] = complex(s.x[i, k], STEP * ds.x[i, k])
                at[1, k] = complex(s.v[i, k], STEP * ds.v[i, k])
                at[2, k] = complex(s.a[i, k], STEP * ds.a[i, k])
                at[3, k] = complex(s.u[i, k] - s.v[i, k], STEP * (ds.u[i, k] - ds.v[i, k]))
                if k >= n:
                    at[3, k] = complex(s.m[i, k], STEP * ds.m[i, k])
            # Exact residuals along the direction by the complex step: the matrices only decide how fast the iteration
            # converges.
            residual(perturbed, n, at[0], at[1], at[2], works[i], 1.0, at[4])
            weigh_along(perturbed, n, at[0], at[3], works[i], at[7:], at[5])
            for k in range(size + 1):
                b.motion[i, k], b.weighed[i, k] = at[4, k].imag / STEP, at[5, k].imag / STEP
        correct_coordinates(n, size, method, matrices, h, b)
        take_coordinates(n, size, h, method, dstart, b, ds)
        for i in range(count):
            for k in range(size + 1):
                at[0, k] = complex(s.x[i, k], STEP * ds.x[i, k])
                at[1, k] = complex(s.v[i, k], STEP * ds.v[i, k])
            constraint_rates(perturbed, n, at[0], at[1], at[2], works[i], at[4], at[5])
            for k in range(size + 1):
                b.rate[i, k] = at[4, k].imag / STEP
        take_velocities(n, size, method, matrices, h, dstart, b, ds)
        norm = largest(n, problem.scale, b.moved)[0]
        length = largest(n, problem.scale, ds.dx)[0]
        # Relative to the derivatives of the coordinates; below 1e-10, corrections that no longer shrink are rounding.
        if norm <= 1e-14 * length or not norm < 1e100 or (norm <= 1e-10 * length and norm > 0.5 * before):
            break
        before = norm


@kernel
def settle_end_along(
    problem: IntegrationProblem, matrices: Matrices, directions: Integers, within: float, scratch: Outputs, j: int
) -> None:
    """Settle the derivatives of end ``j`` along all directions."""
    last, work = scratch.last, scratch.complex_work
    for d in range(len(directions)):
        set_signals(directions[d], last.times[j], within, work)
        state, dstate = row(last.states, j), row(rows(last.derivatives, d), j)
        settle_along(
            problem, matrices, directions[d], state, dstate, scratch.moved, work, scratch.complex_state, VELOCITY
        )
