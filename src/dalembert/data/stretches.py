"""Stretches of samples between gaps."""

import numpy as np


def stretches(present: np.ndarray) -> list[slice]:
    """Runs of samples that are there, from a mask (samples,).

    >>> stretches(np.array([True, True, False, True]))
    [slice(0, 2, None), slice(3, 4, None)]
    """
    edges = np.flatnonzero(np.diff(np.concatenate([[False], present, [False]]).astype(int)))
    return [slice(int(begin), int(end)) for begin, end in edges.reshape(-1, 2)]
