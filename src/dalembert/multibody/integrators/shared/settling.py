"""States moved onto the constraints, level by level, with one factorised [M, J^T; J, 0] that may be a little old.

Coordinates and velocities are moved by the smallest amount in the metric of the mass: M w + J^T m = 0. Accelerations
and multipliers follow from the equations of motion. Newton's iteration corrects what the factorisation does not know,
for derivatives, too: they are iterated after the state, with the same factorisation.
"""

from dalembert.kernels.kernel import inner, kernel
from dalembert.kernels.words import Address, Complexes2, Reals2
from dalembert.multibody.integrators.shared.matrices import Matrices, add_inertia
from dalembert.multibody.integrators.shared.problem import ACCELERATION, POSITION, VELOCITY, IntegrationProblem
from dalembert.multibody.kernels.assembly import constraint_forces, constraint_rates, residual
from dalembert.multibody.kernels.elementary import STEP
from dalembert.multibody.kernels.linear import solve
from dalembert.multibody.kernels.states import MotionState, perturb

MOST_ITERATIONS = 25
_ROUNDING = 2e-16  # of the largest entry, below which an error is left
LOOSE = 1e-9  # the same where corrections stop to shrink
_ROUGH = 1e-5  # the same of a correction, after which the error is smaller by the contraction


@inner
def weigh(model, n, matrices, x, w, work, f, at):
    """Fill ``f`` (N + 1,): M w + J^T m in its first n entries, for w = (w, m), and the constraints behind them.

    ``at`` (N + 1,) is workspace.
    """
    for i in range(len(f)):
        f[i] = 0.0
        at[i] = x[i] if i < n else w[i]
    add_inertia(matrices, w, f)
    constraint_forces(model, at, at, at, work, f)  # which depend on coordinates and multipliers alone


@inner
def weigh_along(model, n, x, w, work, buffers, f):
    """The same in complex numbers: what inertia and constraint forces change in the residual of the system at rest."""
    # M w + J^T m from the residual of the system at rest with the accelerations w and multipliers m, less that without
    # both.
    still, at = buffers[0], buffers[1]
    for i in range(len(f)):
        still[i] = 0.0
        at[i] = x[i] if i < n else w[i]
    residual(model, n, at, still, w, work, 1.0, f)
    for i in range(n, len(f)):
        at[i] = 0.0
    residual(model, n, at, still, still, work, 1.0, buffers[2])
    for i in range(n):
        f[i] -= buffers[2, i]


@inner
def move(n, level, answer, state, moved):
    """Take a correction off a state, and off the move of its level so far."""
    values = state.x if level == POSITION else (state.v if level == VELOCITY else state.a)
    for i in range(len(state.x) - 1):
        if level < ACCELERATION:
            moved[level, i] -= answer[i]
        if i < n:
            values[i] -= answer[i]
        elif level == ACCELERATION:
            state.x[i] -= answer[i]


@inner
def _sizes(n, level, answer, state, moved):
    """Largest correction, and largest entry of what it corrects, or of its move: one that vanishes ends in rounding."""
    values, size = state.x if level == POSITION else (state.v if level == VELOCITY else state.a), 1e-300
    for i in range(n):
        size = max(size, abs(values[i]))
        if level < ACCELERATION:
            size = max(size, abs(moved[level, i]))
    return largest(answer, 0, n), size


@inner
def finished(iteration, norm, before, size):
    """Whether what remains is rounding, by the contraction seen."""
    if norm <= _ROUNDING * size:
        return True
    if iteration == 0:
        return False
    # It converges linearly at best, by the age of the factorisation; half of that and it is rounding.
    if norm >= 0.5 * before:
        return iteration > 1 and norm <= LOOSE * size
    # norm rate / (1 - rate) with rate = norm / before, without a division.
    return norm * norm <= (before - norm) * _ROUNDING * size


@inner
def largest(values, begin, end):
    """Largest size of some entries; not a number if one is none."""
    size = 0.0
    for i in range(begin, end):
        if size == size and not abs(values[i]) <= size:  # the first that is not a number stays
            size = abs(values[i])
    return size


@inner
def balanced(model, n, state, work, f, unheld, at, still):
    """Whether what is left of the equations of motion is rounding against their forces, as of a mechanism at rest. Its
    accelerations are nothing but rounding, so that no correction is small against them. Forces without those of the
    joints show it at rest, those at zero velocity where a drive turns steadily against its dampers. ``f`` is what is
    left, the other vectors (N + 1,) are workspace.
    """
    for i in range(len(at)):
        at[i], still[i] = state.x[i] if i < n else 0.0, 0.0
    residual(model, n, at, state.v, state.a, work, 1.0, unheld)
    moving = largest(unheld, 0, n)
    # At zero velocity: a drive that turns steadily has no forces left with its dampers.
    residual(model, n, at, still, still, work, 1.0, unheld)
    return largest(f, 0, n) <= LOOSE * max(moving, largest(unheld, 0, n))


