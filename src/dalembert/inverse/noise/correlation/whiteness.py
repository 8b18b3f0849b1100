"""Tests of whether residuals are white noise."""

from dataclasses import replace

import numpy as np
from scipy.special import chdtrc

from dalembert.inverse.noise.correlation.series import Series

LEVEL = 0.01
"""Probability with which white noise is taken for correlated, over all series of a fit."""

LEAST = 10
"""Fewer values are not tested."""

LAGS = 10
"""Most lags of the Ljung–Box test, and most bins of intervals of uneven samples."""


def p_value(series: Series, values: np.ndarray, basis: np.ndarray) -> float:
    """Return the probability of correlations at least as large in white noise; 1 for fewer than ten values. ``values``
    (values,): weighted residuals. ``basis`` (values, parameters): these rows of an orthonormal basis of the weighted
    jacobian's columns. A fit takes the part of the noise along them out of the residuals, which correlates the rest;
    that is allowed for.

    Even samples, with gaps or without: the Ljung–Box test of the first autocorrelation, and of the first ten, with the
    number of pairs that are there at each lag. The smaller of both probabilities counts twice. Uneven samples:
    chi-square test of the mean product of neighbours, in bins of their interval. Source: G. M. Ljung, G. E. P. Box, On
    a measure of lack of fit in time series models, Biometrika 65 (1978); D. S. Stoffer, C. M. C. Toloi, A note on the
    Ljung–Box–Pierce portmanteau statistic with missing data, Statistics and Probability Letters 13 (1992).
    """
    if len(values) < LEAST or not np.any(values):
        return 1.0
    squares = _squares_of_neighbours if series.grid is None else _squares_of_lags
    terms = squares(series, values, basis)
    first, all_terms = chdtrc(1, terms[0]), chdtrc(len(terms), np.sum(terms))
    return float(all_terms if series.grid is None else min(1.0, 2 * min(first, all_terms)))


def is_first_order(series: Series, first: float, values: np.ndarray, basis: np.ndarray) -> bool:
    """Return whether weighted residuals (values,) are noise of first order: whitened as such they pass as white. Even
    samples must have no periodic part, either: a model that is wrong leaves one of the motion's own period. ``first``
    is the autocorrelation of samples one ``series.step`` apart; a process without a positive one is not.
    """
    if not 0 < first < 1:
        return False
    along = series.along if series.grid is None else series.grid * series.step
    factors = first ** (np.diff(along) / series.step)
    size = np.sqrt(1 - factors**2)
    white = (values[1:] - factors * values[:-1]) / size
    rows = (basis[1:] - factors[:, None] * basis[:-1]) / size[:, None]
    left, singular, _ = np.linalg.svd(rows, full_matrices=False)
    grid = None if series.grid is None else series.grid[1:] - series.grid[1]
    later = replace(series, rows=series.rows[1:], along=series.along[1:], grid=grid)
    periodic = 1.0 if grid is None else p_value_of_period(on_grid(grid, white))
    return min(p_value(later, white, left[:, singular > 1e-9 * singular[0]]), periodic) >= LEVEL / 10


def p_value_of_period(values: np.ndarray, fitted: float = 0.0) -> float:
    """Return the probability of a periodic part at least as large in white noise (places,): Fisher's g test. Each of
    the ``fitted`` parameters that a fit took out of the values leaves half a frequency less. Source: R. A. Fisher,
    Tests of significance in harmonic analysis, Proceedings of the Royal Society A 125 (1929). Constant values have no
    periodic part: 1.
    """
    if not np.ptp(values):
        return 1.0
    power = np.abs(np.fft.rfft(values - np.mean(values))[1:]) ** 2
    count, share = max(len(power) - fitted / 2, 1.0), float(np.max(power) / np.sum(power))
    return min(1.0, count * (1 - share) ** (count - 1))


def on_grid(grid: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """Return rows (values, ...) at the places of an even grid, 0 in its gaps."""
    table = np.zeros((grid[-1] + 1, *rows.shape[1:]))
    table[grid] = rows
    return table


def lagged(first: np.ndarray, second: np.ndarray, lag: int) -> float:
    """Return the sum of products of rows ``lag`` places apart of two tables of the same shape."""
    return float(np.sum(first[: len(first) - lag] * second[lag:]))


def pairs(grid: np.ndarray, lags: int) -> np.ndarray:
    """Return the numbers of pairs of values that are 0 to ``lags`` places apart, shape (lags + 1,)."""
    present = on_grid(grid, np.ones(len(grid)))
    return np.array([lagged(present, present, lag) for lag in range(lags + 1)])


def _squares_of_lags(series: Series, values: np.ndarray, basis: np.ndarray) -> np.ndarray:
    """Terms of Ljung and Box's sum, one for each lag that has pairs."""
    grid = series.grid
    assert grid is not None
    number, lags = len(values), min(LAGS, len(values) // 5)
    on_grid_values, along = on_grid(grid, values), on_grid(grid, basis)
    count = pairs(grid, lags)[1:]
    left = number - np.sum(along**2)  # degrees of freedom of the squares
    excess = np.array(
        [
            lagged(on_grid_values, on_grid_values, k) / np.sum(on_grid_values**2) + lagged(along, along, k) / left
            for k in range(1, lags + 1)
        ]
    )
    kept = count > 0
    return (number + 2) * number * excess[kept] ** 2 / count[kept]


def _squares_of_neighbours(series: Series, values: np.ndarray, basis: np.ndarray) -> np.ndarray:
    """Squared mean products of neighbours in units of their deviation, one for each bin of intervals."""
    left = len(values) - np.sum(basis**2)
    variance = np.sum(values**2) / left
    products = values[1:] * values[:-1] / variance + np.sum(basis[1:] * basis[:-1], axis=1)
    order = np.argsort(np.diff(series.along), kind="stable")
    bins = np.array_split(products[order], min(LAGS // 2, max(1, len(products) // 10)))
    return np.array([np.sum(own) ** 2 / len(own) for own in bins])
