"""Leja points: a sequence of points in [−1, 1] through the first n of which polynomials of degree n − 1 pass well."""

from functools import cache

import numpy as np

from dalembert.surrogate.basis import chebyshev, roots


@cache
def leja(number: int) -> np.ndarray:
    """The first points ζ_0, ζ_1 … of the sequence that starts with 0, 1, −1, shape (number,).

    Each next one is where |Π_i (x − ζ_i)| is largest: between two neighbours the zero of its logarithmic derivative
    Σ_i 1/(x − ζ_i), by bisection; of equal ones the right one. Points never move, so that a polynomial of higher degree
    reuses every run.

    >>> leja(4).round(6).tolist()
    [0.0, 1.0, -1.0, 0.57735]
    """
    points = np.array([0.0, 1.0, -1.0][:number])
    while len(points) < number:
        ends = np.sort(points)
        low, high = ends[:-1].copy(), ends[1:].copy()
        for _ in range(60):
            middle = (low + high) / 2
            rising = np.sum(1 / (middle[:, None] - points), axis=1) > 0
            low, high = np.where(rising, middle, low), np.where(rising, high, middle)
        middle = (low + high) / 2
        size = np.sum(np.log(np.abs(middle[:, None] - points)), axis=1)
        points = np.append(points, middle[np.flatnonzero(size > size.max() - 1e-9)[-1]])
    return points


@cache
def hierarchical(number: int) -> tuple[np.ndarray, np.ndarray]:
    """The polynomials h_j(x) = Π_{i<j} (x − ζ_i)/(ζ_j − ζ_i), whose largest magnitude on [−1, 1] is 1.

    Returns
    -------
    values : array, shape (number, number)
        h_j(ζ_i) in row j and column i: zero for i < j and one for i = j.
    coefficients : array, shape (number, number)
        Of T_0, T_1 … in h_j, a row for each j.

    Examples
    --------
    >>> hierarchical(3)[1][2].round(12).tolist()  # x (x − 1)/2 = (1 − 2x + (2x² − 1))/4
    [0.25, -0.5, 0.25]
    """
    points, nodes = leja(number), roots(number)
    values, at_nodes = np.zeros((number, number)), np.ones((number, number))
    for j in range(number):
        below = points[:j]
        values[j, j:] = np.prod((points[j:, None] - below) / (points[j] - below), axis=1)
        at_nodes[j] = np.prod((nodes[:, None] - below) / (points[j] - below), axis=1)
    to_series = (2.0 - (np.arange(number) == 0)) / number * chebyshev(nodes[:, None], np.array([number - 1]))[0]
    return values, np.tril(at_nodes @ to_series)
