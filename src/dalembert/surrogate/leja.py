"""Leja points: a sequence of points in [−1, 1] through the first n of which polynomials of degree n − 1 pass well."""

from functools import cache

import numpy as np

from dalembert.surrogate.basis import chebyshev, roots

SMALLEST = 16  # points that are computed at once at first; then twice as many
EXACT = 60  # Newton steps, kept in an interval that shrinks, that reach rounding from any start


def leja(number: int) -> np.ndarray:
    """Return the first points ζ_0, ζ_1 … of the sequence that starts with 0, 1, −1, shape (number,). Each next one is
    where |Π_i (x − ζ_i)| is largest; of equal ones the right one. Points never move, so that a polynomial of higher
    degree reuses every run.
    """
    return _sequence(_workspace(number))[:number]


def hierarchical(number: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the polynomials h_j(x) = Π_{i<j} (x − ζ_i)/(ζ_j − ζ_i), whose largest magnitude on [−1, 1] is 1. The
    values (number, number) have h_j(ζ_i) in row j and column i: zero for i < j and one for i = j. The coefficients
    (number, number) of T_0, T_1 … have a row for each h_j.
    """
    values, coefficients = _tables(_workspace(number))
    return values[:number, :number], coefficients[:number, :number]


def hierarchical_at(x: np.ndarray, number: int) -> np.ndarray:
    """Return h_0 … h_{number − 1} at points x (n,), shape (n, number).
    >>> hierarchical_at(np.array([0.5]), 3)[0].tolist()
    [1.0, 0.5, -0.125]
    """
    points = leja(number)
    values = np.ones((len(x), number))
    for j in range(1, number):
        values[:, j] = np.prod((x[:, None] - points[:j]) / (points[j] - points[:j]), axis=1)
    return values


def _workspace(number: int) -> int:
    """Return the least of 16, 32, 64 … that is at least ``number``: few sequences and tables are computed."""
    return max(SMALLEST, 1 << (number - 1).bit_length())


@cache
def _sequence(number: int) -> np.ndarray:
    points = np.array([0.0, 1.0, -1.0]) if number == SMALLEST else _sequence(number // 2)
    ends = np.sort(points)
    peaks = _peaks(points, ends[:-1], ends[1:], (ends[:-1] + ends[1:]) / 2, EXACT)
    while len(points) < number:
        # In logarithms: the product of thousands of distances would underflow.
        size = np.sum(np.log(np.abs(peaks[:, None] - points)), axis=1)
        # By symmetry two gaps may tie: within rounding the right one counts, on every machine.
        gap = int(np.flatnonzero(size > size.max() - 1e-9)[-1])
        here = slice(gap, gap + 1)
        chosen = _peaks(points, ends[here], ends[gap + 1 : gap + 2], peaks[here], EXACT)
        points = np.append(points, chosen)
        ends = np.insert(ends, gap + 1, chosen)
        peaks = np.insert(peaks, gap, chosen)
        peaks[gap : gap + 2] = (ends[gap : gap + 2] + ends[gap + 1 : gap + 3]) / 2
        # The other peaks move little, so two steps follow them; the new ones and their neighbours take more.
        peaks = _peaks(points, ends[:-1], ends[1:], peaks, 2)
        near = slice(max(gap - 1, 0), gap + 3)
        peaks[near] = _peaks(points, ends[:-1][near], ends[1:][near], peaks[near], 8)
    return points


def _peaks(points: np.ndarray, low: np.ndarray, high: np.ndarray, start: np.ndarray, steps: int) -> np.ndarray:
    """Where |Π_i (x − ζ_i)| is largest between neighbours: zeros of Σ_i 1/(x − ζ_i), by Newton's method kept inside."""
    peaks, low, high = start.copy(), low.copy(), high.copy()
    for _ in range(steps):
        # d/dx ln |Π| = Σ 1/(x − ζ) falls between neighbours from +∞ to −∞: one zero, which bisection keeps enclosed.
        parts = 1 / (peaks[:, None] - points)
        slope, curvature = parts.sum(axis=1), np.sum(parts**2, axis=1)
        low, high = np.where(slope > 0, peaks, low), np.where(slope > 0, high, peaks)
        moved = peaks + slope / curvature
        moved = np.where((low < moved) & (moved < high), moved, (low + high) / 2)
        peaks = moved
    return peaks


@cache
def _tables(number: int) -> tuple[np.ndarray, np.ndarray]:
    points, nodes = leja(number), roots(number)
    values, at_nodes = np.zeros((number, number)), np.ones((number, number))
    for j in range(number):
        below = points[:j]
        values[j, j:] = np.prod((points[j:, None] - below) / (points[j] - below), axis=1)
        at_nodes[j] = np.prod((nodes[:, None] - below) / (points[j] - below), axis=1)
    # Values at Chebyshev roots to coefficients: the discrete orthogonality of T on them.
    to_series = (2.0 - (np.arange(number) == 0)) / number * chebyshev(nodes[:, None], np.array([number - 1]))[0]
    return values, np.tril(at_nodes @ to_series)
