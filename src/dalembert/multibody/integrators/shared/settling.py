"""States moved onto the constraints, level by level, with one factorised [M, J^T; J, 0] that may be a little old.

Coordinates and velocities are moved by the smallest amount in the metric of the mass: M w + J^T m = 0. Accelerations
and multipliers follow from the equations of motion. Newton's iteration corrects what the factorisation does not know,
for derivatives, too: they are iterated after the state, with the same factorisation.
"""

from dalembert.kernels.kernel import inner, kernel
from dalembert.kernels.words import Address, Reals2
from dalembert.multibody.integrators.shared.matrices import Matrices, add_inertia
from dalembert.multibody.integrators.shared.problem import ACCELERATION, POSITION, VELOCITY, IntegrationProblem
from dalembert.multibody.kernels.assembly import constraint_forces, constraint_rates, residual
from dalembert.multibody.kernels.elementary import size_of
from dalembert.multibody.kernels.linear import solve
from dalembert.multibody.kernels.linear_lanes import solve_slopes
from dalembert.multibody.kernels.slopes import joined, maximum, perturb, share_of, slope_of
from dalembert.multibody.kernels.states import MotionState

MOST_ITERATIONS = 25
_ROUNDING = 2e-16  # of the largest entry, below which an error is left
LOOSE = 1e-9  # the same where corrections stop to shrink
_NOTHING = 1e-13  # of velocities or coordinates: corrections below it are rounding
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
    """The same along directions: what inertia and constraint forces change in the residual of the system at rest."""
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
def weigh_slopes(perturbed, n, matrices, x, w, dw, size, work, numbers, slopes):
    """Fill ``slopes`` (N + 1,) with those of M w + J^T m and of the constraints, along directions, for w = (w, m).

    ``x`` (N + 1,) are coordinates of the model along directions, ``dw`` the slopes of w, ``numbers`` (5, N + 1)
    workspace, and ``size`` that of the velocities or coordinates that w corrects.
    """
    # Joints alone give J^T m and the constraints, the kept masses M dw.
    f, at = numbers[0], numbers[1]
    for i in range(len(f)):
        f[i] = 0.0
        at[i] = x[i] if i < n else joined(w[i], dw[i])
    constraint_forces(perturbed, at, at, at, work, f)
    for i in range(len(f)):
        slopes[i] = slope_of(f[i])
    add_inertia(matrices, dw, slopes)
    # Slopes of the masses count where w is larger than rounding, as where a step leaves the constraints.
    if largest(w, 0, n) > _NOTHING * size:
        for i in range(len(f)):
            at[i] = w[i] if i < n else 0.0
        weigh_along(perturbed, n, x, at, work, numbers[2:], f)
        for i in range(n):
            slopes[i] += slope_of(f[i])


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


@inner
def settle_along(problem, matrices, perturbed, state, dstate, moved, work, first, numbers, slopes):
    """Derivatives of a settled state along directions, from those of the state before; signals in ``work``.

    ``moved`` are the moves as `settle` left them; ``numbers`` (8, N + 1) and ``slopes`` (4, N + 1) are workspace.
    """
    n, last = problem.n, len(state.x) - 1
    dmoved, answer, change = slopes, slopes[2], slopes[3]
    f, rate, second = numbers[3], numbers[4], numbers[5]
    for i in range(last + 1):
        dmoved[0, i] = dmoved[1, i] = 0.0
    for level in range(first if last > n else ACCELERATION, 3):
        before, size = 0.0, largest(state.x if level == POSITION else state.v, 0, n)
        for iteration in range(MOST_ITERATIONS):
            perturb(n, state, dstate, numbers)
            if level < 2:
                weigh_slopes(
                    perturbed, n, matrices, numbers[0], moved[level], dmoved[level], size, work, numbers[3:], change
                )
            else:
                residual(perturbed, n, numbers[0], numbers[1], numbers[2], work, 1.0, f)
                for i in range(n):
                    change[i] = slope_of(f[i])
            if level > 0:
                constraint_rates(perturbed, n, numbers[0], numbers[1], numbers[2], work, rate, second)
                for i in range(n, last):
                    change[i] = slope_of(rate[i]) if level == 1 else slope_of(second[i])
            solve_slopes(matrices.pattern.layout, matrices.rigid, change, answer)
            move(n, level, answer, dstate, dmoved)
            norm = _share(n, level, answer, dstate, dmoved)
            if finished(iteration, norm, before, 1.0) or not norm < 1e100:
                break
            before = norm


@inner
def _share(n, level, answer, dstate, dmoved):
    """Largest correction of slopes as a part of the largest entry that it corrects, or of its move."""
    values = dstate.x if level == POSITION else (dstate.v if level == VELOCITY else dstate.a)
    # In lanes each direction has its own size; the largest share decides for all.
    norm, size = 0.0 * values[n], 0.0 * values[n]
    for i in range(n):
        norm, size = maximum(norm, size_of(answer[i])), maximum(size, size_of(values[i]))
        if level < ACCELERATION:
            size = maximum(size, size_of(dmoved[level, i]))
    return share_of(norm, size)
