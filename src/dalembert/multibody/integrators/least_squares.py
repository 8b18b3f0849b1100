"""Redundant constraints: accelerations as without the surplus, and of all possible multipliers the smallest ones."""

import numpy as np

from dalembert.multibody.integrators.lifting import lift
from dalembert.multibody.integrators.partitioning import choose, invert
from dalembert.multibody.kernels.assembly import constraint_rates
from dalembert.multibody.kernels.compiled import template
from dalembert.multibody.kernels.dual import STEP
from dalembert.multibody.kernels.linear import Layout, factorise, solve, storage
from dalembert.multibody.kernels.vector import LANES


@template
def range_of(problem, partition):
    """Orthonormal basis (m, rank) of what the Jacobian in ``partition.matrix`` reaches, with the rank decided anew."""
    choose(problem, partition)
    n, lead, rank = problem.n, problem.exact_layout.lead, partition.rank[0]
    basis = np.zeros((len(partition.rows), rank))
    for k in range(rank):
        own = partition.columns[k] * lead + n
        basis[:, k] = partition.matrix[own : own + len(basis)]
        for _ in range(2):  # twice is enough to be orthogonal to rounding
            for j in range(k):
                basis[:, k] -= np.sum(basis[:, j] * basis[:, k]) * basis[:, j]
        basis[:, k] /= np.sqrt(np.sum(basis[:, k] ** 2))
    return basis


@template
def invert_on_range(problem, basis, matrix):
    """Replace a dense flat matrix, of motion beside constraints, by the inverse on the multipliers in the range.

    For redundant but consistent constraints this is the solution of least norm; others are met in least squares.
    """
    size, lead, n = problem.exact_layout.size, problem.exact_layout.lead, problem.n
    whole = problem.exact_layout
    count = n + basis.shape[1]
    wide = np.zeros((size, count))
    for i in range(n):
        wide[i, i] = 1.0
    wide[n:, n:] = basis
    tall = np.ascontiguousarray(wide.T)
    transposed = np.ascontiguousarray(matrix.reshape((size, lead))[:, :size])
    layout = Layout(whole.kind, count, whole.reach, -(-count // LANES) * LANES, whole.order)
    factors = storage(layout)
    small = factors.matrix.reshape((count, layout.lead))
    small[:, :count] = np.dot(tall, np.dot(transposed, wide))
    regular = factorise(layout, factors)
    inverse = np.ascontiguousarray(small[:, :count])
    matrix.reshape((size, lead))[:, :size] = np.dot(wide, np.dot(inverse, tall))
    return regular


@template
def turn_range(problem, tilted, state, dstate, dual_work, lifted, partition, basis):
    """Give the multipliers' derivative the part across the range that keeps the multipliers in it.

    With the multipliers J w, w fixed, this is the part of the derivative of J, times w, across the range of J. The rest
    of the derivative follows from the equations of motion.
    """
    n, last, rank = problem.n, len(state.x) - 1, partition.rank[0]
    layout = Layout(
        problem.exact_layout.kind, rank, problem.exact_layout.reach, -(-rank // LANES) * LANES,
        problem.exact_layout.order,
    )  # fmt: skip
    if not invert(problem, partition):
        return
    for i in range(rank):
        partition.gap[i] = state.x[n + partition.rows[i]]
    solve(layout, partition.dependent, partition.gap, partition.change)
    across = np.zeros((2, last - n))
    for part in range(2):  # the rates are linear in the velocities, but for the motion that is prescribed
        lift(n, state, dstate, lifted)
        lifted[1, :] = 0.0
        if part == 0:
            for i in range(rank):
                lifted[1, partition.columns[i]] = partition.change[i]
        constraint_rates(tilted, n, lifted[0], lifted[1], lifted[2], dual_work, lifted[3], lifted[4])
        for i in range(last - n):
            across[part, i] = lifted[3, n + i].imag / STEP
    turned = across[0] - across[1]
    own = dstate.x[n:last]
    for k in range(rank):
        share = np.sum(basis[:, k] * turned)
        turned -= share * basis[:, k]
    kept = np.zeros(last - n)
    for k in range(rank):
        kept += np.sum(basis[:, k] * own) * basis[:, k]
    dstate.x[n:last] = kept + turned