@kernel
def settle(
    problem: IntegrationProblem,
    matrices: Matrices,
    model: Address,
    state: MotionState,
    moved: Reals2,
    work: Address,
    first: int,
) -> bool:
    """Accelerations and multipliers of a state; if ``first`` says so, coordinates and velocities are moved before. The
    signals in ``work`` hold the time. ``moved`` (6, N + 1) are the moves of coordinates and velocities with their
    multipliers, and workspace. Answers whether the iteration converged.
    """
    n, last = problem.n, len(state.x) - 1
    f, rate, second, answer = moved[2], moved[3], moved[4], moved[5]
    for i in range(last + 1):
        moved[0, i] = moved[1, i] = 0.0
    for level in range(first if last > n else ACCELERATION, 3):
        before, done = 0.0, False
        for iteration in range(MOST_ITERATIONS):
            if level < 2:
                weigh(model, n, matrices, state.x, moved[level], work, f, second)
            else:
                residual(model, n, state.x, state.v, state.a, work, 1.0, f)
            if level > 0:
                constraint_rates(model, n, state.x, state.v, state.a, work, rate, second)
                for i in range(n, last):
                    f[i] = rate[i] if level == 1 else second[i]
            solve(matrices.pattern.layout, matrices.rigid, f, answer)
            move(n, level, answer, state, moved)
            norm, size = _sizes(n, level, answer, state, moved)
            done = finished(iteration, norm, before, size)
            if done or not norm < 1e100:
                break
            before = norm
        if done or before <= LOOSE * size:
            continue
        if level < ACCELERATION or not balanced(model, n, state, work, f, rate, second, answer):
            return False
    return True


@inner
def accelerate_roughly(problem, matrices, model, state, work, scratch):
    """Accelerations and multipliers of a state, as exactly as an estimate of errors needs; ``scratch`` (4, N + 1)."""
    n, f, answer = problem.n, scratch[0], scratch[3]
    for _ in range(MOST_ITERATIONS):
        residual(model, n, state.x, state.v, state.a, work, 1.0, f)
        constraint_rates(model, n, state.x, state.v, state.a, work, scratch[1], f)
        solve(matrices.pattern.layout, matrices.rigid, f, answer)
        move(n, ACCELERATION, answer, state, scratch)
        norm, size = _sizes(n, ACCELERATION, answer, state, scratch)
        if norm <= _ROUGH * size or not norm < 1e100:
            break


@kernel
def settle_along(
    problem: IntegrationProblem, matrices: Matrices, perturbed: Address, state: MotionState, dstate: MotionState,
    moved: Reals2,
    work: Address, complex_state: Complexes2, first: int,
) -> None:  # fmt: skip
    """Derivative of a settled state along a direction, from that of the state before; signals in ``work``.

    ``moved`` (6, N + 1) are the moves as `settle` left them, and workspace; so is ``complex_state`` (10, N + 1).
    """
    n, last = problem.n, len(state.x) - 1
    dmoved, answer, imaginary = moved[2:4], moved[4], moved[5]
    shift, f, rate, second = complex_state[3], complex_state[4], complex_state[5], complex_state[6]
    for i in range(last + 1):
        dmoved[0, i] = dmoved[1, i] = 0.0
    for level in range(first if last > n else ACCELERATION, 3):
        before = 0.0
        for iteration in range(MOST_ITERATIONS):
            perturb(n, state, dstate, complex_state)
            if level < 2:
                for i in range(last + 1):
                    shift[i] = complex(moved[level, i], STEP * dmoved[level, i])
                weigh_along(perturbed, n, complex_state[0], shift, work, complex_state[7:], f)
            else:
                residual(perturbed, n, complex_state[0], complex_state[1], complex_state[2], work, 1.0, f)
            if level > 0:
                constraint_rates(perturbed, n, complex_state[0], complex_state[1], complex_state[2], work, rate, second)
                for i in range(n, last):
                    f[i] = rate[i] if level == 1 else second[i]
            for i in range(last + 1):
                imaginary[i] = f[i].imag / STEP
            solve(matrices.pattern.layout, matrices.rigid, imaginary, answer)
            move(n, level, answer, dstate, dmoved)
            norm, size = _sizes(n, level, answer, dstate, dmoved)
            if finished(iteration, norm, before, size) or not norm < 1e100:
                break
            before = norm
