"""Weighted residuals of a fit, and what the fitted parameters took out of them."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Self

import numpy as np

from dalembert.inverse.least_squares.estimate import left_vectors
from dalembert.inverse.noise.correlation.balanced import balanced, noise_of
from dalembert.inverse.noise.correlation.correlated_residuals import NoiseProcess
from dalembert.inverse.noise.correlation.correlation import (
    Process,
    correlated_series,
    fitted_processes,
    noise_along,
    summaries,
)
from dalembert.inverse.noise.correlation.series import Series, series_of
from dalembert.inverse.noise.noise_floor import quantum
from dalembert.inverse.problem.problem import Linearisation, MisfitProblem
from dalembert.inverse.problem.search_coordinates import off_bounds

STATIONARY = 0.1
"""Squares of residuals that a last step may still take away, in variances of a residual."""


@dataclass(frozen=True, eq=False)
class Residuals:
    """Weighted residuals at a minimum."""

    problem: MisfitProblem
    at: Linearisation
    values: np.ndarray  # (values,): W^½ (R − data), flat from (samples, channels)
    basis: np.ndarray  # (values, columns): orthonormal; spans the changes that the fit could have explained
    free: np.ndarray  # (parameters,): parameters that are on no bound, which alone the basis is of
    known: bool  # whether the variance of a weighted residual is known to be 1

    @classmethod
    def of(cls, problem: MisfitProblem, at: Linearisation, *, known: bool) -> Self:
        """Return the residuals of a problem; with a robust loss their influence on the estimate."""
        plain = replace(problem, loss=None)
        slopes, values = plain.slopes(at, problem.model.parameters.scale), plain.residual(at.response)
        if problem.loss is not None:
            counted = problem.weights.ravel() > 0
            values[counted] = problem.loss.influence(values[counted])
        free = off_bounds(problem.model.parameters, at.vector)
        return cls(problem, at, values, left_vectors(slopes[:, free])[: at.response.size], free, known)

    @property
    def stationary(self) -> bool:
        """Whether the values are at a minimum: no step of the parameters takes more away than noise does."""
        return float(np.sum((self.basis.T @ self.values) ** 2)) <= STATIONARY * self.variance

    @cached_property
    def series(self) -> tuple[Series, ...]:
        """Each channel of each experiment."""
        return tuple(series_of(self.problem))

    @cached_property
    def variance(self) -> float:
        """Variance of a weighted residual: from the residuals, but at least 1 where it is known."""
        freedom = self.problem.compared - self.basis.shape[1]
        variance = float(self.values @ self.values) / freedom if freedom > 0 else np.nan
        return max(variance, 1.0) if self.known else variance

    @cached_property
    def variances(self) -> np.ndarray:
        """Variance of each weighted residual (values,): that of its series where the noise is not known."""
        if self.known or self.problem.loss is not None or len(self.series) < 2:
            return np.full(len(self.values), self.variance)
        return noise_of(self.series, *self.tested) ** 2

    @cached_property
    def tested(self) -> tuple[np.ndarray, np.ndarray]:
        """Residuals and basis that tests allow for: balanced where the noise of the series may differ."""
        if self.known or self.problem.loss is not None:
            return self.values, self.basis
        return balanced(self.series, self.values, self.basis)

    @cached_property
    def correlated(self) -> Mapping[Series, float]:
        """Series that are not white noise, with their probabilities to be so."""
        return correlated_series(self.series, *self.tested)

    @cached_property
    def fitted(self) -> list[tuple[Series, Process]]:
        """Noise process of each series that is not white noise."""
        return fitted_processes(list(self.correlated), self.values, self.basis, self.variance)

    @cached_property
    def processes(self) -> dict[str, NoiseProcess]:
        """What is known of these processes, by the series' name."""
        processes = summaries(self.correlated, self.fitted, self.at.response, *self.tested)
        return {item.channel: item for item in processes}

    def noise(self, signal: Series) -> float:
        """Return the standard deviation of a weighted residual of a series by noise alone.

        Where it is not known it follows from neighbouring residuals and from rounding of the data.
        """
        if self.known:
            return 1.0
        rows, columns = np.divmod(signal.rows, self.at.response.shape[1])
        weights, data = (table[rows, columns[0]] for table in (self.problem.weights, self.problem.data.values))
        rounding = quantum(data) * np.sqrt(np.mean(weights) / 12)
        return max(local_deviation(signal.along, self.values[signal.rows]), rounding, float(np.finfo(float).tiny))

    def spread(self, columns: np.ndarray) -> np.ndarray:
        """Return the covariance (columns, columns) of columnsᵀ · noise, for columns (values, columns).

        Correlated series count with the process fitted to their residuals.
        """
        return noise_along(self.fitted, columns, self.variances)

    def without(self, column: np.ndarray, amount: float) -> "Residuals":
        """Return the residuals less ``amount`` of a column (values,) that is orthogonal to the basis."""
        basis = np.column_stack([self.basis, column / np.linalg.norm(column)])
        return replace(self, values=self.values - amount * column, basis=basis)


def local_deviation(along: np.ndarray, values: np.ndarray) -> float:
    """Return the standard deviation of the noise of values (values,) along a coordinate, which need not be even. Each
    value is compared with the straight line between its neighbours, in units of that difference's own deviation. What
    varies smoothly does not count. Correlated noise counts less than it is. Source: T. Gasser, L. Sroka,
    C. Jennen-Steinmetz, Residual variance and residual pattern in nonlinear regression, Biometrika 73 (1986).
    """
    after = (along[1:-1] - along[:-2]) / (along[2:] - along[:-2])
    before = 1 - after
    apart = before * values[:-2] + after * values[2:] - values[1:-1]
    return float(np.sqrt(np.mean(apart**2 / (before**2 + after**2 + 1))))
