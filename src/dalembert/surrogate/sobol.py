"""Sobol indices of a function from its Chebyshev surrogate, in closed form."""

from dataclasses import dataclass

import numpy as np
from numpy.polynomial.chebyshev import chebvander
from numpy.polynomial.legendre import leggauss, legvander

from dalembert.surrogate.polynomial import ChebyshevPolynomial
from dalembert.surrogate.surrogate import Surrogate

NOTHING = 1e-12
"""A standard deviation that is rounding, over the mean."""


@dataclass(frozen=True, eq=False)
class SobolIndices:
    """Parts of the variance of each output that come from the inputs, all uniform and independent over the box.

    Parameters
    ----------
    mean, variance : array, shape (outputs,)
    first, total : array, shape (d, outputs)
        Var E[f | x_k]/Var f, and 1 − Var E[f | all but x_k]/Var f. NaN where the variance is zero.
    first_ends, total_ends : array, shape (2, d, outputs)
        Lower and upper ends that follow from the error of the surrogate.
    error : array, shape (outputs,)
        Of the surrogate over the box.
    """

    mean: np.ndarray
    variance: np.ndarray
    first: np.ndarray
    total: np.ndarray
    first_ends: np.ndarray
    total_ends: np.ndarray
    error: np.ndarray

    def summed(self, groups: np.ndarray) -> "SobolIndices":
        """Return indices of groups of outputs: parts of the variances, summed over the outputs of each group.

        Parameters
        ----------
        groups : array of int, shape (outputs,)
            Number of the group of each output, from 0.
        """
        member = groups[:, None] == np.arange(groups.max(initial=-1) + 1)
        first, total = (np.nan_to_num(part) * self.variance @ member for part in (self.first, self.total))
        # The error of a group is a norm too: the root of the sum of squares.
        return _indices(self.mean @ member, self.variance @ member, first, total, np.sqrt(self.error**2 @ member))

    @property
    def uncertainty(self) -> np.ndarray:
        """Largest distance of an index to an end of its interval, shape (outputs,)."""
        pairs = ((self.first, self.first_ends), (self.total, self.total_ends))
        return np.max([np.abs(ends - indices).max(axis=(0, 1), initial=0.0) for indices, ends in pairs], axis=0)


def sobol_indices(surrogate: Surrogate) -> SobolIndices:
    """Return the Sobol indices of a function from its surrogate, with the intervals that the surrogate's error leaves.

    Parameters
    ----------
    surrogate : Surrogate
        As :func:`~dalembert.surrogate.fit` returns it.

    Returns
    -------
    SobolIndices

    Notes
    -----
    In normalised Legendre polynomials f = Σ_α c_α P_α, and Var f = Σ_{α≠0} c_α². The first-order index of x_k has the
    terms with α_k > 0 alone, the total index all terms with α_k > 0 (Sudret, Global sensitivity analysis using
    polynomial chaos expansions, 2008).

    Each part of the variance is the square of a projection of f, and an error of at most ε over the box changes the
    norm of a projection by at most ε. A part V_u of the variance V of the surrogate therefore gives an index between
    (√V_u − ε)²/(√V + ε)² and (√V_u + ε)²/(√V − ε)².

    Examples
    --------
    >>> from dalembert.surrogate import Tensor, fit, sobol_indices
    >>> found = sobol_indices(fit(lambda x: x[:, :1] + 2 * x[:, 1:], [0.0, 0.0], [1.0, 1.0], Tensor(3)))
    >>> found.first[:, 0].round(6).tolist(), found.variance.round(6).tolist()
    ([0.2, 0.8], [0.416667])
    """
    exponents, coefficients = in_legendre(surrogate.polynomial)
    squares, active = coefficients**2, exponents > 0
    of_all = active.any(axis=1)
    alone = active & (active.sum(axis=1) == 1)[:, None]
    mean = coefficients[~of_all].sum(axis=0)
    squares[:, squares[of_all].sum(axis=0) <= (NOTHING * mean) ** 2] = 0.0
    first, total = alone.T @ squares, active.T @ squares
    return _indices(mean, squares[of_all].sum(axis=0), first, total, np.asarray(surrogate.error, dtype=float))


def _indices(
    mean: np.ndarray, variance: np.ndarray, first: np.ndarray, total: np.ndarray, error: np.ndarray
) -> SobolIndices:
    """Indices from parts of the variance, shape (d, outputs)."""
    first_ends, total_ends = (_ends(part, variance, error) for part in (first, total))
    with np.errstate(invalid="ignore", divide="ignore"):
        return SobolIndices(mean, variance, first / variance, total / variance, first_ends, total_ends, error)


def in_legendre(polynomial: ChebyshevPolynomial) -> tuple[np.ndarray, np.ndarray]:
    """Return exponents (terms, d) and coefficients (terms, outputs) of a polynomial in normalised Legendre polynomials.

    Their squares have the mean 1 over the box. Direction after direction, T_n = Σ_j M_nj P_j.
    """
    exponents, coefficients = polynomial.exponents, polynomial.coefficients
    for direction, degree in enumerate(polynomial.degrees.tolist()):
        others = np.delete(exponents, direction, axis=1)
        rows, row = np.unique(others, axis=0, return_inverse=True)
        table = np.zeros((len(rows), degree + 1, coefficients.shape[1]))
        table[row.reshape(-1), exponents[:, direction]] = coefficients
        longest = np.zeros(len(rows), dtype=int)
        np.maximum.at(longest, row.reshape(-1), exponents[:, direction])
        at, degrees = np.nonzero(np.arange(degree + 1) <= longest[:, None])
        exponents = np.insert(rows[at], direction, degrees, axis=1)
        coefficients = np.einsum("nj,rno->rjo", _change(degree), table)[at, degrees]
    return exponents, coefficients


def _change(degree: int) -> np.ndarray:
    """M_nj = ½ ∫ T_n P_j over [−1, 1], exact by Gauss and Legendre's rule, shape (degree + 1, degree + 1)."""
    nodes, weights = leggauss(degree + 1)
    legendre = legvander(nodes, degree) * np.sqrt(2 * np.arange(degree + 1) + 1)
    return chebvander(nodes, degree).T @ (0.5 * weights[:, None] * legendre)


def _ends(parts: np.ndarray, variance: np.ndarray, error: np.ndarray) -> np.ndarray:
    """Lower and upper ends of indices, shape (2, d, outputs)."""
    norms, whole = np.sqrt(parts), np.sqrt(variance)
    with np.errstate(invalid="ignore", divide="ignore"):
        lower = (np.maximum(norms - error, 0.0) / (whole + error)) ** 2
        upper = np.where(whole > error, ((norms + error) / (whole - error)) ** 2, 1.0)
    return np.stack([lower, np.minimum(upper, 1.0)])
