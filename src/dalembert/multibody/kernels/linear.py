"""Factorisation and solution of the linear systems: a dense inverse for small models, a band for others.

A factorisation is kept over many solutions. Where a matrix is small, the product with its inverse is several times
faster than the triangular solutions, and the Newton iteration around it corrects its rounding. Both are written out
here: for some dozens of unknowns in a narrow band LAPACK's calls were measured to take three times as long.
"""

from typing import NamedTuple

import numpy as np

from dalembert.kernels.kernel import inlined, kernel
from dalembert.kernels.lanes import WIDTH
from dalembert.kernels.words import Address, Integers, Reals
from dalembert.multibody.kernels.vector import LANES, add_multiple, add_two_multiples

DENSE, BAND = range(2)
_ENOUGH = 0.01  # share of a column's largest entry that a diagonal entry needs to stay the pivot


class Layout(NamedTuple):
    """Where a matrix's entries are kept: kind, size N, reach of the band, stored column, place of each unknown. Entry
    (i, j) stands at ``j lead + i``, in a band at ``j lead + 2 reach + i - j``, which leaves room for what the exchange
    of rows fills in. Reach and dense columns are padded to whole vectors.
    """

    kind: int
    size: int
    reach: int
    lead: int
    order: Integers
    factorise: Address
    solve: Address


class Factors(NamedTuple):
    """A matrix (flat, by columns) that its factorisation overwrites; pivots, first row of each column.

    ``buffer`` is workspace of solutions: a vector of N + 3 reach numbers, or of as many lanes.
    """

    matrix: Reals
    pivots: Integers
    tops: Integers
    buffer: Reals


