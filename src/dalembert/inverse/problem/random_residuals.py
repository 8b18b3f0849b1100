"""Whether residuals look like noise."""

import numpy as np


def autocorrelation(residual: np.ndarray, shape: tuple[int, int], present: np.ndarray | None = None) -> float:
    """Correlation of neighbouring samples of weighted residuals, flat from (samples, channels), over all channels.
    ``present`` (samples, channels) masks the values that are there; neighbours are those.

    >>> gaps = np.array([1.0, 0.0, -1.0, 0.0, 1.0, 0.0, -1.0])
    >>> autocorrelation(gaps, (7, 1), gaps[:, None] != 0)
    -0.75
    """
    table = residual.reshape(shape)
    if present is None or np.all(present):
        neighbours = np.sum(table[1:] * table[:-1])
    else:
        there = [column[mask] for column, mask in zip(table.T, present.T, strict=True)]
        neighbours = sum(np.sum(column[1:] * column[:-1]) for column in there)
    return float(neighbours / max(np.sum(table**2), np.finfo(float).tiny))


def random_residuals(
    residual: np.ndarray, shape: tuple[int, int], present: np.ndarray | None = None, *, deviations: float = 3.0
) -> bool:
    """Whether residuals look like noise: their autocorrelation is at most ``deviations`` times 1/√values.

    ``present`` (samples, channels) masks the values that are there, all if not given; the others' residuals are 0.
    """
    values = residual.size if present is None else np.count_nonzero(present)
    return abs(autocorrelation(residual, shape, present)) < deviations / np.sqrt(values)
