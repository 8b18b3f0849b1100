"""Values of data that repeat a number exactly."""

import numpy as np

FEWEST = 3
"""Fewest values that count as a pattern."""

NEAR = 0.2
"""Distance of the next value to an end, as a part of the range, up to which values approach it."""


def runs(data: np.ndarray) -> np.ndarray:
    """Return the number of the first value of the run of equal values that each of data (values,) is in.

    >>> runs(np.array([1.0, 2.0, 2.0, 2.0, 1.0])).tolist()
    [0, 1, 1, 1, 4]
    """
    first = np.concatenate([[True], np.diff(data) != 0])
    return np.maximum.accumulate(np.where(first, np.arange(len(data)), 0))


def plateaus(data: np.ndarray) -> np.ndarray:
    """Return which of data (values,) are at an end of their range because they are clipped. Several values share the
    end, and others approach it: an end that all others keep away from is that of lost samples. A single run of them is
    clipped only if no other values repeat.
    """
    first, clipped = runs(data), np.zeros(len(data), dtype=bool)
    repeats = first != np.arange(len(data))
    for end in (data.min(), data.max()):
        at_end = data == end
        distances = np.abs(data[~at_end] - end)
        if np.count_nonzero(at_end) < FEWEST or not len(distances) or np.min(distances) >= NEAR * np.ptp(data):
            continue
        if len(set(first[at_end])) > 1 or not np.any(repeats & ~at_end & (data != 0)):
            clipped |= at_end
    return clipped
