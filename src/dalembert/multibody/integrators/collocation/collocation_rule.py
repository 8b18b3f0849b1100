"""Numbers of a collocation step: Gauss points, and the polynomial of the independent coordinates."""

from typing import NamedTuple

import numpy as np
from numpy.polynomial import polynomial
from numpy.polynomial.legendre import leggauss

from dalembert.kernels.words import Reals, Reals2, Reals3


class Rule(NamedTuple):
    """Of a polynomial u(s) with u, u' given at s = 0, and the accelerations c_k at ``count`` points, 0 <= s <= 1.
    u'' = sum c_k l_k(s), with Lagrange's l_k. ``nodes`` and ``weights`` (g,) of the Gauss points; ``powers`` (count,
    count) of l_k; ``shapes`` (g, 3, count): the double and the single integral of l_k from 0, and l_k, at the Gauss
    points. ``ahead`` (count, count + 1): accelerations at the same points of the next step, extrapolated from those of
    this one and the one at its end.
    """

    nodes: Reals
    weights: Reals
    powers: Reals2
    shapes: Reals3
    ahead: Reals2


def make_rule(degree: int, gauss_points: int) -> Rule:
    """Rule of a degree of u and a number of Gauss points."""
    nodes, weights = _gauss(gauss_points)
    own, _ = _gauss(degree - 1)
    powers = _lagrange(own)
    shapes = np.array(
        [[polynomial.polyval(nodes, polynomial.polyint(row, order)) for row in powers] for order in (2, 1, 0)]
    )
    ahead = np.array([polynomial.polyval(own, row) for row in _lagrange(np.append(own - 1.0, 0.0))]).T
    arrays = nodes, weights, powers, shapes.transpose(2, 0, 1), ahead
    return Rule(*(np.ascontiguousarray(array) for array in arrays))


def _gauss(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Gauss and Legendre's points and weights on [0, 1]."""
    points, weights = leggauss(count)
    return (1 + points) / 2, weights / 2


def _lagrange(nodes: np.ndarray) -> np.ndarray:
    """Coefficients of Lagrange's polynomials, (nodes, powers), rising."""
    rows = []
    for k, node in enumerate(nodes):
        others = np.delete(nodes, k)
        rows.append(polynomial.polyfromroots(others) / np.prod(node - others) if len(others) else np.ones(1))
    return np.array(rows)
