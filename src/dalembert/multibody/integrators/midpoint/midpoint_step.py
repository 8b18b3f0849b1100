"""One step of the constrained midpoint rule: a discrete Lagrange-d'Alembert equation and its hidden constraints.

The step has two halves of constant acceleration a and b. The forces F are those of the middle, the constraint forces
those of the ends:

    M a + F(q_m, v_m, l_m) + J(q_0)^T l_0 = 0,  constraints (q_1) = 0,  M b + F(q_m, v_m, l_m) + J(q_1)^T l_1 = 0,
    their rates (q_1, v_1) = 0,  v_m = v_0 + h a / 2,  q_1 = q_0 + h v_m,  v_1 = v_m + h b / 2,

with q_m and l_m the means of both ends. Newton's iteration takes the difference of both equations, in which the forces
cancel: so one matrix of the implicit midpoint rule and one projection do.
"""

from typing import NamedTuple

import numpy as np

from dalembert.kernels.kernel import inner, kernel
from dalembert.kernels.words import Address, Complexes2, Reals, Reals2
from dalembert.multibody.integrators.shared.convergence import (
    BALANCED,
    CLOSED,
    MAGNIFIED,
    NOISE,
    ROUNDING,
    largest_entry,
)
from dalembert.multibody.integrators.shared.matrices import Matrices, add_product
from dalembert.multibody.integrators.shared.problem import IntegrationProblem
from dalembert.multibody.integrators.shared.settling import weigh_along
from dalembert.multibody.kernels.assembly import constraint_forces, constraint_rates, residual
from dalembert.multibody.kernels.elementary import STEP
from dalembert.multibody.kernels.linear import solve
from dalembert.multibody.kernels.states import clear

# Rows of a step (8, N + 1): unknowns at its start, in its middle and at its end, velocities there, both accelerations.
X0, XM, X1, V0, VM, V1, A, B = range(8)
ROWS = 8
_MOST_ITERATIONS = 20


class MidpointStep(NamedTuple):
    """Work of a step: calls for its middle and its end, its rows, a force ``push`` (N + 1,) against it, vectors."""

    middle: Address
    end: Address
    rows: Reals2
    push: Reals
    vectors: Reals2


class Along(NamedTuple):
    """Work of the derivative of a step: the same, and in complex numbers rows and vectors."""

    middle: Address
    end: Address
    rows: Reals2
    push: Reals
    complex_state: Complexes2
    vectors: Complexes2


def step_workspace(width: int, middle: int, end: int) -> MidpointStep:
    """Workspace for a step of N + 1 = ``width`` unknowns; the calls are those of real numbers."""
    return MidpointStep(middle, end, np.zeros((ROWS, width)), np.zeros(width), np.zeros((7, width)))


def along_workspace(width: int, middle: int, end: int) -> Along:
    """Workspace for the derivative of a step; the calls are those of complex numbers."""
    complex_state, vectors = np.zeros((ROWS, width), complex), np.zeros((7, width), complex)
    return Along(middle, end, np.zeros((ROWS, width)), np.zeros(width), complex_state, vectors)


@inner
def place(n, h, s):
    """Coordinates and velocities of a step by its accelerations ``A`` and ``B``, multipliers of its middle.
    v_m = v_0 + h A / 2, v_1 = v_m + h B / 2, q_1 = q_0 + h v_m, q_m = (q_0 + q_1) / 2, see
    `docs/theory/structure-preserving.md`.
    """
    for k in range(n):
        # Coordinates move with the velocity of the middle for the whole step: the rule is symmetric, so its order is
        # two.
        way = h * (s[V0, k] + 0.5 * h * s[A, k])
        s[VM, k] = s[V0, k] + 0.5 * h * s[A, k]
        s[V1, k] = s[V0, k] + 0.5 * h * (s[A, k] + s[B, k])
        s[XM, k] = s[X0, k] + 0.5 * way
        s[X1, k] = s[X0, k] + way
    for k in range(n, s.shape[1]):
        s[XM, k] = 0.5 * (s[X0, k] + s[X1, k])


