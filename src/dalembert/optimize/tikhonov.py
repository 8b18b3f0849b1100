"""Tikhonov's regularised least squares for many weights at once, and three ways to choose one."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

# Weights go down to this fraction of the largest singular value; a smaller singular value is zero to a simulation.
UNSEEN = 1e-10
DEARER = 1.4  # ϱ of cross-validation: what each unknown costs, in values
PER_DECADE = 12  # weights looked at a decade


@dataclass(frozen=True, eq=False)
class Regularised:
    """All minima of ‖A d − b‖² + μ² ‖d‖², from one singular value decomposition A = U diag(s) Vᵀ.

    Parameters
    ----------
    singular : array, shape (k,)
        s, largest first, of the directions that A sees.
    parts : array, shape (k,)
        Uᵀ b.
    directions : array, shape (k, parameters)
        Vᵀ.
    outside : float
        Norm of the part of b that A cannot reach.
    values : int
        Number of values that b has.

    Notes
    -----
    d(μ) = Σ f s⁻¹ (Uᵀb) v with f = s²/(s² + μ²); its residual has the parts (1 − f) Uᵀb and what is outside.

    Examples
    --------
    >>> many = Regularised.of(np.array([[3.0, 0.0], [0.0, 4.0], [0.0, 0.0]]), [9.0, 8.0, 2.0])
    >>> many.steps([0.0, 4.0]).round(12).tolist()
    [[3.0, 2.0], [1.08, 1.0]]
    >>> many.residual_norms([0.0]).tolist()
    [2.0]
    """

    singular: np.ndarray
    parts: np.ndarray
    directions: np.ndarray
    outside: float
    values: int

    @staticmethod
    def of(matrix: np.ndarray, right: ArrayLike) -> "Regularised":
        """The problem of a matrix A (values, parameters) and a vector b (values,).

        Directions that A does not see are left out: their step would be noise over rounding.
        """
        b = np.asarray(right, dtype=float)
        u, s, v = np.linalg.svd(matrix, full_matrices=False)
        seen = s >= UNSEEN * s[0]
        u, s, v = u[:, seen], s[seen], v[seen]
        parts = u.T @ b
        return Regularised(s, parts, v, float(np.linalg.norm(b - u @ parts)), len(b))

    def steps(self, mu: ArrayLike) -> np.ndarray:
        """d of each weight (...,), shape (..., parameters); for μ = 0 the shortest of the minima."""
        return (self._kept(mu) * self._full) @ self.directions

    def residual_norms(self, mu: ArrayLike) -> np.ndarray:
        """‖A d − b‖ of each weight, both (...,)."""
        return np.sqrt(np.sum(((1 - self._kept(mu)) * self.parts) ** 2, axis=-1) + self.outside**2)

    def step_norms(self, mu: ArrayLike) -> np.ndarray:
        """‖d‖ of each weight, both (...,)."""
        return np.linalg.norm(self._kept(mu) * self._full, axis=-1)

    def weight_of(self, length: float) -> float:
        """Smallest weight, from :attr:`least` up, whose step is no longer than a positive length."""
        return self._crossing(lambda mu: float(self.step_norms(mu)) - length)

    @property
    def least(self) -> float:
        """Weight that changes no step: what A sees less than that is left out."""
        return UNSEEN * float(self.singular[0])

    @cached_property
    def weights(self) -> np.ndarray:
        """Weights of the L-curve, increasing: from where the smallest seen singular value no longer feels them."""
        low, high = max(1e-5 * float(self.singular[-1]), self.least), 10 * float(self.singular[0])
        return np.geomspace(low, high, 1 + int(np.ceil(PER_DECADE * np.log10(high / low))))

    def curvature(self, mu: ArrayLike) -> np.ndarray:
        """Curvature of the L-curve, log ‖d‖ over log ‖A d − b‖, at each weight; positive at the corner of an L."""
        f = self._kept(mu)
        # Hansen (1992): κ = (x′y″ − y′x″)/(x′² + y′²)^(3/2) with x = log ‖A d − b‖, y = log ‖d‖.
        g, squares, lengths = 1 - f, self.parts**2, self._full**2
        # Derivatives with respect to log μ, in which f' = −2 f (1 − f).
        none = np.finfo(float).tiny
        # Logarithmic derivatives of ‖A d − b‖² and of ‖d‖² by log μ, first and second, in closed form.
        residual = np.sum(g**2 * squares, axis=-1) + self.outside**2 + none
        residual1 = 4 * np.sum(f * g**2 * squares, axis=-1) / residual
        residual2 = -8 * np.sum(f * g**2 * (1 - 3 * f) * squares, axis=-1) / residual
        step = np.sum(f**2 * lengths, axis=-1) + none
        step1 = -4 * np.sum(f**2 * g * lengths, axis=-1) / step
        step2 = 8 * np.sum(f**2 * g * (2 - 3 * f) * lengths, axis=-1) / step
        # log ‖·‖ is half of log ‖·‖²; (log h)″ = h″/h − (h′/h)².
        x1, y1 = residual1 / 2, step1 / 2
        x2, y2 = (residual2 - residual1**2) / 2, (step2 - step1**2) / 2
        return (x1 * y2 - y1 * x2) / np.maximum(x1**2 + y1**2, none ** (1 / 4)) ** 1.5

    def corner(self, sharp: float = 1.0) -> float:
        """Weight at the corner of the L-curve, where its curvature is largest; :attr:`least` if none is ``sharp``.

        A curvature below 1 is a bend over a factor of e or more in both norms: no corner. So it is where every
        direction is determined by the data, and Gauss and Newton's step needs no regularisation.

        Source: Hansen, Analysis of discrete ill-posed problems by means of the L-curve, SIAM Review 34 (1992).
        """
        bends = self.curvature(self.weights)
        inner = 1 + int(np.argmax(bends[1:-1]))
        if not bends[inner] >= sharp:
            return self.least
        return self._refined(lambda mu: -float(self.curvature(mu)), inner)

    def gcv(self) -> float:
        """Weight of least generalised cross-validation ‖A d − b‖² / (values − ϱ Σ f)².

        With ϱ = 1, as it was published first, few values often leave a weight that is far too small.

        Infinite where no step at all scores best: b is noise then. :attr:`least` where no value is left over to
        validate by, or no weight scores best.

        Source: Golub, Heath & Wahba, Technometrics 21 (1979); ϱ: Kim & Gu, Journal of the Royal Statistical Society B
        66 (2004).
        """

        def score(mu: ArrayLike) -> np.ndarray:
            # Values less the effective number of unknowns Σ f, each of which costs ϱ; kept above zero, where the score
            # would change its sign.
            left = self.values - DEARER * np.sum(self._kept(mu), axis=-1)
            return (self.residual_norms(mu) / np.maximum(left, 1e-3 * self.values)) ** 2

        last = len(self.weights) - 1
        best = int(np.argmin(score(self.weights))) if self.values > len(self.singular) else 0
        if best in (0, last):
            return np.inf if best else self.least
        return self._refined(lambda mu: float(score(mu)), best)

    def discrepancy(self, noise: float) -> float:
        """Largest weight whose residual is no longer than the noise: infinite where b is noise alone.

        :attr:`least` where no weight gets there.

        Source: Morozov (1966).
        """
        if np.hypot(np.linalg.norm(self.parts), self.outside) <= noise:
            return np.inf
        return self._crossing(lambda mu: noise - float(self.residual_norms(mu)))

    def _crossing(self, excess: Callable[[float], float]) -> float:
        """Weight at which an excess, which falls as the weight grows, is zero; :attr:`least` if there is none there."""
        from scipy.optimize import brentq

        low, high = self.least, float(self.singular[0])
        if excess(low) <= 0:
            return low
        # The excess falls with μ: the bracket grows until it holds the zero, then Brent finds it in log μ.
        while excess(high) > 0:
            high *= 10
        place: Any = brentq(lambda at: excess(np.exp(at)), np.log(low), np.log(high))
        return float(np.exp(place))

    def _refined(self, score: Callable[[float], float], place: int) -> float:
        """Weight of the least score between the neighbours of one of :attr:`weights`."""
        from scipy.optimize import minimize_scalar

        between = np.log(self.weights[[place - 1, place + 1]])
        minimum = minimize_scalar(lambda at: score(np.exp(at)), bounds=tuple(between), method="bounded")
        return float(np.exp(minimum.x))  # pyright: ignore[reportAttributeAccessIssue]

    @cached_property
    def _full(self) -> np.ndarray:
        """Parts of the step without any weight, (k,); zero where A is."""
        return self.parts / self.singular if self.singular[0] > 0 else np.zeros_like(self.parts)

    def _kept(self, mu: ArrayLike) -> np.ndarray:
        """f (..., k), the share that each part of the step keeps."""
        squares, weight = self.singular**2, np.asarray(mu, dtype=float)[..., None] ** 2
        return np.where(np.isfinite(weight), squares / np.maximum(squares + weight, np.finfo(float).tiny), 0.0)
