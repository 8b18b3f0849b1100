"""Redundant constraints: accelerations as without the surplus, and of all possible multipliers the smallest ones.

Multipliers are measured by their scales s in ``problem.scale``: the smallest ones, which have the least sum of
(multiplier / s)^2, lie in the range of S^2 J, with S the diagonal matrix of the scales. So the basis B of that range is
orthonormal in the product x^T S^-2 y.
"""

from typing import NamedTuple

import numpy as np

from dalembert.kernels.kernel import inlined, inner, kernel
from dalembert.kernels.words import Address, Complexes2, Reals, Reals2
from dalembert.multibody.integrators.shared.partitioning import Partition, choose, invert, scratch
from dalembert.multibody.integrators.shared.problem import IntegrationProblem
from dalembert.multibody.kernels.assembly import constraint_rates
from dalembert.multibody.kernels.elementary import STEP
from dalembert.multibody.kernels.linear import Factors, factorise, resized, solve, storage
from dalembert.multibody.kernels.slopes import perturb
from dalembert.multibody.kernels.states import MotionState, clear

# Pivot, against the first one, of a constraint that follows from the others. Positions that have drifted off the
# constraints give it a pivot of the size of the drift.
_DRIFTED = 1e-6


class Surplus(NamedTuple):
    """Work for redundant constraints. ``partition``: that of the constraints. The first columns of ``basis`` (m, m)
    span the range of the multipliers, whose ``scale`` (m,) is that of the problem. ``product`` (N, N), by columns, and
    ``small``: work for the matrix on the range; ``across`` (3, m) for derivatives. ``invert``, ``turn``: addresses of
    the kernels, 0 if no constraint is redundant, ``turn`` 0 without derivatives.
    """

    partition: Partition
    scale: Reals
    basis: Reals2
    product: Reals2
    small: Factors
    across: Reals2
    invert: Address
    turn: Address


def surplus_workspace(problem: IntegrationProblem, redundant: bool, directions: int) -> Surplus:
    """Workspace for redundant constraints; without them for the Jacobian only."""
    layout = problem.exact_layout
    m = layout.size - problem.n if redundant else 0
    size = layout.size if redundant else 0
    scale = problem.scale[problem.n : problem.n + m].copy()
    kernels = invert_on_range.address if redundant else 0, turn_range.address if redundant and directions else 0
    arrays = np.zeros((m, m)), np.zeros((size, size)), storage(resized(layout, size)), np.zeros((3, m))
    return Surplus(scratch(problem, 0), scale, *arrays, *kernels)


@inlined
def _copy(source, target):
    for i in range(len(source)):
        target[i] = source[i]


@inlined
def _add(factor, source, target):
    """Add a multiple of a vector to another."""
    for i in range(len(source)):
        target[i] += factor * source[i]


@inlined
def _share(basis, scale, k, vector):
    """Scalar product of a column with a vector in units of the scales."""
    total = 0.0
    for i in range(len(basis)):
        total += basis[i, k] * vector[i] / (scale[i] * scale[i])
    return total


@inner
def _find_range(problem, surplus):
    """Basis of the multipliers' range, by the Jacobian in ``surplus.partition.matrix``, with the rank decided anew."""
    partition, basis, scale = surplus.partition, surplus.basis, surplus.scale
    choose(problem, partition, _DRIFTED)
    for k in range(partition.rank[0]):
        own = partition.columns[k] * problem.exact_layout.lead + problem.n
        for i in range(len(basis)):
            # The multipliers of least norm are S^2 J w: columns of S^2 J of the dependent coordinates span their range.
            # Gram and Schmidt in units of the scales makes them orthonormal.
            basis[i, k] = scale[i] * scale[i] * partition.matrix[own + i]
        for _ in range(2):  # twice is enough to be orthogonal to rounding
            for j in range(k):
                share = _share(basis, scale, j, basis[:, k])
                for i in range(len(basis)):
                    basis[i, k] -= share * basis[i, j]
        length = np.sqrt(_share(basis, scale, k, basis[:, k]))
        for i in range(len(basis)):
            basis[i, k] /= length


@inner
def keep_in_range(problem, surplus, state):
    """Take off the multipliers what is across their range: a self-stress that an earlier position left."""
    n, m, kept = problem.n, len(surplus.basis), surplus.across[2]
    _project(surplus, state.x[n : n + m], kept)
    for i in range(m):
        state.x[n + i] = kept[i]


@inner
def _project(surplus, vector, kept):
    """The part of multipliers in their range."""
    clear(kept)
    for k in range(surplus.partition.rank[0]):
        share = _share(surplus.basis, surplus.scale, k, vector)
        for i in range(len(vector)):
            kept[i] += share * surplus.basis[i, k]


