"""Bounds of a polynomial on boxes."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from dalembert.errors import InputError, require_known
from dalembert.surrogate import scan
from dalembert.surrogate.polynomial import ChebyshevPolynomial

METHODS = ("optimise", "scan", "bernstein")
CHUNK = 2_000_000  # values of a scan kept at once: a part of a batch is scanned and refined before the next one


@dataclass(frozen=True, eq=False)
class PolynomialBounds:
    """Smallest and largest values of each output on each box; without the axis of boxes if one was given.

    Parameters
    ----------
    lower, upper : array, shape (boxes, outputs)
    at_lower, at_upper : array, shape (boxes, outputs, d), or None
        Points where they are attained; an enclosure has none.
    """

    lower: np.ndarray
    upper: np.ndarray
    at_lower: np.ndarray | None = None
    at_upper: np.ndarray | None = None


def bounds(
    polynomial: ChebyshevPolynomial,
    lower: ArrayLike,
    upper: ArrayLike,
    method: Literal["optimise", "scan", "bernstein"] = "optimise",
    *,
    points: int | None = None,
    starts: int = 6,
    gap: float = 1e-6,
) -> PolynomialBounds:
    """Bounds of a polynomial on boxes inside its own.

    Parameters
    ----------
    polynomial : ChebyshevPolynomial
    lower, upper : array, shape (boxes, d) or (d,)
        A batch of boxes or a single one; any of them may have no width.
    method : str
        "optimise": Newton's method, projected onto the box, from the best points of a scan: attained, so never too
        wide, and exact to rounding unless every start misses the valley of the extreme. "scan": the extremes of the
        scan alone. "bernstein": an enclosure, never too narrow; see :mod:`dalembert.surrogate.bernstein`.
    points : int, optional
        Points of the scan in each direction; chosen by the degrees if not given. For "scan", 21 if not given.
    starts : int
        Valleys of the scan to refine from, at most, for each bound.
    gap : float
        For "bernstein": subdivides until bounds are this close, relative to the sum of the coefficients' sizes
        without the constant one, or rounding or the memory for boxes that do not settle (see there) ends it before.

    Raises
    ------
    InputError
        For an unknown method, a box that is none, or one that leaves that of the polynomial.

    Notes
    -----
    A scan alone is wrong by a curvature times its spacing squared, however high the order of the polynomial.

    Examples
    --------
    >>> parabola = ChebyshevPolynomial([-1.0], [1.0], [[0], [2]], [[0.5], [0.5]])
    >>> found = bounds(parabola, [[-1.0], [0.5]], [[0.4], [0.6]])
    >>> found.lower[:, 0].tolist(), found.upper[:, 0].tolist()
    ([0.0, 0.25], [1.0, 0.36])
    >>> found.at_lower[:, 0, 0].tolist()
    [0.0, 0.5]
    """
    require_known("method of bounding a polynomial", method, METHODS)
    low, high = _boxes(polynomial, lower, upper)
    if method == "bernstein":
        from dalembert.surrogate.bernstein import enclosures

        enclosure = PolynomialBounds(*enclosures(polynomial, low, high, gap))
    else:
        enclosure = _searched(polynomial, low, high, method, points, starts)
    if np.ndim(lower) == 2:
        return enclosure
    at = [None if side is None else side[0] for side in (enclosure.at_lower, enclosure.at_upper)]
    return PolynomialBounds(enclosure.lower[0], enclosure.upper[0], *at)


def _boxes(polynomial: ChebyshevPolynomial, lower: ArrayLike, upper: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """Bounds (boxes, d), checked."""
    low, high = (np.atleast_2d(np.asarray(side, dtype=float)) for side in (lower, upper))
    if low.shape != high.shape or low.ndim != 2 or low.shape[1] != len(polynomial.lower):
        raise InputError(
            f"boxes with bounds of shapes {np.shape(lower)} and {np.shape(upper)} were given; "
            f"expected ({len(polynomial.lower)},) or (boxes, {len(polynomial.lower)}) twice"
        )
    slack = 1e-12 * np.maximum(np.abs(polynomial.lower), np.abs(polynomial.upper))
    wrong = ~np.all((polynomial.lower - slack <= low) & (low <= high) & (high <= polynomial.upper + slack), axis=1)
    if wrong.any():
        place = int(np.argmax(wrong))
        raise InputError(
            f"box {place} from {low[place].tolist()} to {high[place].tolist()} was given; expected one inside that of "
            f"the polynomial, from {polynomial.lower.tolist()} to {polynomial.upper.tolist()}"
        )
    return np.clip(low, polynomial.lower, polynomial.upper), np.clip(high, polynomial.lower, polynomial.upper)


def _searched(
    polynomial: ChebyshevPolynomial, low: np.ndarray, high: np.ndarray, method: str, points: int | None, starts: int
) -> PolynomialBounds:
    outputs = polynomial.coefficients.shape[1]
    points = 21 if points is None and method == "scan" else points
    spread = scan.spread(polynomial, points)
    # In η of the polynomial, whose ends are exact; points on a side of a box are put back onto it afterwards.
    least, most = polynomial.eta(low), polynomial.eta(high)
    size = max(1, CHUNK // (len(spread.grid) * outputs))
    parts = []
    for start in range(0, len(low), size):
        box = least[start : start + size], most[start : start + size]
        values = scan.values(polynomial, spread, *box)
        if method == "scan":
            parts.append(_pick(values, spread, *box))
            continue
        from dalembert.kernels.preparation import prepare
        from dalembert.surrogate.extremes import extremes as refine  # compiled: not before it is needed
        from dalembert.surrogate.extremes import scratch

        prepare([refine])
        refined, at = np.empty((2, *values.shape[:2])), np.empty((2, *values.shape[:2], low.shape[1]))
        arrays = (np.ascontiguousarray(entry) for entry in (values, spread.grid, spread.sides, *box))
        refine(*arrays, polynomial.rows, refined, at, scratch(polynomial.rows, starts))
        parts.append((refined, at))
    extremes, at = (np.concatenate(entries, axis=1) for entries in zip(*parts, strict=True))
    inside = np.clip(polynomial.points(at), low[:, None], high[:, None])
    place = np.where(at == least[:, None], low[:, None], np.where(at == most[:, None], high[:, None], inside))
    return PolynomialBounds(extremes[0], extremes[1], place[0], place[1])


def _pick(values: np.ndarray, spread: scan.Scan, low: np.ndarray, high: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Extremes (2, boxes, outputs) of a scan, and where they are, (2, boxes, outputs, d)."""
    places = np.stack([np.argmin(values, axis=2), np.argmax(values, axis=2)])
    part = spread.grid[places]
    at = np.where(part == 1, high[:, None], low[:, None] + part * (high - low)[:, None])
    return np.take_along_axis(values[None], places[..., None], axis=3)[..., 0], at
