"""Derivatives of a converged step of generalized-alpha along eight directions at once, in dual numbers.

The equations are those of :mod:`derivatives`: one tangent and factorisation a step, and for eight directions one
evaluation of the residual and one solution.
"""

from collections.abc import Sequence
from functools import cache
from typing import NamedTuple

import numpy as np

from dalembert.kernels.duals import DIRECTIONS, ENTRIES, dual_vector, slopes_of, with_slopes
from dalembert.kernels.kernel import inner, kernel
from dalembert.kernels.lanes import lane_vector, lane_zeros
from dalembert.kernels.words import Address, Integers, Reals, Reals2, Reals3, Reals4
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
from dalembert.multibody.kernels.linear import Factors, dense_layout, factorise, storage
from dalembert.multibody.kernels.linear_lanes import solve_lanes
from dalembert.multibody.kernels.states import (
    Coefficients,
    MotionState,
    advance,
    copy,
    shift,
    subtract,
)


class Together(NamedTuple):
    """Work of derivatives along eight directions. ``groups``: models in dual numbers, each for up to eight of the
    directions, none where directions are taken one by one; addresses of the kernels; calls in dual numbers and for
    tangents; a matrix; ``old``, ``new`` (4, groups, N + 1, 8): derivatives of x, v, a and w at both ends of a step;
    a state (3, N + 1, 9) and vectors (N + 1, 9) in dual numbers; right-hand sides and solutions (N + 1, 8); one
    correction (N + 1,) of the reduced system and of all unknowns.
    """

    groups: Integers
    differentiate: Address
    accelerate: Address
    dual_work: Address
    tangent_work: Address
    factors: Factors
    old: Reals4
    new: Reals4
    state: Reals3
    r: Reals2
    second: Reals2
    right: Reals2
    answer: Reals2
    buffer: Reals2
    delta: Reals
    change: Reals


def together(problem: IntegrationProblem, groups: Sequence[BlockModel], dual_work: int, tangent_work: int) -> Together:
    """Workspace for derivatives along eight directions at once, by models in dual numbers, which the caller keeps."""
    layout, width = problem.reduced.exact_layout, len(problem.scale)
    lengths = (entry.size + 3 * entry.reach for entry in (layout, problem.exact_layout))
    old, new = lane_zeros(2, 4, len(groups), width)
    state, (r, second) = np.zeros((3, width, ENTRIES)), np.zeros((2, width, ENTRIES))
    right, answer = lane_zeros(2, width)
    return Together(
        addresses(groups), differentiate_together.address if groups else 0,
        accelerate_together.address if groups else 0, dual_work, tangent_work, storage(layout), old, new, state, r,
        second, right, answer, lane_zeros(max(lengths)), np.zeros(width), np.zeros(width),
    )  # fmt: skip


@cache
def nothing_together() -> Together:
    """Workspace where directions are taken one by one, or where there are none."""
    none, layout = np.zeros(0), dense_layout(0)
    rows = np.zeros((0, DIRECTIONS))
    return Together(
        none.astype(np.int64), 0, 0, 0, 0, storage(layout), np.zeros((4, 0, 0, DIRECTIONS)),
        np.zeros((4, 0, 0, DIRECTIONS)), np.zeros((3, 0, ENTRIES)), np.zeros((0, ENTRIES)), np.zeros((0, ENTRIES)),
        rows, rows, rows, none, none,
    )  # fmt: skip


# Lanes of directions lie side by side for each unknown, so that a step never transposes: that cost a fifth of a step,
# since a vector that was just written entry by entry is loaded late.


@inner
def scatter(dstates, groups):
    """Fill ``groups`` (4, groups, N + 1, 8) with derivatives (directions, N + 1): lanes are directions."""
    for d in range(len(dstates.x)):
        g, lane = d // DIRECTIONS, d % DIRECTIONS
        for i in range(dstates.x.shape[1]):
            groups[0, g, i, lane], groups[1, g, i, lane] = dstates.x[d, i], dstates.v[d, i]
            groups[2, g, i, lane], groups[3, g, i, lane] = dstates.a[d, i], dstates.w[d, i]


@inner
def gather(groups, dstates):
    """Fill derivatives (directions, N + 1) from those in lanes."""
    for d in range(len(dstates.x)):
        g, lane = d // DIRECTIONS, d % DIRECTIONS
        for i in range(dstates.x.shape[1]):
            dstates.x[d, i], dstates.v[d, i] = groups[0, g, i, lane], groups[1, g, i, lane]
            dstates.a[d, i], dstates.w[d, i] = groups[2, g, i, lane], groups[3, g, i, lane]


