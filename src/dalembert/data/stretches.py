"""Stretches of samples between gaps."""

import numpy as np

_WIDE = 1.5  # usual distances of samples from which one is a gap
_ROUNDING = 1e-6  # of a step, by which stamps may differ from what they mean
_USUAL = 0.95  # quantile of the distances that is the usual one: that of even samples, and nearly the largest of uneven


def stretches(present: np.ndarray, along: np.ndarray | None = None, gap: float | None = None) -> list[slice]:
    """Runs of samples that are there, from a mask (samples,); no run reaches over a gap of the coordinate (samples,).
    ``gap`` is the longest step of the coordinate that is no gap; see :func:`gaps`.

    >>> stretches(np.ones(6, dtype=bool), np.array([0.0, 0.1, 0.2, 0.3, 2.3, 2.4]))
    [slice(0, 4, None), slice(4, 6, None)]
    """
    edges = np.flatnonzero(np.diff(np.concatenate([[False], present, [False]]).astype(int))).reshape(-1, 2)
    cuts = np.zeros(0, dtype=int) if along is None else gaps(along, gap) + 1
    runs = []
    for begin, end in edges.tolist():
        inner = cuts[(cuts > begin) & (cuts < end)].tolist()
        runs += [slice(first, last) for first, last in zip([begin, *inner], [*inner, end], strict=True)]
    return runs


def gaps(along: np.ndarray, longest: float | None = None) -> np.ndarray:
    """Samples (gaps,) behind which a coordinate (samples,) has a gap.

    A gap is a step of more than ``longest``, or if that is not given of more than 1.5 times the usual step, which 95 %
    of the steps do not exceed. It takes at least four steps to know the usual one.
    """
    steps = np.diff(along)
    if longest is not None:
        return np.flatnonzero(steps > longest * (1 + _ROUNDING))
    if len(steps) < 4:
        return np.zeros(0, dtype=int)
    usual = np.quantile(steps, _USUAL, method="lower")
    return np.flatnonzero(steps > _WIDE * usual)