@inner
def begin(n, h, start, slope, s):
    """A step ahead of a state, by its accelerations and multipliers and what they missed in the step before."""
    for k in range(len(start.x)):
        s[X0, k] = start.x[k]
        if k < n:
            s[V0, k] = start.v[k]
            s[A, k], s[B, k] = start.a[k] + slope[0, k], start.a[k] + slope[1, k]
        else:
            # Multipliers of both ends are unknowns of the step: those of its start are not those of the end of the step
            # before.
            s[X0, k], s[X1, k] = start.x[k] + slope[0, k], start.x[k] + slope[1, k]
    place(n, h, s)


@inner
def keep_missed(n, start, s, slope):
    """What accelerations and multipliers of a start missed in its step."""
    for k in range(len(start.x)):
        if k < n:
            slope[0, k], slope[1, k] = s[A, k] - start.a[k], s[B, k] - start.a[k]
        else:
            slope[0, k], slope[1, k] = s[X0, k] - start.x[k], s[X1, k] - start.x[k]


@inner
def _balance(model, n, at, middle, end, f, gap, rate, second):
    """Fill the residuals of a step, in real or in complex numbers; the signals of both calls hold the time. ``f``:
    M a + F + J^T l at the start. ``gap``: J^T l at the end less that at the start, constraints at the end. ``rate``:
    their rates.
    """
    # M a + F(q_m, v_m) + J(q_m)^T l_m from one call of the kernels, less its constraint forces: what is left is M a +
    # F.
    residual(model, n, at[XM], at[VM], at[A], middle, 1.0, f)
    clear(gap)
    constraint_forces(model, at[XM], at[VM], at[A], middle, gap)
    for k in range(n):
        f[k] -= gap[k]
    clear(gap)
    # Constraint forces of the start, then of the end; the constraints of the end come with the latter.
    constraint_forces(model, at[X0], at[V0], at[A], middle, gap)
    for k in range(len(gap)):
        if k < n:
            f[k] += gap[k]
            gap[k] = -gap[k]
        else:
            gap[k] = 0.0
    constraint_forces(model, at[X1], at[V1], at[B], end, gap)
    constraint_rates(model, n, at[X1], at[V1], at[A], end, rate, second)


@inner
def _correct(n, size, matrices, h, f, gap, rate, first, other, s):
    """Take Newton's correction off a step, by the residuals; ``f`` and ``gap`` become what accelerations moved. Two
    systems: [M + h/2 C + h^2/4 K, J^T; J, 0] for ``A``, and the same without C and K for ``B`` - ``A``: in the
    difference of both equations the forces cancel.
    """
    # Constraints at the end change by h^2/2 J a, their rates by h/2 J (a + b): scaled to accelerations.
    square = 2.0 / (h * h)
    for k in range(n, size):
        f[k] = square * gap[k]
        gap[k] = 2.0 / h * rate[k] - 2.0 * f[k]
    # First the implicit midpoint rule, then the projection of the velocities with the masses alone.
    solve(matrices.pattern.layout, matrices.real, f, first)
    solve(matrices.pattern.layout, matrices.rigid, gap, other)
    for k in range(size):
        f[k], gap[k] = first[k], first[k] + other[k]
        if k < n:
            s[A, k] -= f[k]
            s[B, k] -= gap[k]
        else:
            s[X0, k] -= f[k]
            s[X1, k] -= gap[k]
    place(n, h, s)


@inner
def _sizes(n, h, scale, f, gap, s):
    """Largest correction of a coordinate and largest way of one in the step, against its scale; which moved most."""
    norm, way, worst = 0.0, 0.0, 0
    for k in range(n):
        # What a correction of both accelerations moves a coordinate at most.
        moved = 0.25 * h * h * (abs(f[k]) + abs(gap[k])) / scale[k]
        way = max(way, h * abs(s[VM, k]) / scale[k])
        if norm == norm and not moved <= norm:  # the first that is not a number stays
            norm, worst = moved, k
    return norm, way, worst


