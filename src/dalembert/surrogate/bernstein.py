"""Guaranteed bounds of a polynomial on boxes: its Bernstein coefficients, the box halved until they are sharp.

On [0, 1], a polynomial of degree n is Σ_i β_i C(n, i) s^i (1 − s)^{n−i}, a mean of its Bernstein coefficients β_i with
weights that are never negative: it lies between the smallest and the largest of them. The first and the last one are
its values at the ends. Halving a box brings the coefficients closer to the polynomial by a factor of four.
"""

from functools import cache
from math import comb

import numpy as np

from dalembert.errors import InputError
from dalembert.surrogate.polynomial import ChebyshevPolynomial
from dalembert.surrogate.scan import transformed

MOST_COEFFICIENTS = 100_000  # largest Bernstein form of one output; 3^10 is below
CHUNK = 4_000_000  # coefficients kept at once: of a batch of boxes, and of the parts of a single one
DEPTH = 60  # most halvings of a box


def enclosures(
    polynomial: ChebyshevPolynomial, low: np.ndarray, high: np.ndarray, gap: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return bounds (boxes, outputs) twice, that the polynomial does not leave on boxes ``low``, ``high`` (boxes, d)
    inside its own. Boxes are halved until no bound is further from a value of the polynomial than ``gap`` times the sum
    of its |coefficients| without the constant one; an infinite gap takes the first coefficients as they are. Halving
    ends before that where rounding hides the rest, after ``DEPTH`` halvings, or when the open parts of a box fill
    ``CHUNK``, as those of a valley that is flat in several directions may: bounds are then guaranteed all the same, and
    wider.

    What rounding may do is added outwards: 10^-15 times the degrees, times the sizes of all products on the way.
    Source: Garloff 1985; Farouki 2012, The Bernstein polynomial basis: a centennial retrospective.
    """
    shape = tuple(int(degree) + 1 for degree in polynomial.degrees)
    if not gap > 0:
        raise InputError(f"a gap of {gap} was given for Bernstein bounds; expected a positive number")
    if np.prod(shape, dtype=float) > MOST_COEFFICIENTS:
        raise InputError(
            f"the Bernstein form of degrees {polynomial.degrees.tolist()} has {np.prod(shape, dtype=float):.3g} "
            f"coefficients an output, more than {MOST_COEFFICIENTS}; use fewer parameters or method 'optimise'"
        )
    outputs = polynomial.coefficients.shape[1]
    varying = np.any(polynomial.exponents > 0, axis=1)
    variation = np.sum(np.abs(polynomial.coefficients[varying]), axis=0)
    # Bound (outputs,) of all rounding errors: sizes of the products, times the length of the sums, times 10^-15, and
    # the smallest normal number, for products that are lost below it.
    sizes = [np.abs(_from_chebyshev(int(degree))).max(axis=0) for degree in polynomial.degrees]
    largest = np.prod([size[polynomial.exponents[:, k]] for k, size in enumerate(sizes)], axis=0)
    relative = 1e-15 * (2 * polynomial.degrees.sum() + DEPTH) * (largest @ np.abs(polynomial.coefficients))
    rounding = relative + np.finfo(float).tiny * np.any(polynomial.coefficients, axis=0)
    # The gap may be infinite. Below rounding, which is added to the bounds, no part of a box would ever be settled.
    wanted = np.maximum(np.multiply(gap, variation, out=np.zeros(outputs), where=variation > 0), rounding)
    # Coordinates s in [0, 1] of the polynomial's box, rounded outwards.
    ends = [np.clip((polynomial.eta(side) + 1) / 2 + out * 1e-15, 0, 1) for side, out in ((low, -1), (high, 1))]
    size = max(1, CHUNK // (outputs * int(np.prod(shape))))
    sides = np.empty((2, len(low), outputs))
    for start in range(0, len(low), size):
        part = slice(start, start + size)
        bases = [
            _restriction(degree - 1, ends[0][part, k], ends[1][part, k]) @ _from_chebyshev(degree - 1)
            for k, degree in enumerate(shape)
        ]
        form = transformed(polynomial, bases)
        for side, sign in enumerate((1.0, -1.0)):
            lowest = _lowest((sign * form).reshape(-1, *shape), np.tile(wanted, form.shape[0]))
            sides[side, part] = sign * (lowest.reshape(form.shape[:2]) - rounding)
    return sides[0], sides[1]


def _lowest(cells: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Lower bounds (owners,) of polynomials given by their Bernstein forms (owners, n_1 + 1, …, n_d + 1)."""
    # Coefficients at corners are values of the polynomial: no lower bound needs to be below the least of them by more
    # than the gap.
    attained = np.min(_corners(cells), axis=1)
    bound = np.full(len(cells), np.inf)
    most = CHUNK // cells[0].size  # cells kept at once
    waiting = [(0, cells, np.arange(len(cells)))]
    while waiting:
        depth, cells, owner = waiting.pop()
        least = cells.reshape(len(cells), -1).min(axis=1)
        open_ = least < attained[owner] - wanted[owner]
        # Where the open parts of a box fill the memory, they are closed as they are: the bound is wider, never wrong.
        full = 2 * np.bincount(owner[open_], minlength=len(bound)) > most
        open_ &= ~full[owner] & (depth < DEPTH)
        np.minimum.at(bound, owner[~open_], least[~open_])
        cells, owner = cells[open_], owner[open_]
        if not len(cells):
            continue
        if 2 * len(cells) > most:  # of several owners, as none fills the memory alone
            owners = np.unique(owner)
            first = owner < owners[len(owners) // 2]
            waiting += [(depth, cells[part], owner[part]) for part in (~first, first)]
            continue
        cells, owner = np.concatenate(_halved(cells)), np.tile(owner, 2)
        np.minimum.at(attained, owner, np.min(_corners(cells), axis=1))
        waiting.append((depth + 1, cells, owner))
    return bound


def _corners(cells: np.ndarray) -> np.ndarray:
    """Coefficients that are values at corners, shape (cells, 2^d)."""
    for axis in range(1, cells.ndim):
        cells = np.take(cells, [0, -1], axis=axis)
    return cells.reshape(len(cells), -1)


def _halved(cells: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Both halves of each cell, along the direction in which its coefficients vary most between neighbours."""
    axes = tuple(range(1, cells.ndim))
    # Derivatives in Bernstein form are n times differences of neighbours: the direction of the largest is halved.
    steps = [np.abs(np.diff(cells, axis=k)).max(axis=axes, initial=0) * (cells.shape[k] - 1) for k in axes]
    along = 1 + np.argmax(steps, axis=0)
    lower, upper = np.empty_like(cells), np.empty_like(cells)
    for k in axes:
        chosen = along == k
        last = np.moveaxis(cells[chosen], k, -1)
        for half, (start, end) in ((lower, (0.0, 0.5)), (upper, (0.5, 1.0))):
            matrix = _restriction(cells.shape[k] - 1, np.array([start]), np.array([end]))[0]
            half[chosen] = np.moveaxis(last @ matrix.T, -1, k)
    return lower, upper


def _restriction(degree: int, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Return matrices (n, degree + 1, degree + 1) from Bernstein coefficients on [0, 1] to those on [start, end], (n,)
    each. Row i holds the coefficients in z of (1 − a + a z)^{degree − i} (1 − b + b z)^i: the blossom of the polynomial
    at degree − i times a and i times b. No number on the way is negative.
    >>> _restriction(2, np.array([0.0]), np.array([0.5]))[0].tolist()
    [[1.0, 0.0, 0.0], [0.5, 0.5, 0.0], [0.25, 0.5, 0.25]]
    """
    matrix = np.zeros((len(start), degree + 1, degree + 1))
    for i in range(degree + 1):
        row = np.zeros((len(start), degree + 1))
        row[:, 0] = 1.0
        for at in [start] * (degree - i) + [end] * i:
            shifted = np.roll(row, 1, axis=1)  # the last entry is still zero
            row = row * (1 - at)[:, None] + shifted * at[:, None]
        matrix[:, i] = row
    return matrix


@cache
def _from_chebyshev(degree: int) -> np.ndarray:
    """Return Bernstein coefficients (degree + 1, degree + 1) of T_0(2s − 1) … T_degree(2s − 1), a column each.
    T_j = Σ_m (−1)^{j−m} C(2j, 2m) s^m (1 − s)^{j−m}, times (s + 1 − s)^{degree − j}; in integers but for one division.
    >>> _from_chebyshev(2).tolist()
    [[1.0, -1.0, 1.0], [1.0, 0.0, -3.0], [1.0, 1.0, 1.0]]
    """
    return np.array(
        [
            [
                sum((-1) ** (j - m) * comb(2 * j, 2 * m) * comb(degree - j, i - m) for m in range(min(i, j) + 1))
                / comb(degree, i)
                for j in range(degree + 1)
            ]
            for i in range(degree + 1)
        ]
    )