@kernel
def differentiate_together(
    problem: IntegrationProblem, tangent_model: Address, c: Coefficients, t: float, within: float, new: MotionState,
    scratch: Together,
) -> bool:  # fmt: skip
    """Compute the derivatives of the converged step, as :func:`derivatives.differentiate` does: ``scratch.new``."""
    n, reduced, groups, factors = problem.n, problem.reduced, scratch.groups, scratch.factors
    size, answer = reduced.exact_layout.size, lane_vector(scratch.answer)
    # One exact tangent of the converged step serves all directions: d(residual)/da along dq = c.dq da, dv = c.dv da.
    set_signals(tangent_model, t, within, scratch.tangent_work)
    reduced_tangent(
        tangent_model, reduced.exact_slots, reduced.increments, size, new.x, new.v, new.a, (c.dq, c.dv, 1.0),
        (1.0, 1.0 / c.dq), scratch.tangent_work, factors.matrix,
    )  # fmt: skip
    if not factorise(reduced.exact_layout, factors):
        return False
    x, v, a = dual_vector(scratch.state[0]), dual_vector(scratch.state[1]), dual_vector(scratch.state[2])
    r, moved = dual_vector(scratch.r[: size + 1]), dual_vector(scratch.second)
    for g in range(len(groups)):
        before, after = scratch.old[:, g], scratch.new[:, g]
        dold = MotionState(
            lane_vector(before[0]), lane_vector(before[1]), lane_vector(before[2]), lane_vector(before[3])
        )
        dnew = MotionState(lane_vector(after[0]), lane_vector(after[1]), lane_vector(after[2]), lane_vector(after[3]))
        # A prediction with the accelerations of the start, as along one direction.
        copy(dnew, dold)
        advance(n, c, dold, dnew)
        _join(n, new, dnew, x, v, a)
        if has_nodes(groups[g]):
            # The predicted coordinates of nodes have left the tangent space of their internal constraints.
            restore(groups[g], c.dq, x, scratch.dual_work, moved)
            for i in range(n):
                answer[i] = slopes_of(moved[i])
            shift(n, c, answer, dnew)
            _join(n, new, dnew, x, v, a)
        # Slopes of r: r_q dq + r_v dv + r_a da + r_p dp, along eight directions. Numbers and signals of the model in
        # dual numbers hold dp.
        set_signals(groups[g], t, within, scratch.dual_work)
        reduced_residual(groups[g], reduced.increments, x, v, a, scratch.dual_work, 1.0 / c.dq, r)
        _solve(reduced.exact_layout, factors, r, scratch)
        if has_nodes(tangent_model):
            _spread(tangent_model, size, new.x, scratch)
        # The equation is linear in da and dlambda: one solution is exact, as in the case of one direction.
        subtract(n, answer, dnew)
        advance(n, c, dold, dnew)
    return True


@kernel
def accelerate_together(
    problem: IntegrationProblem, t: float, within: float, state: MotionState, c: Consistency, scratch: Together
) -> None:
    """Compute the derivatives of consistent accelerations and multipliers, by the matrix in ``c``: ``scratch.new``."""
    n, groups, answer = problem.n, scratch.groups, lane_vector(scratch.answer)
    x, v, a = dual_vector(scratch.state[0]), dual_vector(scratch.state[1]), dual_vector(scratch.state[2])
    r, second = dual_vector(scratch.r), dual_vector(scratch.second)
    for g in range(len(groups)):
        after = scratch.new[:, g]
        dnew = MotionState(lane_vector(after[0]), lane_vector(after[1]), lane_vector(after[2]), lane_vector(after[3]))
        _join(n, state, dnew, x, v, a)
        set_signals(groups[g], t, within, scratch.dual_work)
        # Rows of motion from the residual, rows of constraints from their second rates, which overwrite them.
        residual(groups[g], n, x, v, a, scratch.dual_work, 1.0, r)
        constraint_rates(groups[g], n, x, v, a, scratch.dual_work, second, r)
        _solve(problem.exact_layout, c.exact, r, scratch)
        subtract(n, answer, dnew)


@inner
def _join(n, state, slopes, x, v, a):
    """Fill vectors of dual numbers with a state and its derivatives."""
    # Multipliers have no rates: behind the coordinates velocities and accelerations stay zero.
    for i in range(len(state.x)):
        x[i] = with_slopes(state.x[i], slopes.x[i])
    for i in range(n):
        v[i], a[i] = with_slopes(state.v[i], slopes.v[i]), with_slopes(state.a[i], slopes.a[i])


@inner
def _solve(layout, factors, r, scratch):
    """Solve for the slopes of residuals in dual numbers ``r``, into the answer."""
    right = lane_vector(scratch.right)
    for i in range(layout.size):
        right[i] = slopes_of(r[i])
    solve_lanes(layout, factors, scratch.right, scratch.buffer, scratch.answer)


@inner
def _spread(model, size, x, scratch):
    """Replace solutions of the reduced system by the corrections of all unknowns, N(x) delta."""
    delta, change, answer = scratch.delta, scratch.change, scratch.answer
    # N(x) is a small product for each node in real numbers: its price does not justify a kernel in lanes.
    for lane in range(DIRECTIONS):
        for i in range(size):
            delta[i] = answer[i, lane]
        spread(model, x, delta[: size + 1], scratch.tangent_work, change)
        for i in range(len(x)):
            answer[i, lane] = change[i]
