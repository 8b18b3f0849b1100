"""One step of the constrained midpoint rule: a discrete Lagrange-d'Alembert equation and its hidden constraints.

The step has two halves of constant acceleration a and b. The forces F are those of the middle, the constraint forces
those of the ends:

    M a + F(q_m, v_m, l_m) + J(q_0)^T l_0 = 0,  constraints (q_1) = 0,  M b + F(q_m, v_m, l_m) + J(q_1)^T l_1 = 0,
    their rates (q_1, v_1) = 0,  v_m = v_0 + h a / 2,  q_1 = q_0 + h v_m,  v_1 = v_m + h b / 2,

with q_m and l_m the means of both ends. Newton's iteration takes the difference of both equations, in which the forces
cancel: so one matrix of the implicit midpoint rule and one projection do.

Methods that keep the energy take the constraint forces J(q_m)^T l_m in space, where constraints are quadratic in the
coordinates: J(q_m) (q_1 - q_0) is what they change in the step, so that these forces do no work. Then a = b. Velocities
satisfy the constraints in the middle of the step, and are moved onto them at its end.
"""

from typing import NamedTuple

import numpy as np

from dalembert.kernels.kernel import inlined, inner, kernel
from dalembert.kernels.words import Address, Reals, Reals2
from dalembert.multibody.integrators.shared.convergence import (
    BALANCED,
    CLOSED,
    MAGNIFIED,
    NOISE,
    ROUNDING,
    has_settled,
    largest_entry,
)
from dalembert.multibody.integrators.shared.matrices import Matrices, add_product
from dalembert.multibody.integrators.shared.problem import IntegrationProblem
from dalembert.multibody.integrators.shared.settling import weigh_along
from dalembert.multibody.kernels.assembly import constraint_forces, constraint_rates, residual
from dalembert.multibody.kernels.elementary import size_of
from dalembert.multibody.kernels.linear_lanes import solve_slopes
from dalembert.multibody.kernels.records import call_at, model_at
from dalembert.multibody.kernels.slopes import joined, maximum, share_of, slope_of
from dalembert.multibody.kernels.states import clear

MOST_ITERATIONS = 20
ITERATING, CONVERGED, DIVERGED = range(3)


class StepRows(NamedTuple):
    """Unknowns (N + 1,) at the start of a step, in its middle and at its end, velocities there, both accelerations."""

    x0: Reals
    xm: Reals
    x1: Reals
    v0: Reals
    vm: Reals
    v1: Reals
    a: Reals
    b: Reals


class MidpointStep(NamedTuple):
    """Work of a step: calls for its middle and its end, its rows, a force ``push`` (N + 1,) against it, vectors."""

    middle: Address
    end: Address
    rows: StepRows
    push: Reals
    vectors: Reals2


class Along(NamedTuple):
    """Work of the derivative of a step: the same in slopes, with ``slopes`` (6, N + 1), and the step in complex or dual
    numbers, with vectors of these.
    """

    middle: Address
    end: Address
    rows: StepRows
    push: Reals
    slopes: Reals2
    at: StepRows
    vectors: Reals2


def step_workspace(width: int, middle: int, end: int) -> MidpointStep:
    """Workspace for a step of N + 1 = ``width`` unknowns; the calls are those of real numbers."""
    return MidpointStep(middle, end, StepRows(*np.zeros((8, width))), np.zeros(width), np.zeros((7, width)))


@inlined
def along_of(middle, end, numbers, slopes):
    """Work of the derivative of a step in numbers along directions (15, N + 1) and slopes (15, N + 1)."""
    return Along(middle, end, rows_of(slopes), slopes[8], slopes[9:15], rows_of(numbers), numbers[8:15])


@inlined
def rows_of(m):
    """The rows of a step in a matrix (8, N + 1)."""
    return StepRows(m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7])


@inner
def place(n, h, s):
    """Coordinates and velocities of a step by its accelerations ``A`` and ``B``, multipliers of its middle.
    v_m = v_0 + h A / 2, v_1 = v_m + h B / 2, q_1 = q_0 + h v_m, q_m = (q_0 + q_1) / 2, see
    `docs/theory/structure-preserving.md`.
    """
    for k in range(n):
        # Coordinates move with the velocity of the middle for the whole step: the rule is symmetric, so its order is
        # two.
        way = h * (s.v0[k] + 0.5 * h * s.a[k])
        s.vm[k] = s.v0[k] + 0.5 * h * s.a[k]
        s.v1[k] = s.v0[k] + 0.5 * h * (s.a[k] + s.b[k])
        s.xm[k] = s.x0[k] + 0.5 * way
        s.x1[k] = s.x0[k] + way
    for k in range(n, len(s.x0)):
        s.xm[k] = 0.5 * (s.x0[k] + s.x1[k])


@inner
def read(n, s, new):
    """State at the end of a step; accelerations and multipliers to start from."""
    for k in range(len(s.x0)):
        new.x[k] = s.x1[k]
        if k < n:
            new.v[k], new.a[k] = s.v1[k], s.b[k]


