"""Derivatives of a converged step of generalized-alpha: one exact tangent, and one linear solution a direction."""

from typing import NamedTuple

import numpy as np

from dalembert.kernels.kernel import inlined, kernel
from dalembert.kernels.words import Address, Complexes, Complexes2, Integers, Reals
from dalembert.multibody.integrators.shared.problem import IntegrationProblem
from dalembert.multibody.kernels.assembly import (
    has_nodes,
    reduced_residual,
    reduced_tangent,
    restore,
    set_signals,
    spread,
)
from dalembert.multibody.kernels.elementary import STEP
from dalembert.multibody.kernels.linear import Factors, factorise, solve, storage
from dalembert.multibody.kernels.states import (
    Coefficients,
    MotionState,
    MotionStates,
    advance,
    copy,
    perturb,
    row,
    shift,
    subtract,
)


class Differentiation(NamedTuple):
    """Work of the derivatives: a call in complex numbers, a matrix, and vectors. ``r``, ``right`` and ``delta`` have
    the rows of the reduced system. ``change`` is the correction of all unknowns. If no coordinates have internal
    constraints, the reduced system is the full one, and ``change`` is the array ``delta``.
    """

    complex_work: Address
    factors: Factors
    complex_state: Complexes2
    moved: Complexes
    r: Complexes
    right: Reals
    delta: Reals
    change: Reals


def differentiation(problem: IntegrationProblem, complex_work: int) -> Differentiation:
    """Workspace for the derivatives."""
    layout, width = problem.reduced.exact_layout, len(problem.scale)
    right, delta = np.zeros((2, layout.size + 1))
    change = delta if problem.reduced.increments == problem.n else np.zeros(width)
    return Differentiation(
        complex_work, storage(layout), np.zeros((3, width), complex), np.zeros(width, complex),
        np.zeros(layout.size + 1, complex), right, delta, change,
    )  # fmt: skip


@kernel
def differentiate(
    problem: IntegrationProblem, tangent_model: Address, directions: Integers, c: Coefficients, t: float, within: float,
    new: MotionState, dolds: MotionStates, dnews: MotionStates, scratch: Differentiation,
) -> bool:  # fmt: skip
    """Compute the derivatives of the converged step along all directions; return whether the tangent is regular. The
    derivatives at the start of the step are read from ``dolds``, those at its end are written into ``dnews``. The
    derivative of the residual r = 0 is linear in those of accelerations and multipliers. So one solution with the exact
    tangent of the step gives the correction of the predicted derivatives: its right-hand side is Im r / STEP in the
    state that is perturbed along them (`docs/theory/sensitivities.md`).
    """
    n, own, complex_state, factors = problem.n, problem.reduced, scratch.complex_state, scratch.factors
    r, right, delta, change = scratch.r, scratch.right, scratch.delta, scratch.change
    set_signals(tangent_model, t, within, scratch.complex_work)
    reduced_tangent(
        tangent_model, own.exact_slots, own.increments, own.exact_layout.size, new.x, new.v, new.a, (c.dq, c.dv, 1.0),
        (1.0, 1.0 / c.dq), scratch.complex_work, factors.matrix,
    )  # fmt: skip
    if not factorise(own.exact_layout, factors):
        return False
    for d in range(len(directions)):
        dold, dnew = row(dolds, d), row(dnews, d)
        # A prediction with the accelerations of the start; as the equations are linear, its choice changes nothing but
        # rounding.
        copy(dnew, dold)
        advance(n, c, dold, dnew)
        if has_nodes(directions[d]):
            _restore(n, c, directions[d], new, dnew, scratch)
        # One evaluation gives r_q dq + r_v dv + r_a da + r_p dp, the derivative by the parameters included: they are in
        # the numbers of the perturbed model.
        perturb(n, new, dnew, complex_state)
        set_signals(directions[d], t, within, scratch.complex_work)
        reduced_residual(
            directions[d], own.increments, complex_state[0], complex_state[1], complex_state[2], scratch.complex_work,
            1.0 / c.dq, r,
        )  # fmt: skip
        for i in range(len(r) - 1):
            right[i] = r[i].imag / STEP
        # The tangent is exact and of the converged state, so that one solution is the result, not an iteration.
        solve(own.exact_layout, factors, right, delta)
        spread(tangent_model, new.x, delta, scratch.complex_work, change)
        subtract(n, change, dnew)
        advance(n, c, dold, dnew)
    return True


@inlined
def _restore(n, c, model, new, dnew, scratch):
    """Move the derivatives of the coordinates into the tangent space of the internal constraints."""
    x, moved, change = scratch.complex_state[0], scratch.moved, scratch.change
    for i in range(len(x)):
        x[i] = complex(new.x[i], STEP * dnew.x[i])
    restore(model, c.dq, x, scratch.complex_work, moved)
    for i in range(n):
        change[i] = moved[i].imag / STEP
    shift(n, c, change, dnew)
