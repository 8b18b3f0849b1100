"""Long series made short without hiding a peak."""

import numpy as np


def thin(values: np.ndarray, most: int = 4000) -> np.ndarray:
    """Return increasing indices of at most ``most`` samples of ``values`` (samples,) that keep the lowest and the
    highest of each stretch; all indices where the series is short enough.
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
    """Return ends of at most ``most`` stretches of a series (samples,) and their largest values, NaN where all are NaN.
    >>> largest_of_stretches(np.arange(6.0), np.array([1.0, 5.0, 2.0, np.nan, 3.0, 4.0]), most=3)
    (array([1., 3., 5.]), array([5., 2., 4.]))
    """
    stretches = np.array_split(np.arange(len(values)), min(most, max(len(values), 1)))
    filled = np.where(np.isnan(values), -np.inf, values)
    tops = np.array([filled[part].max(initial=-np.inf) for part in stretches])
    return times[[part[-1] for part in stretches if len(part)]], np.where(np.isfinite(tops), tops, np.nan)[: len(times)]