@inlined
def has_means(model):
    """Whether a model has a middle with mean forces, see `BlockModel.averaged`."""
    return model_at(model).middle != model


@inlined
def takes_means(model, middle):
    """Whether constraint forces are those of the middle of a step, whose length a method that keeps the energy sets."""
    return call_at(middle).step != 0.0 and has_means(model)


@inner
def step_residuals(model, n, at, middle, end, f, gap, rate, second):
    """Fill the residuals of a step, in numbers of any kind; the signals of both calls hold the time. ``f``:
    M a + F + J^T l at the start, or in the middle. ``gap``: J^T l at the end less that at the start, constraints at the
    end. ``rate``: their rates.
    """
    # M a + F(q_m, v_m) + J(q_m)^T l_m from one call of the kernels, less its constraint forces: what is left is M a +
    # F. Methods that keep the energy take forces of the ends in place of F(q_m, v_m), where components have them.
    forces = model if call_at(middle).step == 0.0 else model_at(model).middle
    residual(forces, n, at.xm, at.vm, at.a, middle, 1.0, f)
    if takes_means(model, middle):
        clear(gap)
        clear(rate)
        constraint_forces(model, at.x1, at.v1, at.b, end, gap)
        for k in range(n):
            gap[k] = 0.0
        return
    clear(gap)
    constraint_forces(model, at.xm, at.vm, at.a, middle, gap)
    for k in range(n):
        f[k] -= gap[k]
    clear(gap)
    # Constraint forces of the start, then of the end; the constraints of the end come with the latter.
    constraint_forces(model, at.x0, at.v0, at.a, middle, gap)
    for k in range(len(gap)):
        if k < n:
            f[k] += gap[k]
            gap[k] = -gap[k]
        else:
            gap[k] = 0.0
    constraint_forces(model, at.x1, at.v1, at.b, end, gap)
    constraint_rates(model, n, at.x1, at.v1, at.a, end, rate, second)


@inner
def _correct(n, size, matrices, h, f, gap, rate, first, other, s, means):
    """Take Newton's correction off a step, by the residuals; ``f`` and ``gap`` become what accelerations moved. Two
    systems: [M + h/2 C + h^2/4 K, J^T; J, 0] for ``A``, and the same without C and K for ``B`` - ``A``: in the
    difference of both equations the forces cancel.
    """
    scale_constraints(n, size, h, f, gap, rate)
    # First the implicit midpoint rule, then the projection of the velocities with the masses alone.
    solve_slopes(matrices.pattern.layout, matrices.real, f, first)
    if means:
        clear(other)
    else:
        solve_slopes(matrices.pattern.layout, matrices.rigid, gap, other)
    take_off(n, size, h, first, other, f, gap, s)


@inner
def scale_constraints(n, size, h, f, gap, rate):
    """Scale residuals of constraints to accelerations: h^2/2 J a at the end, and h/2 J (a + b) of the rates."""
    # So scaled, both systems have one unit in their rows, whatever the step is.
    square = 2.0 / (h * h)
    for k in range(n, size):
        f[k] = square * gap[k]
        gap[k] = 2.0 / h * rate[k] - 2.0 * f[k]


@inner
def take_off(n, size, h, first, other, f, gap, s):
    """Take the solutions of both systems off a step; ``f`` and ``gap`` become what accelerations moved."""
    # The second system gives the difference of both accelerations, so the end moves by the sum.
    for k in range(size):
        f[k], gap[k] = first[k], first[k] + other[k]
        if k < n:
            s.a[k] -= f[k]
            s.b[k] -= gap[k]
        else:
            s.x0[k] -= f[k]
            s.x1[k] -= gap[k]
    place(n, h, s)


@inner
def _sizes(n, h, scale, f, gap, s):
    """Largest correction of a coordinate and largest way of one in the step, against its scale; which moved most."""
    norm, way, worst = 0.0, 0.0, 0
    for k in range(n):
        # What a correction of both accelerations moves a coordinate at most.
        moved = 0.25 * h * h * (abs(f[k]) + abs(gap[k])) / scale[k]
        way = max(way, h * abs(s.vm[k]) / scale[k])
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
    n, size, scale, mass = problem.n, len(s.x0) - 1, problem.scale, matrices.mass
    f, gap, rate, second, first, other = b[0], b[1], b[2], b[3], b[4], b[5]
    before, norm, contraction, worst = 0.0, 1.0, 1.0, 0
    closed, force, remaining = 0.0, 0.0, 0.0
    means = takes_means(model, middle)
    for k in range(n):
        closed = max(closed, CLOSED * scale[k])
    for iteration in range(1, MOST_ITERATIONS + 1):
        step_residuals(model, n, s, middle, end, f, gap, rate, second)
        for k in range(n):
            f[k] += push[k]
            first[k] = s.b[k] - s.a[k]
        for k in range(n, size):  # rounding would come back as velocities, 1/h times as large
            if abs(gap[k]) <= closed:
                gap[k] = 0.0
        remaining = largest_entry(f, 0, n)
        # Of the prediction, and of the constraints: forces within stiff bodies cancel in the first, not in the others.
        if iteration == 1:
            force = max(remaining, largest_entry(s.x0, n, size))
        # The difference of both equations: M (b - a) + (J(q_1)^T l_1 - J(q_0)^T l_0) = 0.
        add_product(n, matrices, mass, first, 1.0, gap)
        _correct(n, size, matrices, h, f, gap, rate, first, other, s, means)
        norm, way, worst = _sizes(n, h, scale, f, gap, s)
        way = max(least, way)
        if iteration > 1 and norm > NOISE * way:
            contraction = norm / before
        progress = judge(iteration, tolerance * way, norm, before, contraction, remaining, force)
        if progress == CONVERGED:
            return True, iteration, contraction, worst
        if progress == DIVERGED:
            break
        before = norm
    return passes(norm, remaining, force), iteration, contraction, worst


