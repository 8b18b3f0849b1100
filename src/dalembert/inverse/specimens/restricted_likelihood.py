"""Restricted likelihood of the spread of parameters between specimens.

Estimates x_i of the k parameters of specimen i are x_i = μ + b_i + e_i with b_i ~ N(0, Ω) between the specimens and
e ~ N(0, C) by the fits. Of all m specimens, stacked: x ~ N(X μ, V), V = I ⊗ Ω + C, X = 1 ⊗ I, and up to a constant

    ℓ(Ω) = −½ (log det V + log det XᵀV⁻¹X + (x − X μ̂)ᵀ V⁻¹ (x − X μ̂)),    μ̂ = (XᵀV⁻¹X)⁻¹ XᵀV⁻¹ x.

Source: Patterson and Thompson, Recovery of inter-block information when block sizes are unequal (1971); for several
parameters: Jackson, Riley and White, Multivariate meta-analysis (2011).
"""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize

STEP = 1e-30  # of the complex step


@dataclass(frozen=True, eq=False)
class Likelihood:
    """The restricted likelihood of estimates.

    Parameters
    ----------
    values : array, shape (specimens, parameters)
    covariance : array, shape (specimens · parameters, specimens · parameters)
        C, of the values of one specimen after the other.
    """

    values: np.ndarray
    covariance: np.ndarray

    def mean(self, spread: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return μ̂ and its covariance (XᵀV⁻¹X)⁻¹ at Ω."""
        inverse = np.linalg.inv(self._total(spread))
        weighted, information = self._weighted(inverse)
        known = np.linalg.inv(information)
        return known @ weighted.T @ self.values.ravel(), known

    def residual_product(self, spread: np.ndarray) -> float:
        """Return (x − X μ̂)ᵀ V⁻¹ (x − X μ̂) at Ω."""
        x = self.values.ravel()
        return float(x @ self._projection(spread) @ x)

    def adjusted(self, spread: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the best predictions μ̂ + E[b_i | x] of each specimen and their deviations, both as ``values``.

        They are x − C P x with covariance C − C P C, which contains the uncertainty of μ̂.
        """
        shape, gain = self.values.shape, self.covariance @ self._projection(spread)
        estimates = self.values - (gain @ self.values.ravel()).reshape(shape)
        variances = np.diag(self.covariance - gain @ self.covariance)
        return estimates, np.sqrt(np.maximum(variances, 0.0)).reshape(shape)

    def value_and_slope(self, spread: np.ndarray) -> tuple[float, np.ndarray]:
        """Return ℓ and its derivatives ∂ℓ/∂Ω = ½ Σ_i ((Px)_i (Px)_iᵀ − P_ii), of shape (parameters, parameters)."""
        (m, k), x = self.values.shape, self.values.ravel()
        total = self._total(spread)
        inverse = np.linalg.inv(total)
        projection = self._projection(spread, inverse)
        logarithms = np.linalg.slogdet(total)[1] + np.linalg.slogdet(self._weighted(inverse)[1])[1]
        errors = (projection @ x).reshape(m, k)
        slope = 0.5 * (errors.T @ errors - np.einsum("iaib->ab", projection.reshape(m, k, m, k)))
        return float(-0.5 * (logarithms + x @ projection @ x)), slope

    def _total(self, spread: np.ndarray) -> np.ndarray:
        return np.kron(np.eye(len(self.values)), spread) + self.covariance

    def _weighted(self, inverse: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """V⁻¹X and XᵀV⁻¹X."""
        m, k = self.values.shape
        weighted = inverse.reshape(-1, m, k).sum(axis=1)
        return weighted, weighted.reshape(m, k, k).sum(axis=0)

    def _projection(self, spread: np.ndarray, inverse: np.ndarray | None = None) -> np.ndarray:
        """P = V⁻¹ − V⁻¹X(XᵀV⁻¹X)⁻¹XᵀV⁻¹."""
        inverse = np.linalg.inv(self._total(spread)) if inverse is None else inverse
        weighted, information = self._weighted(inverse)
        return inverse - weighted @ np.linalg.solve(information, weighted.T)


@dataclass(frozen=True, eq=False)
class SpreadForm:
    """Ω by unknowns without bounds: deviations σ and, with correlations, the rows l_a of a lower triangle.

    Ω_ab = σ_a σ_b l_a·l_b / (‖l_a‖ ‖l_b‖), with 1 on the diagonal of the triangle. Every Ω of full rank has this form.
    """

    parameters: int
    correlated: bool

    @property
    def unknowns(self) -> int:
        k = self.parameters
        return k + (k * (k - 1) // 2 if self.correlated else 0)

    def matrix(self, unknowns: np.ndarray) -> np.ndarray:
        """Return Ω, complex where the unknowns are."""
        k = self.parameters
        rows = np.eye(k, dtype=unknowns.dtype)
        if self.correlated:
            rows[np.tril_indices(k, -1)] = unknowns[k:]
        rows *= (unknowns[:k] / np.sqrt((rows * rows).sum(axis=1)))[:, None]
        return rows @ rows.T

    def slopes(self, unknowns: np.ndarray) -> np.ndarray:
        """Return ∂Ω/∂u by the complex step, shape (unknowns, parameters, parameters)."""
        steps = unknowns + 1j * STEP * np.eye(self.unknowns)
        return np.imag([self.matrix(step) for step in steps]) / STEP


def most_likely(likelihood: Likelihood, form: SpreadForm) -> tuple[np.ndarray, float]:
    """Return the unknowns of the largest restricted likelihood, and that likelihood, of values that are scaled to a
    size of about 1. At σ = 0 the slope is zero: a descent may end there that is not at the maximum. The better of two
    starts counts.
    """
    k = form.parameters
    starts = [np.concatenate([np.full(k, size), np.zeros(form.unknowns - k)]) for size in (1.0, 0.2)]
    ends = [_climbed(likelihood, form, start, np.arange(form.unknowns)) for start in starts]
    unknowns, best = max(ends, key=lambda end: end[1])
    return np.concatenate([np.abs(unknowns[:k]), unknowns[k:]]), best  # the sign of a σ has no meaning


def profiled(likelihood: Likelihood, form: SpreadForm, start: np.ndarray, number: int, size: float) -> float:
    """Return the largest restricted likelihood with a σ held, from unknowns near its maximum."""
    fixed = np.where(np.arange(form.unknowns) == number, size, start)
    return _climbed(likelihood, form, fixed, np.delete(np.arange(form.unknowns), number))[1]


def _climbed(likelihood: Likelihood, form: SpreadForm, start: np.ndarray, free: np.ndarray) -> tuple[np.ndarray, float]:
    """The unknowns of the maximum over those that are free, and the likelihood there."""

    def whole(unknowns: np.ndarray) -> np.ndarray:
        full = start.copy()
        full[free] = unknowns
        return full

    def loss(unknowns: np.ndarray) -> tuple[float, np.ndarray]:
        full = whole(unknowns)
        value, slope = likelihood.value_and_slope(form.matrix(full))
        return -value, -np.einsum("uab,ab->u", form.slopes(full), slope)[free]

    if free.size == 0:
        return start, likelihood.value_and_slope(form.matrix(start))[0]
    minimum = minimize(loss, start[free], jac=True, method="BFGS", options={"gtol": 1e-8})
    return whole(minimum.x), -float(minimum.fun)
