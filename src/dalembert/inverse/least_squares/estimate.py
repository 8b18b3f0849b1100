"""Standard deviations, correlation and combinations of identified parameters."""

from dataclasses import dataclass

import numpy as np

from dalembert.findings import Finding

UNSEEN = 1e-10
"""Singular values below this fraction of the largest are zero to the accuracy of a simulation."""


@dataclass(frozen=True, eq=False)
class Estimate:
    """Standard deviations (parameters,) and correlation (parameters, parameters) of identified parameters.
    ``singular_values`` (parameters,), largest first, are those of W^½ ∂R/∂p · scale; the rows of ``directions``
    (parameters, parameters) are the combinations of p/scale that they belong to.
    """

    deviations: np.ndarray
    correlation: np.ndarray
    singular_values: np.ndarray
    directions: np.ndarray


def estimate(slopes: np.ndarray, scale: np.ndarray, variance: float | np.ndarray) -> Estimate:
    """Return the estimate from the linearised least squares problem, covariance s² (JᵀWJ)⁻¹.

    ``slopes`` (values, parameters): W^½ ∂R/∂p · scale, from the singular values of which everything follows. ``scale``
    (parameters,). ``variance``: s², the variance of a weighted residual. With correlated residuals UᵀΣU (parameters,
    parameters): their covariance along the left singular vectors of the slopes, from which follows the covariance
    (JᵀWJ)⁻¹ JᵀWΣWJ (JᵀWJ)⁻¹. A combination that the response does not see leaves the deviations of its parameters
    infinite, and correlates them fully.
    """
    _, singular, directions = _decomposed(slopes)
    least = UNSEEN * (singular[0] or 1.0)
    unseen = singular <= least
    inverse = 1 / np.maximum(singular, least)
    spread = directions.T * inverse  # (parameters, combinations): spread @ spread.T is (JᵀWJ)⁻¹
    if isinstance(variance, np.ndarray):
        values, vectors = np.linalg.eigh(variance)
        spread, variance = spread @ (vectors * np.sqrt(np.maximum(values, 0.0))), 1.0
    size = np.linalg.norm(spread, axis=1)
    correlation = (spread / size[:, None]) @ (spread / size[:, None]).T
    correlation = np.clip((correlation + correlation.T) / 2, -1, 1)
    np.fill_diagonal(correlation, 1.0)
    lost = np.any(np.abs(directions[unseen]) > 1e-6, axis=0)
    return Estimate(np.where(lost, np.inf, np.sqrt(variance) * size * scale), correlation, singular, directions)


def estimate_of(spread: np.ndarray, scale: np.ndarray, variance: float | np.ndarray) -> Estimate:
    """Return the estimate of the covariance s² S Sᵀ, with S = ``spread`` (parameters, any).

    Of a variance with correlated residuals the largest one counts.
    """
    if isinstance(variance, np.ndarray):
        variance = float(np.linalg.eigvalsh(variance)[-1])
    directions, values, _ = np.linalg.svd(spread / scale[:, None], full_matrices=False)
    size = np.linalg.norm(spread, axis=1)
    unit = spread / np.maximum(size, np.finfo(float).tiny)[:, None]
    correlation = np.clip(unit @ unit.T, -1, 1)
    np.fill_diagonal(correlation, 1.0)
    singular = 1 / np.maximum(values, np.finfo(float).tiny)
    return Estimate(np.sqrt(variance) * size, correlation, singular[::-1], directions.T[::-1])


def unknown_estimate(parameters: int) -> Estimate:
    """Return NaN deviations and correlations, for a response without a jacobian."""
    lost, square = np.full(parameters, np.nan), np.full((parameters, parameters), np.nan)
    return Estimate(lost, square, lost, square)


def left_vectors(slopes: np.ndarray) -> np.ndarray:
    """Return the left singular vectors of slopes (values, parameters), one column a combination."""
    return _decomposed(slopes)[0][: len(slopes)]


def _decomposed(slopes: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    short = max(0, slopes.shape[1] - len(slopes))
    return np.linalg.svd(np.pad(slopes, ((0, short), (0, 0))), full_matrices=False)


@dataclass(frozen=True, eq=False)
class Identifiability:
    """What the data can identify, in numbers as in :class:`Estimate` and as findings."""

    singular_values: np.ndarray
    directions: np.ndarray
    findings: tuple[Finding, ...]
    deviations: np.ndarray | None = None
    correlation: np.ndarray | None = None

    def __str__(self) -> str:
        return "\n".join(map(str, self.findings)) or "All parameters are identifiable."
