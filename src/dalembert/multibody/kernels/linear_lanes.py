"""Solutions of one factorised system for slopes: one right-hand side, or eight at once, side by side as lanes."""

from numba.extending import overload

from dalembert.kernels.kernel import inlined, inner
from dalembert.kernels.lanes import LANES, add_column, lanes
from dalembert.kernels.views import address_of
from dalembert.multibody.kernels.linear import DENSE, solve


@inner
def _solve(layout, factors, given, answer):
    if layout.kind == DENSE:
        _multiply(factors.matrix, layout.size, layout.lead, given, answer)
    else:
        buffer = lanes(address_of(factors.buffer), layout.size + 3 * layout.reach)
        _substitute(layout, factors, given, buffer, answer)


def solve_slopes(layout, factors, given, answer):
    """Solve for the first N entries of ``given``, which are real numbers or lanes, into those of ``answer``."""
    (_solve if given.ndim > 1 else solve)(layout, factors, given, answer)


@overload(solve_slopes)
def _solve_slopes(layout, factors, given, answer):
    if given.dtype is LANES:
        return lambda layout, factors, given, answer: _solve(layout, factors, given, answer)
    return lambda layout, factors, given, answer: solve(layout, factors, given, answer)


@inlined
def _multiply(matrix, size, lead, given, answer):
    """Product of a square matrix by columns with lanes; four rows at a time stay in registers."""
    # Column by column each answer would be loaded and stored N times. Four rows of sums stay in registers instead, and
    # each lane vector of the right-hand side is loaded once for them.
    whole = size // 4 * 4
    for i in range(0, whole, 4):
        a = b = c = d = 0.0 * given[0]
        for j in range(size):
            at, right = j * lead + i, given[j]
            a += matrix[at] * right
            b += matrix[at + 1] * right
            c += matrix[at + 2] * right
            d += matrix[at + 3] * right
        answer[i], answer[i + 1], answer[i + 2], answer[i + 3] = a, b, c, d
    for i in range(whole, size):
        a = 0.0 * given[0]
        for j in range(size):
            a += matrix[j * lead + i] * given[j]
        answer[i] = a


@inlined
def _substitute(layout, factors, given, x, answer):
    """Forward and backward substitution with the factors of a band, as `linear.solve_band` does for one side."""
    size, reach, lead, order = layout.size, layout.reach, layout.lead, layout.order
    a, pivots, tops, above = factors.matrix, factors.pivots, factors.tops, 2 * layout.reach
    # The right-hand sides in the order of the band: P L U x = b, with exchanges of rows within L.
    for i in range(size):
        x[order[i]] = given[i]
    for k in range(size):
        diagonal, p = k * lead + above, pivots[k]
        if p > 0:
            exchanged = x[k]
            x[k] = x[k + p]
            x[k + p] = exchanged
        value = x[k]
        # L y = b: the factor has ones on its diagonal, so that no division is needed.
        add_column(x, k + 1, a, diagonal + 1, -value, min(reach, size - 1 - k))
    for k in range(size - 1, -1, -1):
        diagonal = k * lead + above
        # U x = y: the diagonal holds reciprocals, as the factorisation left them.
        value = x[k] * a[diagonal]
        x[k] = value
        # Above its first row a column of U is zero.
        # One pass without checks of indices, eight directions at a time.
        add_column(x, tops[k], a, diagonal + tops[k] - k, -value, k - tops[k])
    for i in range(size):
        answer[i] = x[order[i]]
