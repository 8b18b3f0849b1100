"""Shape functions of beam elements in space: Lagrange's polynomials at Gauss' points, and anywhere."""

from functools import cache
from typing import NamedTuple

import numpy as np


class Rule(NamedTuple):
    """Shape functions at Gauss points: values, derivatives along xi in [-1, 1], each by points and nodes; weights.

    ``places`` are those of the points in the element, from 0 to 1; weights are parts of its length.
    """

    places: tuple[float, ...]
    values: tuple[tuple[float, ...], ...]
    slopes: tuple[tuple[float, ...], ...]
    weights: tuple[float, ...]


@cache
def rule(degree: int, points: int) -> Rule:
    """Return the shape functions of a degree at this number of Gauss points.

    >>> rule(1, 1).values, rule(1, 1).weights
    (((0.5, 0.5),), (1.0,))
    """
    at, weights = np.polynomial.legendre.leggauss(points)
    values, slopes = lagrange(degree, at)
    return Rule(
        tuple((0.5 + 0.5 * at).tolist()),
        tuple(map(tuple, values.tolist())),
        tuple(map(tuple, slopes.tolist())),
        tuple((0.5 * weights).tolist()),
    )


def lagrange(degree: int, xi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return Lagrange's polynomials of equally spaced nodes and their derivatives at ``xi``, (points, nodes).

    >>> lagrange(2, np.array([0.0]))[0].tolist()
    [[0.0, 1.0, 0.0]]
    """
    nodes = np.linspace(-1.0, 1.0, degree + 1)
    values, slopes = np.empty((2, len(xi), degree + 1))
    for i in range(degree + 1):
        polynomial = np.poly1d(np.delete(nodes, i), r=True)
        scale = polynomial(nodes[i])
        values[:, i], slopes[:, i] = polynomial(xi) / scale, polynomial.deriv()(xi) / scale
    return values, slopes


class Places(NamedTuple):
    """Places in elements: shape functions and their derivatives along xi, (points, nodes)."""

    values: np.ndarray
    slopes: np.ndarray

    @classmethod
    def at(cls, degree: int, shares: np.ndarray) -> "Places":
        """Places by their share of an element, from 0 to 1."""
        return cls(*lagrange(degree, 2.0 * np.asarray(shares, dtype=float) - 1.0))
