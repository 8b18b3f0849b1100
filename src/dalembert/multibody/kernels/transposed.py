"""Solutions with the transpose of a factorised matrix, see :mod:`linear`."""

from dalembert.kernels.kernel import Compiled, inlined, kernel
from dalembert.kernels.words import Address, Reals
from dalembert.multibody.kernels.linear import BAND, Factors, Layout
from dalembert.multibody.kernels.vector import LANES, dot


@kernel
def solve_dense_transposed(layout: Layout, factors: Factors, given: Reals, answer: Reals) -> None:
    """Multiply by the transposed inverse."""
    for j in range(layout.size):
        whole = layout.size // LANES * LANES
        # Columns of the inverse are rows of its transpose: each entry is a dot product over contiguous memory.
        total = dot(factors.matrix, j * layout.lead, given, 0, whole)
        for i in range(whole, layout.size):
            total += factors.matrix[j * layout.lead + i] * given[i]
        answer[j] = total


@kernel
def solve_band_transposed(layout: Layout, factors: Factors, given: Reals, answer: Reals) -> None:
    """Solve with the transposed triangular factors: U^T first, then L^T with the exchanges of rows in reverse order."""
    size, reach, lead, order = layout.size, layout.reach, layout.lead, layout.order
    a, pivots, tops, x = factors.matrix, factors.pivots, factors.tops, factors.buffer
    above = 2 * reach
    for i in range(size):
        x[above + order[i]] = given[i]
    for i in range(above):
        x[i] = 0.0
    for i in range(above + size, len(x)):
        x[i] = 0.0
    for k in range(size):
        own, at, count = k * lead + above, above + k, -(-(k - tops[k]) // LANES) * LANES
        # U^T has the columns of U as rows. In whole vectors: entries above a column's top meet the zeros before the
        # first unknown.
        x[at] = (x[at] - dot(a, own - count, x, at - count, count)) * a[own]
    for k in range(size - 1, -1, -1):
        own, at = k * lead + above, above + k
        # L^T after it; exchanges of rows come last, as they came first in the solution with L.
        x[at] -= dot(a, own + 1, x, at + 1, reach)
        p = pivots[k]
        if p > 0:
            x[at], x[at + p] = x[at + p], x[at]
    for i in range(size):
        answer[i] = x[above + order[i]]


def transposed(layout: Layout) -> Compiled:
    """The kernel that solves with the transpose of a matrix of this layout."""
    return solve_band_transposed if layout.kind == BAND else solve_dense_transposed


_solve_at = solve_dense_transposed.at


@inlined
def solve_transposed(address: Address, layout, factors, given, answer):
    """Solve with the transpose for the first N entries of ``given``, by the kernel at an address."""
    _solve_at(address, layout, factors, given, answer)
