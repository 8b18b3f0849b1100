"""Chebyshev polynomials in a basis that is orthonormal for the distribution of the inputs."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.polynomial.chebyshev import chebvander
from numpy.polynomial.legendre import leggauss
from scipy.linalg import solve_triangular

from dalembert.surrogate.basis import products
from dalembert.surrogate.polynomial import ChebyshevPolynomial

# From a degree to nodes in [−1, 1] and weights of sum 1 that integrate squares of polynomials of that degree.
Rule = Callable[[int], tuple[np.ndarray, np.ndarray]]
LARGEST = 2e7  # numbers of a table of basis polynomials that is held at once


def uniform(degree: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the rule of Gauss and Legendre, for a uniform input."""
    nodes, weights = leggauss(degree + 1)
    return nodes, 0.5 * weights


@dataclass(frozen=True, eq=False)
class OrthonormalExpansion:
    """A polynomial Σ c_α Π p_{α_k}(η_k), the p_j of a direction orthonormal for the distribution of its input."""

    exponents: np.ndarray  # (terms, d)
    coefficients: np.ndarray  # (terms, outputs)
    changes: list[np.ndarray]  # (degree + 1, degree + 1): of each direction, lower triangular: T_n = Σ_j M_nj p_j

    def tables(self, eta: np.ndarray) -> Iterator[tuple[slice, np.ndarray]]:
        """Yield rows of points η (n, d), and the basis polynomials there, shape (rows, terms)."""
        columns = [
            solve_triangular(change, chebvander(eta[:, k], len(change) - 1).T, lower=True).T
            for k, change in enumerate(self.changes)
        ]
        several = max(1, int(LARGEST / max(len(self.exponents), 1)))
        for first in range(0, len(eta), several):
            rows = slice(first, first + several)
            yield rows, products([column[rows] for column in columns], self.exponents)


def orthonormal(polynomial: ChebyshevPolynomial, rules: Sequence[Rule] = ()) -> OrthonormalExpansion:
    """Return a polynomial in the orthonormal basis, direction after direction.

    ``rules`` sequence of Rule, of length d: of the distribution of each input; uniform if not given.
    """
    exponents, coefficients = polynomial.exponents, polynomial.coefficients
    degrees = polynomial.degrees.tolist()
    changes = [change(degree, rule) for degree, rule in zip(degrees, rules or [uniform] * len(degrees), strict=True)]
    for direction, degree in enumerate(degrees):
        # Terms that share their degrees in the other directions are one row, on which the change of basis acts.
        rest = np.delete(exponents, direction, axis=1)
        rows, row = np.unique(rest, axis=0, return_inverse=True)
        table = np.zeros((len(rows), degree + 1, coefficients.shape[1]))
        table[row.reshape(-1), exponents[:, direction]] = coefficients
        longest = np.zeros(len(rows), dtype=int)
        np.maximum.at(longest, row.reshape(-1), exponents[:, direction])
        # M is lower triangular: a row of degree n has the polynomials 0 to n.
        at, lower = np.nonzero(np.arange(degree + 1) <= longest[:, None])
        exponents = np.insert(rows[at], direction, lower, axis=1)
        coefficients = np.einsum("nj,rno->rjo", changes[direction], table)[at, lower]
    return OrthonormalExpansion(exponents, coefficients, changes)


def change(degree: int, rule: Rule = uniform) -> np.ndarray:
    """Return M of T_n = Σ_j M_nj p_j, shape (degree + 1, degree + 1). With the nodes η_i and the weights w_i of the
    rule, √w_i T_n(η_i) = Q R gives orthonormal polynomials of values Q_ij/√w_i and M = Rᵀ.
    """
    nodes, weights = rule(degree)
    upper = np.asarray(np.linalg.qr(np.sqrt(weights)[:, None] * chebvander(nodes, degree), mode="r"))
    return (upper * np.where(np.diag(upper) < 0, -1.0, 1.0)[:, None]).T
