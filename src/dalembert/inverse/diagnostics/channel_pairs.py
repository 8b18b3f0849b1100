"""Channels whose residuals are correlated with each other, and what that means for the standard deviations."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from scipy.special import erfc

from dalembert.inverse.diagnostics.series_residuals import SeriesResiduals
from dalembert.inverse.least_squares.estimate import UNSEEN
from dalembert.inverse.noise.correlation.correlated_residuals import NoiseProcess
from dalembert.inverse.noise.correlation.whiteness import LEAST

COPY = 0.99
"""Correlation from which one channel repeats the other, also where the model is wrong for both."""


@dataclass(frozen=True)
class ChannelPair:
    """Two channels of one experiment."""

    first: SeriesResiduals
    second: SeriesResiduals
    correlation: float  # of their residuals at the same samples
    p_value: float  # probability of one at least as large in channels with independent noise

    def samples(self, width: int) -> tuple[np.ndarray, np.ndarray]:
        """Return where the common samples stand among the values of the fit, which has ``width`` channels."""
        return _common(self.first, self.second, width)


def _common(first: SeriesResiduals, second: SeriesResiduals, width: int) -> tuple[np.ndarray, np.ndarray]:
    first_rows, second_rows = first.series.rows, second.series.rows
    _, here, there = np.intersect1d(first_rows // width, second_rows // width, return_indices=True)
    return first_rows[here], second_rows[there]


def correlated_pairs(
    series: Sequence[SeriesResiduals],
    residual: np.ndarray,
    basis: np.ndarray,
    width: int,
    processes: Mapping[str, NoiseProcess],
    level: float,
) -> list[ChannelPair]:
    """Return the pairs of channels whose noise is not independent, most correlated first.

    Fisher's transformation atanh r of the correlation is normal with the variance 1/(n − 3). Where both series are
    correlated in time, with coefficients a and b of neighbours, n is divided by (1 + a b)/(1 − a b). Source:
    M. S. Bartlett, Some aspects of the time-correlation problem, Journal of the Royal Statistical Society 98 (1935).

    ``residual`` (values,): weighted residuals. ``basis`` (values, parameters): orthonormal basis of the weighted
    jacobian's columns. A fit takes the part of the noise along them out of the residuals, which correlates the rest;
    that is allowed for. ``width``: number of channels of the data. ``processes``: of the series that are correlated in
    time, by name. Where the model is wrong for both channels, their residuals are correlated anyway, and only copies
    count. ``level``: probability to take independent noise for correlated, over all pairs.
    """
    tried = list(_pairs(series, residual, basis, width, processes))
    correlated = [pair for pair in tried if pair.p_value < level / len(tried)]
    return sorted(correlated, key=lambda pair: -abs(pair.correlation))


def _pairs(
    series: Sequence[SeriesResiduals],
    residual: np.ndarray,
    basis: np.ndarray,
    width: int,
    processes: Mapping[str, NoiseProcess],
) -> Iterator[ChannelPair]:
    for first, second in combinations(series, 2):
        first_samples, second_samples = _common(first, second, width)
        if first.series.experiment != second.series.experiment or len(first_samples) < LEAST:
            continue
        size = np.linalg.norm(residual[first_samples]) * np.linalg.norm(residual[second_samples])
        correlation = float(residual[first_samples] @ residual[second_samples] / size) if size > 0 else 0.0
        known = [processes[name] for name in (first.name, second.name) if name in processes]
        if len(known) == 2 and all(process.systematic for process in known) and abs(correlation) < COPY:
            continue
        left = [len(rows) - np.sum(basis[rows] ** 2) for rows in (first_samples, second_samples)]
        freedom = np.sqrt(np.prod(np.maximum(left, 1.0)))
        fitted = np.sum(basis[first_samples] * basis[second_samples]) / freedom
        product = np.prod([process.first for process in known]) if len(known) == 2 else 0.0
        number = max(freedom * (1 - product) / (1 + product), 4.0)
        excess = np.arctanh(np.clip(correlation + fitted, -1 + UNSEEN, 1 - UNSEEN)) * np.sqrt(number - 3)
        yield ChannelPair(first, second, correlation, float(erfc(abs(excess) / np.sqrt(2))))


def factors(pairs: Sequence[ChannelPair], slopes: np.ndarray, deviations: np.ndarray, width: int) -> np.ndarray:
    """Return the standard deviations with the correlations of pairs over those without, shape (parameters,): roots of
    the ratios of the diagonals of S⁺ Σ S⁺ᵀ, with Σ diagonal and with r σ_a σ_b at common samples of a pair. NaN for a
    parameter that the data do not determine.

    ``slopes`` (values + priors, parameters): W^½ ∂R/∂p, then one row a prior. ``deviations`` (values,): of the weighted
    residuals. ``width``: number of channels of the data.
    """
    inverse = np.linalg.pinv(slopes, rcond=UNSEEN)
    weighted = inverse * np.pad(deviations, (0, len(slopes) - len(deviations)), constant_values=1.0)
    plain = np.sum(weighted**2, axis=1)
    total = plain.copy()
    for pair in pairs:
        first_samples, second_samples = pair.samples(width)
        total += 2 * pair.correlation * np.sum(weighted[:, first_samples] * weighted[:, second_samples], axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.sqrt(np.maximum(total, 0.0) / plain)