@kernel
def converge(
    problem: IntegrationProblem,
    matrices: Matrices,
    model: Address,
    h: float,
    step: MidpointStep,
    tolerance: float,
    least: float,
) -> tuple[bool, int, float, int]:
    """Newton's iteration on a step that a force resists. Answers whether it converged, iterations, last contraction,
    unknown that moved most. Corrections end at ``tolerance`` times the way that the coordinates go in the step, and at
    least ``least``, in parts of their scales.
    """
    s, b, push, middle, end = step.rows, step.vectors, step.push, step.middle, step.end
    n, size, scale, mass = problem.n, s.shape[1] - 1, problem.scale, matrices.mass
    f, gap, rate, second, first, other = b[0], b[1], b[2], b[3], b[4], b[5]
    before, norm, contraction, worst = 0.0, 1.0, 1.0, 0
    closed, force, remaining = 0.0, 0.0, 0.0
    for k in range(n):
        closed = max(closed, CLOSED * scale[k])
    for iteration in range(1, _MOST_ITERATIONS + 1):
        _balance(model, n, s, middle, end, f, gap, rate, second)
        for k in range(n):
            f[k] += push[k]
            first[k] = s[B, k] - s[A, k]
        for k in range(n, size):  # rounding would come back as velocities, 1/h times as large
            if abs(gap[k]) <= closed:
                gap[k] = 0.0
        remaining = largest_entry(f, 0, n)
        if iteration == 1:  # of the prediction, and of the constraints
            force = max(remaining, largest_entry(s[A], n, size))
        # The difference of both equations: M (b - a) + (J(q_1)^T l_1 - J(q_0)^T l_0) = 0.
        add_product(n, matrices, mass, first, 1.0, gap)
        _correct(n, size, matrices, h, f, gap, rate, first, other, s)
        norm, way, worst = _sizes(n, h, scale, f, gap, s)
        way = max(least, way)
        if iteration > 1 and norm > NOISE * way:
            contraction = norm / before
        if not norm < 1e100 or (iteration > 2 and contraction > 2.0 and norm > 1e-9):
            break
        # The sum of the corrections to come, by the contraction seen.
        left = norm * contraction / (1.0 - contraction) if contraction < 1.0 else norm
        if min(norm, left) <= tolerance * way:
            return True, iteration, contraction, worst
        if iteration > 2 and norm <= ROUNDING and norm > 0.5 * before and remaining <= BALANCED * force:
            return True, iteration, contraction, worst
        before = norm
    return norm <= MAGNIFIED and remaining <= BALANCED * force, iteration, contraction, worst


@inner
def perturb_step(s, ds, at):
    """The step plus the imaginary step along a direction."""
    for i in range(ROWS):
        for k in range(s.shape[1]):
            at[i, k] = complex(s[i, k], STEP * ds[i, k])


@kernel
def converge_along(
    problem: IntegrationProblem, matrices: Matrices, perturbed: Address, h: float, step: MidpointStep, along: Along
) -> None:
    """Derivative of a converged step along a direction, by the same iteration on imaginary parts."""
    s, b, ds, at, vectors, push = step.rows, step.vectors, along.rows, along.complex_state, along.vectors, along.push
    n, size, scale, mass, middle, end = problem.n, s.shape[1] - 1, problem.scale, matrices.mass, along.middle, along.end
    f, gap, rate, first, other, heavier = b[0], b[1], b[2], b[4], b[5], b[6]
    r, c, u, w = vectors[0], vectors[1], vectors[2], vectors[3]
    # What changes of the masses do to the difference of both accelerations, once.
    for k in range(size + 1):
        at[0, k] = s[XM, k]
        u[k] = s[B, k] - s[A, k] if k < n else 0.0
    weigh_along(perturbed, n, at[0], u, middle, vectors[4:], w)
    for k in range(n):
        heavier[k] = w[k].imag / STEP
    before = 0.0
    for _ in range(4 * _MOST_ITERATIONS):
        perturb_step(s, ds, at)
        _balance(perturbed, n, at, middle, end, r, c, u, w)
        for k in range(size + 1):
            f[k], gap[k], rate[k] = r[k].imag / STEP, c[k].imag / STEP, u[k].imag / STEP
            if k < n:
                f[k] += push[k]
                gap[k] += heavier[k]
                first[k] = ds[B, k] - ds[A, k]
        add_product(n, matrices, mass, first, 1.0, gap)
        _correct(n, size, matrices, h, f, gap, rate, first, other, ds)
        # Against the derivatives of the end, which may grow from step to step.
        norm = _sizes(n, h, scale, f, gap, ds)[0]
        length = 0.0
        for k in range(n):
            length = max(length, (abs(ds[X1, k]) + h * abs(ds[V1, k])) / scale[k])
        if norm <= 1e-15 * length or not norm < 1e100 or (norm <= 1e-10 * length and norm > 0.5 * before):
            break
        before = norm
