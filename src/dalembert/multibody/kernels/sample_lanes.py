"""Solutions with the factorised matrices of eight samples side by side, each with the bits that it has alone."""

from dalembert.kernels.kernel import inlined, vector_kernel
from dalembert.kernels.lanes import add_column, add_columns, lane_vector, sum_products
from dalembert.kernels.words import Integers, Reals2
from dalembert.multibody.kernels.linear import DENSE, Layout


@vector_kernel
def solve_samples(
    layout: Layout, matrix: Reals2, pivots: Integers, tops: Integers, given: Reals2, buffer: Reals2, answer: Reals2
) -> None:
    """Solve for the first N rows of ``given`` (N + 1, 8) into those of ``answer``, lane by lane with the matrices
    ``matrix`` (entries, 8), dense ones by rows, whose exchanges of rows are the same; ``buffer`` (N + 3 reach, 8).
    """
    a, right, left = lane_vector(matrix), lane_vector(given), lane_vector(answer)
    if layout.kind == DENSE:
        _multiply(a, layout.size, right, left)
    else:
        _substitute(layout, a, pivots, tops, right, lane_vector(buffer), left)


@inlined
def _multiply(matrix, size, given, answer):
    """Products of square matrices by rows with vectors: the sums of `linear._multiply`, in its order."""
    # By rows, since eight matrices do not fit into the nearest cache: they are read once, in the order of memory, and
    # sums stay in registers.
    whole = size // 4 * 4
    for i in range(size):
        row = matrix[i * size : (i + 1) * size]
        total = sum_products(row, given, whole)
        for j in range(whole, size):
            total += row[j] * given[j]
        answer[i] = total


@inlined
def _substitute(layout, a, pivots, tops, given, x, answer):
    """Forward and backward substitution: `linear.solve_band`, with its pairs of columns and contracted products."""
    size, reach, lead, order = layout.size, layout.reach, layout.lead, layout.order
    above, zero = 2 * reach, 0.0 * given[size]
    # The order of the band, with room before the first unknown and behind the last one, as for one sample.
    for i in range(size):
        x[above + order[i]] = given[i]
    for i in range(above + size, len(x)):
        x[i] = zero
    k = 0
    while k < size:
        column, at = k * lead + above, above + k
        if pivots[k] > 0:
            first = x[at]
            x[at] = x[at + pivots[k]]
            x[at + pivots[k]] = first
        first = -x[at]
        # Two columns at a time where the second has no exchange of rows: the products are contracted in pairs, and
        # another order would have other bits.
        if k + 1 < size and pivots[k + 1] == 0:
            x[at + 1] -= x[at] * a[column + 1]
            # Sums of both columns in one pass over the unknowns below, as for one sample.
            add_columns(x, at + 2, a, column + 2, first, column + lead + 1, -x[at + 1], reach)
            k += 2
        else:
            add_column(x, at + 1, a, column + 1, first, reach)
            k += 1
    # Backward substitution in pairs of columns, over the rows that they reach.
    while k > 0:
        k -= 1
        column, at = k * lead + above, above + k
        x[at] *= a[column]
        if k > 0:
            x[at - 1] = (x[at - 1] - x[at] * a[column - 1]) * a[column - lead]
            count = k - 1 - min(tops[k], tops[k - 1])
            add_columns(x, at - 1 - count, a, column - 1 - count, -x[at], column - lead - count, -x[at - 1], count)
            k -= 1
    for i in range(size):
        answer[i] = x[above + order[i]]
