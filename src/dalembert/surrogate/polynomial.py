"""Polynomials of several variables in Chebyshev form, with many outputs at once."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from dalembert.errors import InputError
from dalembert.intervals import placed
from dalembert.surrogate.basis import chebyshev, products


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
        directions = self.lower.shape
        terms = self.exponents.shape[0]
        if (
            len(directions) != 1
            or self.upper.shape != directions
            or self.exponents.shape != (terms, *directions)
            or self.coefficients.ndim != 2
            or len(self.coefficients) != terms
        ):
            raise InputError(
                f"a polynomial has bounds of shapes {self.lower.shape} and {self.upper.shape}, exponents of shape "
                f"{self.exponents.shape} and coefficients of shape {self.coefficients.shape}; "
                "expected (d,), (d,), (terms, d) and (terms, outputs)"
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

    def eta(self, points: ArrayLike) -> np.ndarray:
        """Coordinates η of points (..., d), in [−1, 1] inside the box and exact at its ends."""
        points = np.asarray(points, dtype=float)
        fixed = self.slope == 0
        middle = (self.lower + self.upper) / 2
        return np.where(
            fixed | (points == middle),
            0.0,
            np.where(points > middle, 1 - (self.upper - points) * self.slope, (points - self.lower) * self.slope - 1),
        )

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
