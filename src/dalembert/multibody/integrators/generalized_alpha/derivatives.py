"""Derivatives of a converged step of generalized-alpha: one exact tangent, and one solution for all directions.

The derivative of the residual r = 0 is linear in those of accelerations and multipliers. So one solution with the exact
tangent of the step gives the correction of the predicted derivatives (`docs/theory/sensitivities.md`).
"""

from typing import NamedTuple

import numpy as np

from dalembert.kernels.kernel import inlined, inner
from dalembert.kernels.words import Address, Integers, Reals, Reals4
from dalembert.multibody.integrators.shared.problem import IntegrationProblem
from dalembert.multibody.kernels.assembly import (
    has_nodes,
    reduced_residual,
    reduced_tangent,
    restore,
    set_signals,
    spread,
)
from dalembert.multibody.kernels.linear import Factors, factorise, storage
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
    slope_zeros,
    state_of,
    write_states,
)
from dalembert.multibody.kernels.states import Coefficients, MotionState, advance, copy, shift, subtract


class Differentiation(NamedTuple):
    """Work of the derivatives: a call along directions, a matrix, vectors; ``old``, ``new`` (groups, 4, N + 1, lanes):
    derivatives of x, v, a and w at both ends of a step; one correction (N + 1,) of the reduced system and of all
    unknowns. ``differentiate``: address of the kernel, 0 if there are no directions.
    """

    along: Address
    factors: Factors
    work: SlopeWork
    old: Reals4
    new: Reals4
    delta: Reals
    change: Reals
    differentiate: Address


def differentiation(problem: IntegrationProblem, along: int, groups: int, together: bool) -> Differentiation:
    """Workspace for derivatives along as many ``groups`` of directions, of one or, ``together``, of eight each."""
    width = len(problem.scale)
    old, new = slope_zeros(together, 2, groups, 4, width)
    kernel = differentiate_together if together else differentiate
    return Differentiation(
        along, storage(problem.reduced.exact_layout), slope_work(width, 2, 5, together), old, new,
        np.zeros(width), np.zeros(width), kernel.address if groups else 0,
    )  # fmt: skip


# Slopes of a direction lie side by side for each unknown, so that a step never transposes: that cost a fifth of a step,
# since a vector that was just written entry by entry is loaded late.


@inner
def scatter(dstates, lanes):
    """Fill ``lanes`` (groups, 4, N + 1, lanes) with derivatives (directions, N + 1)."""
    for g in range(len(lanes)):
        read_states(dstates, g, lanes[g])


@inner
def gather(lanes, dstates):
    """Fill derivatives (directions, N + 1) from those in lanes."""
    for g in range(len(lanes)):
        write_states(lanes[g], g, dstates)


def _differentiate(
    like: Number, problem: IntegrationProblem, tangent_model: Address, directions: Integers, c: Coefficients,
    t: float, within: float, new: MotionState, scratch: Differentiation,
) -> bool:  # fmt: skip
    """Compute the derivatives of the converged step, ``scratch.new``; return whether the tangent is regular."""
    n, reduced, factors, along = problem.n, problem.reduced, scratch.factors, scratch.along
    size, (numbers, slopes) = reduced.exact_layout.size, arrays_of(like, scratch.work)
    # One exact tangent of the converged step serves all directions: d(residual)/da along dq = c.dq da, dv = c.dv da.
    set_signals(tangent_model, t, within, along)
    reduced_tangent(
        tangent_model, reduced.exact_slots, reduced.increments, size, new.x, new.v, new.a, (c.dq, c.dv, 1.0),
        (1.0, 1.0 / c.dq), along, factors.matrix,
    )  # fmt: skip
    if not factorise(reduced.exact_layout, factors):
        return False
    x, v, a, r, moved, right, answer = (
        numbers[0], numbers[1], numbers[2], numbers[3][: size + 1], numbers[4], slopes[0], slopes[1],
    )  # fmt: skip
    for g in range(len(directions)):
        dold, dnew = _state(like, scratch.old[g], scratch.work), _state(like, scratch.new[g], scratch.work)
        # A prediction with the accelerations of the start; as the equations are linear, its choice changes nothing but
        # rounding.
        copy(dnew, dold)
        advance(n, c, dold, dnew)
        perturb(n, new, dnew, numbers)
        if has_nodes(directions[g]):
            # The predicted coordinates of nodes have left the tangent space of their internal constraints.
            restore(directions[g], c.dq, x, along, moved)
            for i in range(n):
                answer[i] = slope_of(moved[i])
            shift(n, c, answer, dnew)
            perturb(n, new, dnew, numbers)
        # One evaluation gives r_q dq + r_v dv + r_a da + r_p dp, the derivative by the parameters included: they are in
        # the numbers of the model along directions.
        set_signals(directions[g], t, within, along)
        reduced_residual(directions[g], reduced.increments, x, v, a, along, 1.0 / c.dq, r)
        for i in range(size):
            right[i] = slope_of(r[i])
        # The tangent is exact and of the converged state, so that one solution is the result, not an iteration.
        solve_slopes(reduced.exact_layout, factors, right, answer)
        if has_nodes(tangent_model):
            _spread(tangent_model, size, new.x, scratch)
        subtract(n, answer, dnew)
        advance(n, c, dold, dnew)
    return True


differentiate, differentiate_together = along_kernels(_differentiate)


@inlined
def _state(like, lanes, work):
    """The derivatives of a group as a state."""
    return state_of(arrays_of(like, SlopeWork(lanes, work.numbers))[1])


@inner
def _spread(model, size, x, scratch):
    """Replace solutions of the reduced system by the corrections of all unknowns, N(x) delta."""
    delta, change, answer = scratch.delta, scratch.change, scratch.work.slopes[1]
    # N(x) is a small product for each node in real numbers: its price does not justify a kernel in lanes.
    for lane in range(answer.shape[1]):
        for i in range(size):
            delta[i] = answer[i, lane]
        spread(model, x, delta[: size + 1], scratch.along, change)
        for i in range(len(x)):
            answer[i, lane] = change[i]
