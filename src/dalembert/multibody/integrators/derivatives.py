"""Derivatives of a converged step of generalized-alpha: one exact tangent, and one linear solution a direction."""

from typing import NamedTuple

import numpy as np

from dalembert.kernels.kernel import inlined, kernel
from dalembert.kernels.words import Address, Complexes, Complexes2, Integers, Reals
from dalembert.multibody.integrators.lifting import lift
from dalembert.multibody.integrators.problem import Problem
from dalembert.multibody.kernels.assembly import (
    has_nodes,
    reduced_residual,
    reduced_tangent,
    restore,
    set_signals,
    spread,
)
from dalembert.multibody.kernels.dual import STEP
from dalembert.multibody.kernels.linear import Factors, factorise, solve, storage
from dalembert.multibody.kernels.motion import Coefficients, Motion, Motions, advance, copy, row, shift, subtract


class Differentiation(NamedTuple):
    """Work of the derivatives: a call in complex numbers, a matrix, and vectors.

    ``r``, ``right`` and ``delta`` have the rows of the reduced system; ``change`` is the correction of all unknowns,
    the same array as ``delta`` without nodes.
    """

    dual_work: Address
    factors: Factors
    lifted: Complexes2
    moved: Complexes
    r: Complexes
    right: Reals
    delta: Reals
    change: Reals


def differentiation(problem: Problem, dual_work: int) -> Differentiation:
    """Room for the derivatives."""
    layout, width = problem.reduced.exact_layout, len(problem.scale)
    right, delta = np.zeros((2, layout.size + 1))
    change = delta if problem.reduced.increments == problem.n else np.zeros(width)
    return Differentiation(
        dual_work, storage(layout), np.zeros((3, width), complex), np.zeros(width, complex),
        np.zeros(layout.size + 1, complex), right, delta, change,
    )  # fmt: skip


@kernel
def differentiate(
    problem: Problem, dual: Address, directions: Integers, c: Coefficients, t: float, within: float, new: Motion,
    dolds: Motions, dnews: Motions, room: Differentiation,
) -> bool:  # fmt: skip
    """Derivatives of the converged step along all directions; whether the tangent is regular."""
    n, own, lifted, factors = problem.n, problem.reduced, room.lifted, room.factors
    r, right, delta, change = room.r, room.right, room.delta, room.change
    set_signals(dual, t, within, room.dual_work)
    reduced_tangent(
        dual, own.exact_slots, own.increments, own.exact_layout.size, new.x, new.v, new.a, (c.dq, c.dv, 1.0),
        (1.0, 1.0 / c.dq), room.dual_work, factors.matrix,
    )  # fmt: skip
    if not factorise(own.exact_layout, factors):
        return False
    for d in range(len(directions)):
        dold, dnew = row(dolds, d), row(dnews, d)
        copy(dnew, dold)
        advance(n, c, dold, dnew)
        if has_nodes(directions[d]):
            _restore(n, c, directions[d], new, dnew, room)
        lift(n, new, dnew, lifted)
        set_signals(directions[d], t, within, room.dual_work)
        reduced_residual(directions[d], own.increments, lifted[0], lifted[1], lifted[2], room.dual_work, 1.0 / c.dq, r)
        for i in range(len(r) - 1):
            right[i] = r[i].imag / STEP
        solve(own.exact_layout, factors, right, delta)
        spread(dual, new.x, delta, room.dual_work, change)
        subtract(n, change, dnew)
        advance(n, c, dold, dnew)
    return True


@inlined
def _restore(n, c, model, new, dnew, room):
    """Move the derivatives of the coordinates into the tangent space of the internal constraints."""
    x, moved, change = room.lifted[0], room.moved, room.change
    for i in range(len(x)):
        x[i] = complex(new.x[i], STEP * dnew.x[i])
    restore(model, c.dq, x, room.dual_work, moved)
    for i in range(n):
        change[i] = moved[i].imag / STEP
    shift(n, c, change, dnew)