def padded(count: int) -> int:
    """The next number of whole vectors."""
    return -(-count // LANES) * LANES


def storage(layout: Layout) -> Factors:
    """Room for a matrix and its factorisation."""
    size = layout.size
    buffer = np.zeros(WIDTH * (size + 3 * layout.reach))
    return Factors(np.zeros(layout.lead * size), np.zeros(size, np.int64), np.zeros(size, np.int64), buffer)


@inlined
def resized(layout, size):
    """Layout of another dense matrix."""
    lead = -(-size // LANES) * LANES
    return Layout(layout.kind, size, layout.reach, lead, layout.order, layout.factorise, layout.solve)


@inlined
def factorise(layout, factors):
    """Factorise (or invert) the matrix in its place; whether it was regular."""
    return _factorise_at(
        layout.factorise, layout.size, layout.reach, layout.lead, factors.matrix, factors.pivots, factors.tops
    )


@inlined
def solve(layout, factors, given, answer):
    """Solve for the first N entries of ``given``, into those of ``answer``."""
    _solve_at(layout.solve, layout, factors, given, answer)


@inlined
def _largest(a, begin, count):
    """Number of the entry of the largest size, and whether it is needed as the pivot in the first one's stead."""
    # Threshold pivoting: rows are exchanged only where the diagonal is small. In a band each exchange widens the upper
    # factor, and the iteration around corrects what growth there is.
    first = largest = abs(a[begin])
    found = 0
    for i in range(1, count):
        size = abs(a[begin + i])
        if size > largest:
            largest, found = size, i
    return 0 if first >= _ENOUGH * largest else found


@inlined
def _exchange(a, i, j):
    a[i], a[j] = a[j], a[i]


@kernel
def invert_dense(size: int, reach: int, lead: int, a: Reals, pivots: Integers, tops: Integers) -> bool:
    """Gauss and Jordan's inverse of a dense matrix by columns; whether it is regular."""
    for k in range(size):
        # Column k becomes a unit vector, its place takes the column of the inverse: no second matrix is needed.
        own = k * lead
        p = pivots[k] = k + _largest(a, own + k, size - k)
        if p != k:
            for j in range(size):
                _exchange(a, j * lead + k, j * lead + p)
        if a[own + k] == 0.0:
            return False
        inverse = 1.0 / a[own + k]
        a[own + k] = 0.0
        for j in range(size):
            factor = a[j * lead + k] * inverse
            if j != k and factor != 0.0:
                add_multiple(a, j * lead, a, own, -factor, lead)
                a[j * lead + k] = factor
        for i in range(size):
            a[own + i] *= -inverse
        a[own + k] = inverse
    # Exchanged rows are exchanged columns of the inverse, in reverse order.
    for k in range(size - 1, -1, -1):
        p = pivots[k]
        if p != k:
            for i in range(size):
                _exchange(a, k * lead + i, p * lead + i)
    return True


@inlined
def _pivot(size, reach, lead, a, pivots, tops, k, last):
    """Exchange rows if column ``k`` needs it, and divide the column; the last column that is concerned."""
    d = k * lead + 2 * reach
    p = pivots[k] = _largest(a, d, reach + 1)
    # An exchange with the row p below makes the upper factor reach p columns further.
    while last < min(k + p + reach, size - 1):
        last += 1
        tops[last] = k
    if p > 0:
        for j in range(k, last + 1):
            row = j * lead + 2 * reach + k - j
            _exchange(a, row, row + p)
    if a[d] == 0.0:
        return -1
    # The reciprocal is kept: solutions multiply, as a division takes as long as a dozen products.
    a[d] = 1.0 / a[d]
    for i in range(1, reach + 1):
        a[d + i] *= a[d]
    return last


@kernel
def factorise_band(size: int, reach: int, lead: int, a: Reals, pivots: Integers, tops: Integers) -> bool:
    """Triangular factors of a band matrix; whether it is regular. The lower one has ones on its diagonal, of the upper
    one the diagonal is inverted. Two columns at a time where the second one needs no exchange of rows, which halves the
    passes over the others.
    """
    last = tops[0] = 0
    above = 2 * reach
    k = 0
    while k < size:
        last = _pivot(size, reach, lead, a, pivots, tops, k, last)
        if last < 0:
            return False
        own, begin = k * lead + above, k + 1
        if k + 1 < size:
            # The first column is eliminated from the second one before both are eliminated from the rest.
            row = own + lead - 1
            add_multiple(a, row + 1, a, own + 1, -a[row], reach)
            begin = k + 2
            if _largest(a, row + 1, reach + 1) == 0:
                last = _pivot(size, reach, lead, a, pivots, tops, k + 1, last)
                if last < 0:
                    return False
                for j in range(k + 2, last + 1):
                    row = j * lead + above + k - j
                    first = a[row]
                    a[row + 1] -= first * a[own + 1]
                    # Many columns of a chain have zeros here: their elimination is skipped.
                    if first != 0.0 or a[row + 1] != 0.0:
                        add_two_multiples(a, row + 2, a, own + 2, -first, own + lead + 1, -a[row + 1], reach)
                k += 2
                continue
        for j in range(begin, last + 1):
            row = j * lead + above + k - j
            if a[row] != 0.0:
                add_multiple(a, row + 1, a, own + 1, -a[row], reach)
        k += 1
    return True


@inlined
def _multiply(matrix, size, lead, given, answer):
    """Product of a square matrix by columns with a vector, four columns at a time."""
    for i in range(size):
        answer[i] = 0.0
    # Four columns share each load and store of the answer: the product is bound by memory, not by arithmetic.
    whole = size // 4 * 4
    for j in range(0, whole, 4):
        a, b, c, d = given[j], given[j + 1], given[j + 2], given[j + 3]
        first, second = matrix[j * lead : j * lead + size], matrix[(j + 1) * lead : (j + 1) * lead + size]
        third, fourth = matrix[(j + 2) * lead : (j + 2) * lead + size], matrix[(j + 3) * lead : (j + 3) * lead + size]
        for i in range(size):
            answer[i] += first[i] * a + second[i] * b + third[i] * c + fourth[i] * d
    for j in range(whole, size):
        a, column = given[j], matrix[j * lead : j * lead + size]
        for i in range(size):
            answer[i] += column[i] * a


@kernel
def solve_dense(layout: Layout, factors: Factors, given: Reals, answer: Reals) -> None:
    """Multiply by the inverse."""
    _multiply(factors.matrix, layout.size, layout.lead, given, answer)


@kernel
def solve_band(layout: Layout, factors: Factors, given: Reals, answer: Reals) -> None:
    """Solve with the triangular factors."""
    size, reach, lead, order = layout.size, layout.reach, layout.lead, layout.order
    a, pivots, tops, x = factors.matrix, factors.pivots, factors.tops, factors.buffer
    above = 2 * reach  # room before the first unknown, and behind the last one
    for i in range(size):
        x[above + order[i]] = given[i]
    for i in range(above + size, above + size + reach):
        x[i] = 0.0
    k = 0
    while k < size:
        own, at = k * lead + above, above + k
        if pivots[k] > 0:
            _exchange(x, at, at + pivots[k])
        # Forward substitution by two columns where the second has no exchange of rows, as the factorisation did.
        if k + 1 < size and pivots[k + 1] == 0:
            x[at + 1] -= x[at] * a[own + 1]
            add_two_multiples(x, at + 2, a, own + 2, -x[at], own + lead + 1, -x[at + 1], reach)
            k += 2
        else:
            add_multiple(x, at + 1, a, own + 1, -x[at], reach)
            k += 1
    while k > 0:
        k -= 1
        own, at = k * lead + above, above + k
        x[at] *= a[own]
        if k > 0:
            x[at - 1] = (x[at - 1] - x[at] * a[own - 1]) * a[own - lead]
            # Backward substitution over the rows that the columns reach, in whole vectors; the room before the first
            # unknown takes what is too much.
            count = -(-(k - 1 - min(tops[k], tops[k - 1])) // LANES) * LANES
            add_two_multiples(x, at - 1 - count, a, own - 1 - count, -x[at], own - lead - count, -x[at - 1], count)
            k -= 1
    for i in range(size):
        answer[i] = x[above + order[i]]


DENSE_KERNELS, BAND_KERNELS = (invert_dense, solve_dense), (factorise_band, solve_band)
_factorise_at, _solve_at = invert_dense.at, solve_dense.at


def dense_layout(size: int) -> Layout:
    """Layout of a dense matrix."""
    order = np.zeros(0, dtype=np.int64)
    return Layout(DENSE, size, 0, padded(size), order, invert_dense.address, solve_dense.address)


def band_layout(order: np.ndarray, reach: int) -> Layout:
    """Layout of a band of that reach, with the position of each unknown in it."""
    lead = 3 * reach + 2
    return Layout(BAND, len(order), reach, lead, order, factorise_band.address, solve_band.address)
