"""Blocks of neighbouring samples of each record."""

from collections.abc import Callable, Sequence

import numpy as np

from dalembert.inverse.experiments.experiment import ExperimentPart

USUAL = 10
"""Blocks of a record, if nothing else decides."""


def blocks_of_records(fitted: np.ndarray, parts: Sequence[ExperimentPart], count: Callable[[int], int]) -> np.ndarray:
    """Return the number of the block of each value, from 0, shape (samples, channels); −1 where it was not fitted.
    ``fitted`` (samples, channels). ``parts``: where several experiments stand; empty for a single one.
    ``count(samples)`` returns the number of blocks of a record with this number of fitted samples.
    """
    numbers, begin = np.full(fitted.shape, -1), 0
    for record in [part.block for part in parts] or [np.ix_(*map(np.arange, fitted.shape))]:
        rows = np.flatnonzero(np.any(fitted[record], axis=1))
        if not len(rows):
            continue
        split = np.array_split(rows, count(len(rows)))
        along = np.full(len(record[0]), -1)
        for number, block in enumerate(split, start=begin):
            along[block] = number
        numbers[record] = np.where(fitted[record], along[:, None], -1)
        begin += len(split)
    return numbers
