"""Derivatives of a converged step of generalized-alpha along eight directions at once, in dual numbers.

The equations are those of :mod:`derivatives`: one tangent and factorisation a step, and for eight directions one
evaluation of the residual and one solution.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from dalembert.kernels.duals import DIRECTIONS, ENTRIES, dual_vector
from dalembert.kernels.kernel import inner, kernel
from dalembert.kernels.words import Address, Integers, Reals, Reals2, Reals3
from dalembert.multibody.integrators.shared.consistent import Consistency
from dalembert.multibody.integrators.shared.problem import IntegrationProblem
from dalembert.multibody.kernels.assembly import (
    constraint_rates,
    has_nodes,
    reduced_residual,
    reduced_tangent,
    residual,
    restore,
    set_signals,
    spread,
)
from dalembert.multibody.kernels.block_table import BlockModel, addresses
from dalembert.multibody.kernels.linear import Factors, factorise, storage
from dalembert.multibody.kernels.linear_lanes import solve_lanes
from dalembert.multibody.kernels.states import (
    Coefficients,
    MotionState,
    MotionStates,
    advance,
    copy,
    row,
    shift,
    subtract,
)


class Together(NamedTuple):
    """Work of derivatives along eight directions. ``groups``: models in dual numbers, each for up to eight of the
    directions, none where directions are taken one by one; addresses of the kernels; calls in dual and in complex
    numbers; a matrix, a state (3, N + 1, 9) and vectors (N + 1, 9) in dual numbers, right-hand sides and solutions
    (N + 1, 8), one correction (N + 1,).
    """

    groups: Integers
    differentiate: Address
    accelerate: Address
    dual_work: Address
    complex_work: Address
    factors: Factors
    state: Reals3
    r: Reals2
    second: Reals2
    right: Reals2
    answer: Reals2
    buffer: Reals2
    delta: Reals
    change: Reals


def together(problem: IntegrationProblem, groups: Sequence[BlockModel], dual_work: int, complex_work: int) -> Together:
    """Workspace for derivatives along eight directions at once, by models in dual numbers, which the caller keeps."""
    layout, width = problem.reduced.exact_layout, len(problem.scale)
    lengths = (entry.size + 3 * entry.reach for entry in (layout, problem.exact_layout))
    delta = np.zeros(width)
    kernels = [differentiate_together.address, accelerate_together.address] if groups else [0, 0]
    return Together(
        addresses(groups), *kernels, dual_work, complex_work, storage(layout), np.zeros((3, width, ENTRIES)), np.zeros((width, ENTRIES)),
        np.zeros((width, ENTRIES)), np.zeros((width, DIRECTIONS)), np.zeros((width, DIRECTIONS)),
        np.zeros((max(lengths), DIRECTIONS)), delta,
        delta if problem.reduced.increments == problem.n else np.zeros(width),
    )  # fmt: skip


@kernel
def differentiate_together(
    problem: IntegrationProblem, complex_model: Address, c: Coefficients, t: float, within: float,
    new: MotionState, dolds: MotionStates, dnews: MotionStates, scratch: Together,
) -> bool:  # fmt: skip
    """Compute the derivatives of the converged step, as :func:`derivatives.differentiate` does."""
    groups = scratch.groups
    n, own, factors, state = problem.n, problem.reduced, scratch.factors, scratch.state
    delta, change, answer = scratch.delta, scratch.change, scratch.answer
    set_signals(complex_model, t, within, scratch.complex_work)
    reduced_tangent(
        complex_model, own.exact_slots, own.increments, own.exact_layout.size, new.x, new.v, new.a, (c.dq, c.dv, 1.0),
        (1.0, 1.0 / c.dq), scratch.complex_work, factors.matrix,
    )  # fmt: skip
    if not factorise(own.exact_layout, factors):
        return False
    for g in range(len(groups)):
        first = g * DIRECTIONS
        last = min(first + DIRECTIONS, len(dnews.x))
        for d in range(first, last):
            copy(row(dnews, d), row(dolds, d))
            advance(n, c, row(dolds, d), row(dnews, d))
        _scatter(n, new, dnews, first, last, state)
        if has_nodes(groups[g]):
            _restore(n, c, groups[g], dnews, first, last, scratch)
            _scatter(n, new, dnews, first, last, state)
        x, v, a = dual_vector(state[0]), dual_vector(state[1]), dual_vector(state[2])
        set_signals(groups[g], t, within, scratch.dual_work)
        r = dual_vector(scratch.r[: own.exact_layout.size + 1])
        reduced_residual(groups[g], own.increments, x, v, a, scratch.dual_work, 1.0 / c.dq, r)
        _solve(own.exact_layout, factors, scratch.r, scratch)
        for d in range(first, last):
            dold, dnew = row(dolds, d), row(dnews, d)
            for i in range(own.exact_layout.size):
                delta[i] = answer[i, d - first]
            spread(complex_model, new.x, delta, scratch.complex_work, change)
            subtract(n, change, dnew)
            advance(n, c, dold, dnew)
    return True


@kernel
def accelerate_together(
    problem: IntegrationProblem, t: float, within: float, state: MotionState, dstates: MotionStates, c: Consistency,
    scratch: Together,
) -> None:  # fmt: skip
    """Compute the derivatives of consistent accelerations and multipliers, by the matrix in ``c``."""
    n, size, groups = problem.n, problem.exact_layout.size, scratch.groups
    for g in range(len(groups)):
        first = g * DIRECTIONS
        last = min(first + DIRECTIONS, len(dstates.x))
        _scatter(n, state, dstates, first, last, scratch.state)
        x, v, a = dual_vector(scratch.state[0]), dual_vector(scratch.state[1]), dual_vector(scratch.state[2])
        r, second = dual_vector(scratch.r), dual_vector(scratch.second)
        set_signals(groups[g], t, within, scratch.dual_work)
        residual(groups[g], n, x, v, a, scratch.dual_work, 1.0, r)
        constraint_rates(groups[g], n, x, v, a, scratch.dual_work, second, r)
        _solve(problem.exact_layout, c.exact, scratch.r, scratch)
        for d in range(first, last):
            for i in range(size):
                scratch.delta[i] = scratch.answer[i, d - first]
            subtract(n, scratch.delta, row(dstates, d))


@inner
def _scatter(n, state, dstates, first, last, target):
    """State with the derivatives along some directions, in dual numbers; directions that are missing are zero."""
    for i in range(len(state.x)):
        target[0, i, 0], target[1, i, 0], target[2, i, 0] = state.x[i], state.v[i], state.a[i]
    for d in range(first, last):
        k = 1 + d - first
        for i in range(len(state.x)):
            target[0, i, k] = dstates.x[d, i]
        for i in range(n):
            target[1, i, k], target[2, i, k] = dstates.v[d, i], dstates.a[d, i]


@inner
def _solve(layout, factors, r, scratch):
    """Solve for the slopes of residuals in dual numbers ``r``, into the answer."""
    for i in range(layout.size):
        for k in range(DIRECTIONS):
            scratch.right[i, k] = r[i, 1 + k]
    solve_lanes(layout, factors, scratch.right, scratch.buffer, scratch.answer)


@inner
def _restore(n, c, model, dnews, first, last, scratch):
    """Move the derivatives of the coordinates into the tangent spaces of the internal constraints."""
    moved = scratch.second
    restore(model, c.dq, dual_vector(scratch.state[0]), scratch.dual_work, dual_vector(moved))
    for d in range(first, last):
        for i in range(n):
            scratch.change[i] = moved[i, 1 + d - first]
        shift(n, c, scratch.change, row(dnews, d))