@inner
def _restrict(n, size, lead, rank, surplus, matrix, small_lead):
    """Fill ``surplus.small`` with W^T A W, where W = [I 0; 0 B] with the range's basis B, by way of A W."""
    basis = surplus.basis
    for c in range(n + rank):
        # A W column by column: columns of coordinates as they are, combinations of those of multipliers.
        product = surplus.product[c]
        if c < n:
            _copy(matrix[c * lead : c * lead + size], product)
        else:
            clear(product)
            for j in range(size - n):
                _add(basis[j, c - n], matrix[(n + j) * lead : (n + j) * lead + size], product)
        small = surplus.small.matrix[c * small_lead : (c + 1) * small_lead]
        clear(small)
        _copy(product[:n], small)
        for j in range(size - n):
            _add(product[n + j], basis[j, :rank], small[n : n + rank])


@inner
def _extend(n, size, lead, rank, surplus, matrix, small_lead):
    """Fill the matrix with W S W^T, where S is ``surplus.small``, by way of W S."""
    basis = surplus.basis
    # The same products in the opposite order: W (A W)^-1 W^T keeps solutions within the range.
    for c in range(n + rank):
        product, small = surplus.product[c], surplus.small.matrix[c * small_lead : (c + 1) * small_lead]
        clear(product)
        _copy(small[:n], product)
        for j in range(size - n):
            for k in range(rank):
                product[n + j] += basis[j, k] * small[n + k]
        if c < n:
            _copy(product, matrix[c * lead : c * lead + size])
    for j in range(size - n):
        column = matrix[(n + j) * lead : (n + j) * lead + size]
        clear(column)
        for k in range(rank):
            _add(basis[j, k], surplus.product[n + k], column)


@kernel
def invert_on_range(problem: IntegrationProblem, surplus: Surplus, matrix: Reals) -> bool:
    """Replace a dense flat matrix, of motion beside constraints, by the inverse on the multipliers in the range. For
    redundant but consistent constraints this is the solution of least norm; others are met in least squares. The
    Jacobian stands in ``surplus.partition.matrix``. Whether the matrix on the range is regular.
    """
    _find_range(problem, surplus)
    n, size, lead, rank = problem.n, problem.exact_layout.size, problem.exact_layout.lead, surplus.partition.rank[0]
    layout = resized(problem.exact_layout, n + rank)
    _restrict(n, size, lead, rank, surplus, matrix, layout.lead)
    regular = factorise(layout, surplus.small)
    _extend(n, size, lead, rank, surplus, matrix, layout.lead)
    return regular


@kernel
def turn_range(
    problem: IntegrationProblem, perturbed: Address, state: MotionState, dstate: MotionState, complex_work: Address,
    complex_state: Complexes2, surplus: Surplus,
) -> None:  # fmt: skip
    """Give the multipliers' derivative the part across the range that keeps the multipliers in it. With the multipliers
    S^2 J w, w fixed, this is the part of the derivative of S^2 J, times w, across the range. The rest of the derivative
    follows from the equations of motion.
    """
    partition, basis, scale, across = surplus.partition, surplus.basis, surplus.scale, surplus.across
    n, m, rank = problem.n, len(basis), partition.rank[0]
    if not invert(problem, partition):
        return
    for i in range(rank):
        own = partition.rows[i]
        partition.gap[i] = state.x[n + own] / (scale[own] * scale[own])
    solve(resized(problem.exact_layout, rank), partition.dependent, partition.gap, partition.change)
    for part in range(2):  # the rates are linear in the velocities, but for the motion that is prescribed
        perturb(n, state, dstate, complex_state)
        for i in range(complex_state.shape[1]):
            complex_state[1, i] = 0.0
        # J along the dependent coordinates times w, and at zero velocity the part that is prescribed: their difference
        # is linear in w.
        if part == 0:
            for i in range(rank):
                complex_state[1, partition.columns[i]] = partition.change[i]
        constraint_rates(
            perturbed, n, complex_state[0], complex_state[1], complex_state[2], complex_work, complex_state[3],
            complex_state[4],
        )  # fmt: skip
        for i in range(m):
            across[part, i] = scale[i] * scale[i] * complex_state[3, n + i].imag / STEP
    turned, kept = across[0], across[2]
    _add(-1.0, across[1], turned)
    _project(surplus, turned, kept)
    _add(-1.0, kept, turned)
    _project(surplus, dstate.x[n : n + m], kept)
    for i in range(m):
        dstate.x[n + i] = kept[i] + turned[i]
