"""The noise of one channel of one experiment, in place: its values, and the parameters that describe it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from dalembert.inverse.noise.correlation.series import Series
from dalembert.inverse.noise.models.noise_model import NoiseModel
from dalembert.inverse.noise.models.whitening import Whitening

if TYPE_CHECKING:
    from scipy.sparse import coo_array

HALF_LOG_2_PI = 0.5 * np.log(2 * np.pi)
STEP = 1e-30
"""Complex step of derivatives with respect to noise parameters."""


@dataclass(frozen=True, eq=False)
class ChannelNoise:
    """Noise of one series of residuals."""

    series: Series
    model: NoiseModel
    given: np.ndarray  # (values,): known deviations of the data, W^-½
    names: Mapping[str, str]  # full name of each noise parameter by its name within the model
    whitening: Whitening | None

    def values(self, known: Mapping[str, Any]) -> dict[str, np.ndarray]:
        """Return the values of this channel's parameters out of those of all, by their names within the model."""
        return {bare: np.asarray(known[full]) for bare, full in self.names.items()}

    def standardised(
        self, residual: np.ndarray, response: np.ndarray, values: Mapping[str, np.ndarray]
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return whitened residuals, and the logarithms of the deviations of each value after those before it.

        Both have the shape (values,) of the residual and the response; complex parameters give complex results.
        """
        sizes = self.model.deviations(response, self.given, values)
        if self.whitening is None:
            return residual / sizes, np.log(sizes)
        matrix = self.whitening.matrix(values)
        return matrix @ (residual / sizes), np.log(sizes) - np.log(matrix.diagonal())

    def log_densities(self, residual: np.ndarray, response: np.ndarray, values: Mapping[str, np.ndarray]) -> np.ndarray:
        """Return the log density of each value after those before it, all of shape (batch, values).

        ``values`` are of shape (batch, 1) each. NaN where a sample failed or a deviation is 0.
        """
        with np.errstate(divide="ignore", invalid="ignore"):
            if self.whitening is None:
                white, logs = self.standardised(residual, response, values)
            else:
                rows = [
                    self.standardised(
                        residual_here, response_here, {name: value[k, 0] for name, value in values.items()}
                    )
                    for k, (residual_here, response_here) in enumerate(zip(residual, response, strict=True))
                ]
                white, logs = (np.array(part).reshape(residual.shape) for part in zip(*rows, strict=True))
            return -0.5 * white**2 - logs - HALF_LOG_2_PI

    def left_out(
        self,
        residual: np.ndarray,
        response: np.ndarray,
        values: Mapping[str, np.ndarray],
        groupings: Sequence[np.ndarray],
    ) -> list[np.ndarray]:
        """Return the log density of each group of values after all others, for each grouping (batch, groups).
        ``residual``, ``response`` (batch, values). ``values`` (batch, 1). ``groupings`` (values,): number of each
        value's group, from 0.

        With the inverse K = AᵀA of the correlation of the standardised residuals z, a group S has the precision K_SS
        and the error K_SS⁻¹ (K z)_S. Without the entries of K between groups, one banded Cholesky factor L has the
        factors of all K_SS, so that each value adds −½ u² + log L_ii with L u = K z. Source: P.-C. Bürkner, J. Gabry,
        A. Vehtari, Efficient leave-one-out cross-validation for Bayesian non-factorized normal and Student-t models,
        Computational Statistics 36 (2021), equations 8 and 9, for groups.
        """
        if self.whitening is None:
            densities = self.log_densities(residual, response, values)
            return [_summed(densities, groups) for groups in groupings]
        found = np.empty((len(groupings), *residual.shape))
        with np.errstate(divide="ignore", invalid="ignore"):
            for k, (residual_here, response_here) in enumerate(zip(residual, response, strict=True)):
                known = {name: value[k, 0] for name, value in values.items()}
                sizes, matrix = self.model.deviations(response_here, self.given, known), self.whitening.matrix(known)
                precision, pulled = (matrix.T @ matrix).tocoo(), matrix.T @ (matrix @ (residual_here / sizes))
                for number, groups in enumerate(groupings):
                    found[number, k] = _densities_of_groups(precision, pulled, groups) - np.log(sizes)
        return [_summed(found[number], groups) for number, groups in enumerate(groupings)]

    def slopes(
        self, residual: np.ndarray, response: np.ndarray, jacobian: np.ndarray, values: Mapping[str, np.ndarray]
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Return w, l (values,), and ∂w, ∂l (values, parameters) with respect to the parameters of the response, whose
        ``jacobian`` is given: the whitened residuals and the logarithms of the deviations. Complex noise parameters
        give complex results.
        """
        sizes = self.model.deviations(response, self.given, values)
        logarithmic = self.model.slopes(response, self.given, values) / sizes
        white, logs, moves = residual / sizes, np.log(sizes), ((1 - residual * logarithmic) / sizes)[:, None] * jacobian
        if self.whitening is not None:
            matrix = self.whitening.matrix(values)
            white, logs, moves = matrix @ white, logs - np.log(matrix.diagonal()), matrix @ moves
        return white, logs, moves, logarithmic[:, None] * jacobian

    def cotangent(
        self, residual: np.ndarray, response: np.ndarray, values: Mapping[str, np.ndarray]
    ) -> tuple[float, np.ndarray, dict[str, float]]:
        """Return the log density of all values, and its derivatives by the response (values,) and by the noise."""
        sizes = self.model.deviations(response, self.given, values)
        logarithmic = self.model.slopes(response, self.given, values) / sizes
        white, logs = self.standardised(residual, response, values)
        back = white if self.whitening is None else self.whitening.matrix(values).T @ white
        by_response = -(1 - residual * logarithmic) / sizes * back - logarithmic
        slopes = self.noise_slopes(residual, response, values)
        by_noise = {full: float(-white @ move - np.sum(change)) for full, (move, change) in slopes.items()}
        return float(np.sum(-0.5 * white**2 - logs - HALF_LOG_2_PI)), by_response, by_noise

    def noise_slopes(
        self, residual: np.ndarray, response: np.ndarray, values: Mapping[str, np.ndarray]
    ) -> dict[str, tuple[np.ndarray, np.ndarray]]:
        """Return ∂w and ∂l (values,) with respect to each noise parameter, by its full name, from complex steps."""
        slopes = {}
        for bare, full in self.names.items():
            moved = {**values, bare: values[bare] + 1j * STEP}
            white, logs = self.standardised(residual, response, moved)
            slopes[full] = np.imag(white) / STEP, np.imag(logs) / STEP
        return slopes

    def simulated(
        self, response: np.ndarray, values: Mapping[str, np.ndarray], random: np.random.Generator
    ) -> np.ndarray:
        """Return simulated noise (values,) at a response (values,)."""
        from scipy.sparse.linalg import splu

        noise = random.standard_normal(len(response))
        if self.whitening is not None and len(noise):
            noise = splu(self.whitening.matrix(values).tocsc(), permc_spec="NATURAL").solve(noise)
        return noise * self.model.deviations(response, self.given, values)


def _densities_of_groups(precision: "coo_array", pulled: np.ndarray, groups: np.ndarray) -> np.ndarray:
    """Return the terms of log densities of groups, one for each standardised value; NaN where there is no density."""
    from scipy.linalg import cholesky_banded, solve_banded

    inside = (groups[precision.row] == groups[precision.col]) & (precision.row >= precision.col)
    rows, columns = precision.row[inside], precision.col[inside]
    width = int(np.max(rows - columns, initial=0))
    banded = np.zeros((width + 1, len(pulled)))
    banded[rows - columns, columns] = precision.data[inside]
    try:
        factor = cholesky_banded(banded, lower=True)
        white = solve_banded((width, 0), factor, pulled)
    except (ValueError, np.linalg.LinAlgError):  # not finite, or not positive
        return np.full(len(pulled), np.nan)
    return -0.5 * white**2 + np.log(factor[0]) - HALF_LOG_2_PI


def _summed(densities: np.ndarray, groups: np.ndarray) -> np.ndarray:
    """Return the sums (batch, groups) of densities (batch, values)."""
    count = int(np.max(groups, initial=-1)) + 1
    return np.array([np.bincount(groups, density, count) for density in densities]).reshape(-1, count)
