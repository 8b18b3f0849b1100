"""Residuals of one channel of one experiment, in the order of its samples."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from dalembert.data import Measurements
from dalembert.inverse.experiments.experiment import ExperimentPart
from dalembert.inverse.experiments.tracks import tracks
from dalembert.inverse.problem.problem import MisfitProblem

EVEN = 0.1
"""Largest deviation of a sample interval from a multiple of the usual one, in parts of it, for even samples."""

SPARSE = 20
"""Most places of the even grid for each value that is there; beyond, samples are uneven."""


@dataclass(frozen=True, eq=False)
class Series:
    """Places of one channel's fitted values."""

    name: str  # the channel; with several experiments ``"NAME.channel"``
    rows: np.ndarray  # (values,): places among the weighted residuals, which are flat from (samples, channels)
    along: np.ndarray  # (values,): coordinate, usually time
    # grid: (values,): place of each value on an even grid, gaps left out. None where the samples are uneven.
    grid: np.ndarray | None
    step: float  # interval of the grid, or the median interval of uneven samples
    unit: str  # of the coordinate
    experiment: str = ""  # empty for a single one
    channel: str = ""  # its name within the experiment

    @property
    def length(self) -> float:
        """Duration of the record, in units of the coordinate."""
        return float(self.along[-1] - self.along[0])


def series_of(problem: MisfitProblem, weights: np.ndarray | None = None, *, fewest: int = 2) -> Iterator[Series]:
    """Yield the series of each channel that has at least ``fewest`` fitted values.

    ``weights`` (samples, channels) replace those of the problem: only values of positive weight are part of a series.
    """
    weights = problem.weights if weights is None else weights
    for track in tracks(problem):
        where = track.rows, track.columns
        yield from _of_record(track.name, track.data, *where, problem.data.channels, weights, fewest)


def series_of_record(
    data: Measurements, weights: np.ndarray, parts: Sequence[ExperimentPart], *, fewest: int = 2
) -> Iterator[Series]:
    """Yield the series of the data of a fit, whose ``parts`` are those of several experiments; empty for a single one.

    ``weights`` have the shape (samples, channels). Series of less than ``fewest`` values are left out.
    """
    if not parts:
        rows, columns = (np.arange(size) for size in data.values.shape)
        yield from _of_record("", data, rows, columns, data.channels, weights, fewest)
    for part in parts:
        yield from _of_record(part.name, part.data(data), part.rows, part.columns, data.channels, weights, fewest)


def _of_record(
    experiment: str,
    measured: Measurements,
    rows: np.ndarray,
    columns: np.ndarray,
    names: tuple[str, ...],
    weights: np.ndarray,
    fewest: int,
) -> Iterator[Series]:
    """Yield the series of one record, which stands in ``rows`` and ``columns`` of the joint one."""
    for column, channel in zip(columns, measured.channels, strict=True):
        kept = weights[rows, column] > 0
        if np.count_nonzero(kept) >= fewest:
            along, places = measured.coordinate.values[kept], rows[kept] * len(names) + column
            grid, step = even_grid(along)
            yield Series(names[column], places, along, grid, step, measured.coordinate.unit, experiment, channel)


def even_grid(along: np.ndarray) -> tuple[np.ndarray | None, float]:
    """Return the places (values,) of samples on an even grid, or None, and the grid's interval."""
    if len(along) < 2:
        return np.zeros(len(along), dtype=int), 0.0
    intervals = np.diff(along)
    step = float(np.median(intervals))
    counts = np.rint(intervals / step)
    even = np.all(counts >= 1) and np.all(np.abs(intervals / step - counts) < EVEN)
    if not even or np.sum(counts) > SPARSE * len(along):
        return None, step
    return np.concatenate([[0], np.cumsum(counts)]).astype(int), step
