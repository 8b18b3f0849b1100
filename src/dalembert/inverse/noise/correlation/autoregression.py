"""Autoregressive noise of evenly sampled residuals, gaps allowed."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dalembert.inverse.noise.correlation.series import Series
from dalembert.inverse.noise.correlation.whiteness import lagged, on_grid, pairs

MOST = 10
"""Highest order."""

TINY = 1e-9
"""Rounding of autocorrelations."""


@dataclass(frozen=True, eq=False)
class Autoregression:
    """Stationary noise e_t = Σ_j φ_j e_{t−j} + white noise."""

    coefficients: np.ndarray  # (order,): φ
    covariances: np.ndarray  # (places,): autocovariances at lags of 0 and more places of the grid

    @property
    def order(self) -> int:
        return len(self.coefficients)

    @property
    def variance(self) -> float:
        return float(self.covariances[0])

    @property
    def first(self) -> float:
        """Autocorrelation of neighbours."""
        return float(self.covariances[1] / self.covariances[0])

    @property
    def slowest(self) -> float:
        """Factor from sample to sample of the slowest part of the autocorrelation; below 1 for a stationary process."""
        return float(np.max(np.abs(np.roots([1.0, *-self.coefficients])), initial=0.0))

    def decay(self, step: float) -> float:
        """Return the time in which the slowest part of the autocorrelation decays by e, for samples every ``step``."""
        return -step / np.log(self.slowest) if self.slowest > 0 else 0.0

    def product(self, series: Series, basis: np.ndarray) -> np.ndarray:
        """Return BᵀΣB, shape (columns, columns), for a basis B (values, columns) and the noise's covariance Σ."""
        assert series.grid is not None
        table = on_grid(series.grid, basis)
        return table.T @ self.applied(table)

    def applied(self, table: np.ndarray) -> np.ndarray:
        """Return the covariance of all places of the grid times a table (places, columns)."""
        from scipy.linalg import matmul_toeplitz

        return matmul_toeplitz(self.covariances, table)


@dataclass(frozen=True, eq=False)
class Moments:
    """Sums of products of residuals at each lag, and the estimate of the noise's autocovariances so far."""

    series: Series
    # basis: (places, parameters): on the grid, 0 in gaps (see
    # :func:`~dalembert.inverse.noise.correlation.whiteness.p_value`)
    basis: np.ndarray
    # count, sums, covariances: (lags + 1,): number of pairs, sum of their products, and estimated autocovariance of the
    # noise
    count: np.ndarray
    sums: np.ndarray
    covariances: np.ndarray

    @cached_property
    def process(self) -> Autoregression:
        """The process of the order of least AICc. Nearly perfect correlation makes the equations of high orders
        singular: orders whose process is not stationary, by rounding, are left out.
        """
        number = int(self.count[0])
        most = 1 - 2 / number
        coefficients, variances = levinson(self.covariances, most)
        orders = np.arange(1, len(coefficients) + 1)
        criterion = number * np.log(variances) + 2 * (orders + 1) * number / (number - orders - 2)
        for place in np.argsort(criterion):
            correlations = autocorrelations(coefficients[place], len(self.basis))
            process = Autoregression(coefficients[place], self.covariances[0] * correlations)
            if process.slowest < 1 and np.max(np.abs(correlations)) <= 1 + TINY:
                return process
        raise AssertionError("a process of order 1 is stationary")

    def corrected(self, common: np.ndarray) -> "Moments":
        """Return the moments with the bias that the fit of parameters causes taken off. Residuals are r = (I − QQᵀ) e,
        so that E[r rᵀ] = Σ − QQᵀΣ − ΣQQᵀ + Q (QᵀΣQ) Qᵀ; ``common`` is QᵀΣQ of all residuals. The variance is at least
        half and at most twice that of the residuals: a larger bias is that of residuals that are no noise.
        """
        applied = self.process.applied(self.basis)
        assert self.series.grid is not None
        applied[np.delete(np.arange(len(applied)), self.series.grid)] = 0.0  # gaps
        reduced = self.basis @ common
        bias = np.array(
            [
                lagged(reduced, self.basis, lag) - lagged(self.basis, applied, lag) - lagged(applied, self.basis, lag)
                for lag in range(len(self.count))
            ]
        )
        most = self.sums[0] if bias[0] < 0 else self.sums[0] / 2
        if abs(bias[0]) > most:
            bias *= most / abs(bias[0])
        return Moments(self.series, self.basis, self.count, self.sums, (self.sums - bias) / self.count)


def moments(series: Series, values: np.ndarray, basis: np.ndarray) -> Moments:
    """Return the moments of weighted residuals (values,) on an even grid."""
    assert series.grid is not None
    count = pairs(series.grid, min(MOST, max(1, len(values) // 10)))
    lags = int(np.argmax(np.append(count, 0.0) < len(values) / 4)) - 1  # rare pairs say little
    count, on_grid_values = count[: max(1, lags) + 1], on_grid(series.grid, values)
    sums = np.array([lagged(on_grid_values, on_grid_values, lag) for lag in range(len(count))])
    return Moments(series, on_grid(series.grid, basis), count, sums, sums / count)


def levinson(covariances: np.ndarray, most: float) -> tuple[list[np.ndarray], np.ndarray]:
    """Return the coefficients and the variances of the white noise of processes of order 1, 2 and so on. Partial
    autocorrelations are limited to ±``most``, so that each process is stationary. Source: J. Durbin, The fitting of
    time-series models, Review of the International Statistical Institute 28 (1960).
    """
    rows, variances = [], []
    row, variance = np.zeros(0), covariances[0]
    for order in range(1, len(covariances)):
        partial = (covariances[order] - row @ covariances[order - 1 : 0 : -1]) / variance
        partial = np.clip(partial, -most, most)
        row = np.append(row - partial * row[::-1], partial)
        variance *= 1 - partial**2
        rows.append(row)
        variances.append(variance)
    return rows, np.array(variances)


def autocorrelations(coefficients: np.ndarray, number: int) -> np.ndarray:
    """Return the first autocorrelations (number,) of a stationary process, from the Yule–Walker equations."""
    from scipy.signal import lfilter, lfiltic

    order = len(coefficients)
    rows, columns = np.indices((order, order))
    lags = np.abs(rows - columns)
    system = np.eye(order)
    later = lags > 0
    np.subtract.at(system, (rows[later], lags[later] - 1), coefficients[columns[later]])
    start = np.linalg.solve(system, coefficients)
    feedback = np.concatenate([[1.0], -coefficients])
    if number > order + 1:
        state = lfiltic([1.0], feedback, start[::-1])
        start = np.concatenate([start, lfilter([1.0], feedback, np.zeros(number - order - 1), zi=state)[0]])
    return np.concatenate([[1.0], start])[:number]
