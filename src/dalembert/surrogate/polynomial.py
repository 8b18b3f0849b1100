"""Polynomials of several variables in Chebyshev form, with many outputs at once."""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from dalembert.errors import InputError
from dalembert.intervals import placed
from dalembert.kernels.words import Integers, Integers2, Reals3
from dalembert.surrogate.basis import chebyshev, products


class Rows(NamedTuple):
    """Terms that differ only in their degree in one direction, the inner one, side by side. ``degrees`` (d,): of the
    polynomial; ``inner``: the direction of highest degree; ``exponents``, ``active`` (rows, d): degrees above zero in
    the other directions, and these directions, of which the first ``counts`` (rows,) entries count; ``lengths``
    (rows,): numbers of terms, of degrees 0, 1, 2 … in the inner direction; ``coefficients`` (outputs, rows, longest):
    zero where a term is absent.
    """

    degrees: Integers
    inner: int
    exponents: Integers2
    active: Integers2
    counts: Integers
    lengths: Integers
    coefficients: Reals3


@dataclass(frozen=True, eq=False)
class ChebyshevPolynomial:
    """f(x) = Σ_t c_t Π_k T_{e_tk}(η_k), with η = (2x − lower − upper)/(upper − lower) in [−1, 1]^d on its box.

    Parameters
    ----------
    lower, upper : array, shape (d,)
        Its box, ``lower <= upper``. In a direction without width it is constant: all exponents there are zero.
    exponents : array of int, shape (terms, d)
        Degrees e_tk of the Chebyshev polynomials of each term.
    coefficients : array, shape (terms, outputs)

    Raises
    ------
    InputError
        For shapes that do not fit, or a degree above zero in a direction without width.

    Notes
    -----
    T_n(cos φ) = cos nφ: no term is larger than its coefficient inside the box, so what the last terms carry can be
    read off. Outside the box the polynomial is defined, and grows fast.

    Examples
    --------
    >>> square = ChebyshevPolynomial([-1.0], [3.0], [[0], [1], [2]], [[3.0], [4.0], [2.0]])  # x = 1 + 2η
    >>> square([[-1.0], [0.0], [3.0]])[:, 0].tolist()
    [1.0, 0.0, 9.0]
    >>> square.gradient([[3.0]])[0, 0].tolist()
    [6.0]
    """

    lower: np.ndarray
    upper: np.ndarray
    exponents: np.ndarray
    coefficients: np.ndarray

    def __post_init__(self) -> None:
        for name, kind in (("lower", float), ("upper", float), ("exponents", int), ("coefficients", float)):
            object.__setattr__(self, name, np.asarray(getattr(self, name), dtype=kind))
        shapes = self.lower.shape, self.upper.shape, self.exponents.shape, self.coefficients.shape
        d, terms = self.lower.size, len(self.exponents)
        if shapes != ((d,), (d,), (terms, d), (terms, *self.coefficients.shape[-1:])):
            raise InputError(
                "a polynomial has bounds of shapes {} and {}, exponents of shape {} and coefficients of shape {}; "
                "expected (d,), (d,), (terms, d) and (terms, outputs)".format(*shapes)
            )
        if np.any(self.exponents[:, self.lower == self.upper]):
            raise InputError("a polynomial has a degree above zero in a direction without width; expected zero there")

    @cached_property
    def degrees(self) -> np.ndarray:
        """Highest degree in each direction, shape (d,)."""
        return self.exponents.max(axis=0, initial=0)

    @cached_property
    def slope(self) -> np.ndarray:
        """dη/dx, shape (d,); zero in a direction without width."""
        width = self.upper - self.lower
        return np.divide(2.0, width, out=np.zeros_like(width), where=width > 0)

    @cached_property
    def rows(self) -> Rows:
        """The terms in the order in which they are fast to sum.

        >>> plane = ChebyshevPolynomial([0, 0], [1, 1], [[0, 0], [0, 2], [1, 0]], [[1.0], [2.0], [3.0]])
        >>> plane.rows.coefficients[0].tolist(), plane.rows.lengths.tolist()
        ([[1.0, 0.0, 2.0], [3.0, 0.0, 0.0]], [3, 1])
        """
        inner = int(np.argmax(self.degrees))
        degree = self.exponents[:, inner]
        outer = self.exponents.copy()
        outer[:, inner] = 0
        exponents, row = np.unique(outer, axis=0, return_inverse=True)
        row = row.reshape(-1)
        lengths = np.zeros(len(exponents), dtype=int)
        np.maximum.at(lengths, row, degree + 1)
        coefficients = np.zeros((self.coefficients.shape[1], len(exponents), lengths.max(initial=1)))
        np.add.at(coefficients.transpose(1, 2, 0), (row, degree), self.coefficients)
        absent = exponents == 0
        order = np.argsort(absent, axis=1, kind="stable")
        exponents, counts = np.take_along_axis(exponents, order, axis=1), np.sum(~absent, axis=1)
        return Rows(self.degrees, inner, exponents, order, counts, lengths, coefficients)

    def eta(self, points: ArrayLike) -> np.ndarray:
        """Coordinates η of points (..., d), in [−1, 1] inside the box and exact at its ends."""
        points = np.asarray(points, dtype=float)
        middle = (self.lower + self.upper) / 2
        # From the nearer end: η is ±1 exactly at both ends, and no point of the box lies outside by rounding.
        eta = np.where(points > middle, 1 - (self.upper - points) * self.slope, (points - self.lower) * self.slope - 1)
        return np.where((self.slope == 0) | (points == middle), 0.0, eta)

    def points(self, eta: np.ndarray) -> np.ndarray:
        """Points x of coordinates η in [−1, 1], shape (..., d)."""
        return placed(self.lower, self.upper, eta)

    def __call__(self, points: ArrayLike) -> np.ndarray:
        """Values at points (n, d), shape (n, outputs)."""
        return products(chebyshev(self.eta(self._checked(points)), self.degrees), self.exponents) @ self.coefficients

    def gradient(self, points: ArrayLike) -> np.ndarray:
        """Derivatives with respect to x at points (n, d), shape (n, outputs, d)."""
        eta = self.eta(self._checked(points))
        values, slopes = (chebyshev(eta, self.degrees, derivative) for derivative in (0, 1))
        columns = [
            products([*values[:k], slopes[k], *values[k + 1 :]], self.exponents) @ self.coefficients * self.slope[k]
            for k in range(len(self.lower))
        ]
        return np.stack(columns, axis=-1) if columns else np.zeros((len(eta), self.coefficients.shape[1], 0))

    def _checked(self, points: ArrayLike) -> np.ndarray:
        points = np.asarray(points, dtype=float)
        if points.ndim != 2 or points.shape[1] != len(self.lower):
            raise InputError(f"points of shape {points.shape} were given; expected (n, {len(self.lower)})")
        return points
