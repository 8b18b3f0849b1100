"""Long series made short without hiding a peak."""

import numpy as np


def thin(values: np.ndarray, most: int = 4000) -> np.ndarray:
    """Indices of at most ``most`` samples of a series that keep the lowest and the highest of each stretch.

    Parameters
    ----------
    values : array, shape (samples,)

    Returns
    -------
    array of int, increasing; all indices where the series is short enough

    Examples
    --------
    >>> spike = np.zeros(100_000)
    >>> spike[77_777] = 1.0
    >>> kept = thin(spike)
    >>> len(kept) <= 4000, 77_777 in kept
    (True, True)
    """
    values = np.asarray(values, dtype=float)
    if len(values) <= most:
        return np.arange(len(values))
    stretches = np.array_split(np.arange(len(values)), most // 2 - 1)
    low, high = (np.where(np.isnan(values), none, values) for none in (np.inf, -np.inf))
    extremes = [(part[low[part].argmin()], part[high[part].argmax()]) for part in stretches]
    return np.unique([0, len(values) - 1, *np.ravel(extremes)])


def thinned(along: np.ndarray, values: np.ndarray, most: int = 4000) -> tuple[np.ndarray, np.ndarray]:
    """A coordinate and a series over it, both (samples,), at the samples that :func:`thin` keeps."""
    kept = thin(values, most)
    return np.asarray(along)[kept], np.asarray(values)[kept]


def largest_of_stretches(times: np.ndarray, values: np.ndarray, most: int = 200) -> tuple[np.ndarray, np.ndarray]:
    """Ends of at most ``most`` stretches of a series, and the largest value of each; NaN where all are NaN.

    Parameters
    ----------
    times, values : array, shape (samples,)

    Examples
    --------
    >>> largest_of_stretches(np.arange(6.0), np.array([1.0, 5.0, 2.0, np.nan, 3.0, 4.0]), most=3)
    (array([1., 3., 5.]), array([5., 2., 4.]))
    """
    stretches = np.array_split(np.arange(len(values)), min(most, max(len(values), 1)))
    filled = np.where(np.isnan(values), -np.inf, values)
    tops = np.array([filled[part].max(initial=-np.inf) for part in stretches])
    return times[[part[-1] for part in stretches if len(part)]], np.where(np.isfinite(tops), tops, np.nan)[: len(times)]
