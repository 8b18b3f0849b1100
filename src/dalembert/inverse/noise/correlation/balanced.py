"""Residuals of a fit whose channels differ in noise, as a fit would leave them that weights each by its noise."""

from collections.abc import Sequence

import numpy as np

from dalembert.inverse.noise.correlation.series import Series

ROUNDS = 2
"""Estimates of the noise of each series: the first one still has what the noise of others added."""

LEAST = 1e-6
"""Smallest noise of a series, as a part of the largest one: that of rounding."""


def balanced(series: Sequence[Series], residual: np.ndarray, basis: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return weighted residuals and the basis of what was fitted, if each series had counted by its own noise.
    ``residual`` (values,): weighted residuals r of a fit that takes the noise of all series for equal. ``basis``
    (values, parameters): orthonormal basis U of the weighted jacobian's columns.

    The residuals of the fit are r = (I − UUᵀ) e. Where the noise e of one series is larger, its part along U enters the
    residuals of the others: it has the shape of the response's derivatives, and tests take it for periodic or
    correlated. One Gauss–Newton step with the weights 1/σ² leads to σ (I − QQᵀ) (r/σ), with an orthonormal basis Q of
    U/σ, where σ are the standard deviations of each series. These residuals have the covariance σ² (I − QQᵀ), which the
    tests allow for. What r has along U (parameters on their bounds, a search that ended early) is kept.
    """
    if len(series) < 2:
        return residual, basis
    along = basis @ (basis.T @ residual)
    left, fitted = residual - along, basis
    for _ in range(ROUNDS):
        sizes = noise_of(series, left, fitted)
        if not np.all(sizes > 0):
            return residual, basis
        fitted, _ = np.linalg.qr(basis / sizes[:, None])
        scaled = (residual - along) / sizes
        left = sizes * (scaled - fitted @ (fitted.T @ scaled))
    return left + along, fitted


def noise_of(series: Sequence[Series], residual: np.ndarray, basis: np.ndarray) -> np.ndarray:
    """Return the standard deviation of the noise of each value (values,), the same in a series; 1 outside of all."""
    freedom = [max(len(signal.rows) - float(np.sum(basis[signal.rows] ** 2)), 1.0) for signal in series]
    found = np.array([np.linalg.norm(residual[signal.rows]) for signal in series]) / np.sqrt(freedom)
    sizes = np.ones(len(residual))
    for signal, size in zip(series, np.maximum(found, LEAST * np.max(found)), strict=True):
        sizes[signal.rows] = size
    return sizes
