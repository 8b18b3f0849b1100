"""The terms of a polynomial in the order in which they are fast to sum."""

from dataclasses import dataclass

import numpy as np

from dalembert.surrogate.polynomial import ChebyshevPolynomial


@dataclass(frozen=True)
class Rows:
    """Terms that differ only in their degree in one direction, the inner one, side by side.

    Parameters
    ----------
    inner : int
        The direction of highest degree.
    exponents, active : array of int, shape (rows, d)
        Degrees above zero in the other directions, and these directions; the first ``counts`` (rows,) entries count.
    lengths : array of int, shape (rows,)
        Number of terms of each row, of degrees 0, 1, 2 … in the inner direction.
    coefficients : array, shape (outputs, rows, longest)
        Zero where a term is absent.
    """

    inner: int
    exponents: np.ndarray
    active: np.ndarray
    counts: np.ndarray
    lengths: np.ndarray
    coefficients: np.ndarray


def rows_of(polynomial: ChebyshevPolynomial) -> Rows:
    """Rows of a polynomial.

    >>> plane = ChebyshevPolynomial([0, 0], [1, 1], [[0, 0], [0, 2], [1, 0]], [[1.0], [2.0], [3.0]])
    >>> rows_of(plane).coefficients[0].tolist(), rows_of(plane).lengths.tolist()
    ([[1.0, 0.0, 2.0], [3.0, 0.0, 0.0]], [3, 1])
    """
    inner = int(np.argmax(polynomial.degrees))
    degree = polynomial.exponents[:, inner]
    outer = polynomial.exponents.copy()
    outer[:, inner] = 0
    exponents, row = np.unique(outer, axis=0, return_inverse=True)
    row = row.reshape(-1)
    lengths = np.zeros(len(exponents), dtype=int)
    np.maximum.at(lengths, row, degree + 1)
    coefficients = np.zeros((polynomial.coefficients.shape[1], len(exponents), lengths.max(initial=1)))
    np.add.at(coefficients.transpose(1, 2, 0), (row, degree), polynomial.coefficients)
    absent = exponents == 0
    order = np.argsort(absent, axis=1, kind="stable")
    return Rows(
        inner, np.take_along_axis(exponents, order, axis=1), order, np.sum(~absent, axis=1), lengths, coefficients
    )