@inner
def judge(iteration, allowed, norm, before, contraction, remaining, force):
    """Whether Newton's iteration has converged, goes on or diverged; corrections end below ``allowed``."""
    if not norm < 1e100 or (iteration > 2 and contraction > 2.0 and norm > 1e-9):
        return DIVERGED
    # The sum of the corrections to come, by the contraction seen.
    left = norm * contraction / (1.0 - contraction) if contraction < 1.0 else norm
    if min(norm, left) <= allowed:
        return CONVERGED
    if iteration > 2 and norm <= ROUNDING and norm > 0.5 * before and remaining <= BALANCED * force:
        return CONVERGED
    return ITERATING


@inner
def passes(norm, remaining, force):
    """Whether an iteration that ended without convergence leaves rounding that a nearly singular position magnifies."""
    return norm <= MAGNIFIED and remaining <= BALANCED * force


@inner
def perturb_step(s, ds, at):
    """The step of a model along directions: the real one with its slopes."""
    # Numbers, not arrays, are joined: what is joined has its memory, and nothing is allocated.
    for k in range(len(s.x0)):
        at.x0[k], at.xm[k], at.x1[k] = joined(s.x0[k], ds.x0[k]), joined(s.xm[k], ds.xm[k]), joined(s.x1[k], ds.x1[k])
        at.v0[k], at.vm[k], at.v1[k] = joined(s.v0[k], ds.v0[k]), joined(s.vm[k], ds.vm[k]), joined(s.v1[k], ds.v1[k])
        at.a[k], at.b[k] = joined(s.a[k], ds.a[k]), joined(s.b[k], ds.b[k])


@inner
def converge_along(problem, matrices, perturbed, h, s, along):
    """Derivatives of a converged step along directions, by the same iteration on slopes."""
    b, ds, at, vectors, push = along.slopes, along.rows, along.at, along.vectors, along.push
    n, size, mass, middle, end = problem.n, len(s.x0) - 1, matrices.mass, along.middle, along.end
    f, gap, rate, first, other, heavier = b[0], b[1], b[2], b[3], b[4], b[5]
    r, c, u, w = vectors[0], vectors[1], vectors[2], vectors[3]
    # What changes of the masses do to the difference of both accelerations, once.
    for k in range(size + 1):
        at.x0[k] = s.xm[k]
        u[k] = s.b[k] - s.a[k] if k < n else 0.0
    weigh_along(perturbed, n, at.x0, u, middle, vectors[4:], w)
    for k in range(n):
        heavier[k] = slope_of(w[k])
    before = 0.0
    for _ in range(4 * MOST_ITERATIONS):
        perturb_step(s, ds, at)
        step_residuals(perturbed, n, at, middle, end, r, c, u, w)
        for k in range(size + 1):
            f[k], gap[k], rate[k] = slope_of(r[k]), slope_of(c[k]), slope_of(u[k])
            if k < n:
                f[k] += push[k]
                gap[k] += heavier[k]
                first[k] = ds.b[k] - ds.a[k]
        add_product(n, matrices, mass, first, 1.0, gap)
        _correct(n, size, matrices, h, f, gap, rate, first, other, ds, takes_means(perturbed, middle))
        norm = _share(n, h, problem.scale, f, gap, ds)
        if has_settled(norm, before, 1e-15):
            break
        before = norm


@inner
def _share(n, h, scale, f, gap, ds):
    """Largest correction of a coordinate's slope, as a part of the slopes at the end, which may grow with the steps."""
    norm, length = 0.0 * ds.x1[n], 0.0 * ds.x1[n]
    for k in range(n):
        norm = maximum(norm, 0.25 * h * h * (size_of(f[k]) + size_of(gap[k])) / scale[k])
        length = maximum(length, (size_of(ds.x1[k]) + h * size_of(ds.v1[k])) / scale[k])
    return share_of(norm, length)
