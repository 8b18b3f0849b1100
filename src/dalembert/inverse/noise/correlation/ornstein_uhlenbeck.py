"""Noise of unevenly sampled residuals whose correlation decays exponentially."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from dalembert.inverse.noise.correlation.series import Series


@dataclass(frozen=True, eq=False)
class OrnsteinUhlenbeck:
    """Stationary noise with the covariance σ² exp(−|Δt|/τ)."""

    variance: float  # σ²
    time: float  # τ, in units of the coordinate
    first: float  # correlation at the median interval
    order: int = 1

    def decay(self, step: float) -> float:
        """Return τ."""
        return self.time

    def product(self, series: Series, basis: np.ndarray) -> np.ndarray:
        """Return BᵀΣB, shape (columns, columns), for a basis B (values, columns) and the noise's covariance Σ."""
        factors = np.exp(-np.diff(series.along) / self.time)
        before = np.zeros_like(basis)  # Σ over earlier rows, each times its correlation
        for row, factor in enumerate(factors, start=1):
            before[row] = factor * (before[row - 1] + basis[row - 1])
        cross = basis.T @ before
        return self.variance * (basis.T @ basis + cross + cross.T)


def ornstein_uhlenbeck(series: Series, values: np.ndarray, basis: np.ndarray) -> OrnsteinUhlenbeck:
    """Return the process of the largest restricted likelihood for weighted residuals (values,).

    With φ_k = exp(−Δt_k/τ) whitened residuals are e_1 = r_1, e_k = (r_k − φ_k r_{k−1}) / √(1 − φ_k²), and so are the
    rows of the ``basis`` Q. The restricted likelihood −½ [(n − ν) log σ² + Σ log(1 − φ_k²) + (ν/p) log|QᵀΣ⁻¹Q|] allows
    for the ν degrees of freedom that this series lost to the p parameters. Source: H. D. Patterson, R. Thompson,
    Recovery of inter-block information when block sizes are unequal, Biometrika 58 (1971).
    """
    from scipy.optimize import minimize_scalar

    intervals = np.diff(series.along)
    lost = float(np.sum(basis**2))
    share = lost / basis.shape[1]

    def whitened(table: np.ndarray, factors: np.ndarray) -> np.ndarray:
        left = np.sqrt(1 - factors**2)
        shape = (-1, *[1] * (table.ndim - 1))
        return np.concatenate([table[:1], (table[1:] - factors.reshape(shape) * table[:-1]) / left.reshape(shape)])

    def of(logarithm: float) -> tuple[float, float]:
        """Twice the negative log-likelihood, and σ²."""
        factors = np.exp(-intervals / np.exp(logarithm))
        variance = float(np.sum(whitened(values, factors) ** 2)) / (len(values) - lost)
        grams = whitened(basis, factors)
        size = np.linalg.slogdet(grams.T @ grams + 1e-12 * np.eye(basis.shape[1]))[1]
        return (len(values) - lost) * np.log(variance) + np.sum(np.log1p(-(factors**2))) + share * size, variance

    bounds = np.log(np.min(intervals) / 10), np.log(series.length)
    minimum: Any = minimize_scalar(lambda logarithm: of(logarithm)[0], bounds=bounds, method="bounded")
    time = float(np.exp(minimum.x))
    return OrnsteinUhlenbeck(of(minimum.x)[1], time, float(np.exp(-series.step / time)))
