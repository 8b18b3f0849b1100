"""Residuals of one channel of one experiment, in the order of its samples."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from dalembert.inverse.experiments.experiments import JointModel
from dalembert.inverse.problem.problem import Problem

EVEN = 0.1
"""Largest deviation of a sample interval from a multiple of the usual one, in parts of it, for even samples."""

SPARSE = 20
"""Most places of the even grid for each value that is there; beyond, samples are uneven."""


@dataclass(frozen=True, eq=False)
class Series:
    """Places of one channel's fitted values.

    Parameters
    ----------
    name : str
        The channel; with several experiments ``"NAME.channel"``.
    rows : array of int, shape (values,)
        Places among the weighted residuals, which are flat from (samples, channels).
    along : array, shape (values,)
        Coordinate, usually time.
    grid : array of int, shape (values,), optional
        Place of each value on an even grid, gaps left out. None where the samples are uneven.
    step : float
        Interval of the grid, or the median interval of uneven samples.
    unit : str
        Of the coordinate.
    """

    name: str
    rows: np.ndarray
    along: np.ndarray
    grid: np.ndarray | None
    step: float
    unit: str

    @property
    def length(self) -> float:
        """Duration of the record, in units of the coordinate."""
        return float(self.along[-1] - self.along[0])


def series_of(problem: Problem, weights: np.ndarray | None = None) -> Iterator[Series]:
    """Yield the series of each channel that has at least two fitted values.

    ``weights`` (samples, channels) replace those of the problem: only values of positive weight are part of a series.
    """
    weights = problem.weights if weights is None else weights
    width = weights.shape[1]
    for column, (name, rows, along, unit) in enumerate(_channels(problem)):
        kept = weights[rows, column] > 0
        if np.count_nonzero(kept) > 1:
            grid, step = even_grid(along[kept])
            yield Series(name, rows[kept] * width + column, along[kept], grid, step, unit)


def records_of(problem: Problem) -> dict[str, tuple[str, str]]:
    """Return the experiment and the channel within it, by the channel's joint name; no experiment for a single one."""
    model = problem.model
    if not isinstance(model, JointModel):
        return {name: ("", name) for name in problem.data.channels}
    names = [channel.name for channel in model.channels]
    return {
        names[column]: (part.name, channel)
        for part in model.parts
        for column, channel in zip(part.columns, part.channels, strict=True)
    }


def even_grid(along: np.ndarray) -> tuple[np.ndarray | None, float]:
    """Return the places (values,) of samples on an even grid, or None, and the grid's interval.

    >>> even_grid(np.array([0.0, 0.1, 0.2, 0.5]))[0].tolist(), even_grid(np.array([0.0, 1.0, 2.4]))[0]
    ([0, 1, 2, 5], None)
    """
    intervals = np.diff(along)
    step = float(np.median(intervals))
    counts = np.rint(intervals / step)
    even = np.all(counts >= 1) and np.all(np.abs(intervals / step - counts) < EVEN)
    if not even or np.sum(counts) > SPARSE * len(along):
        return None, step
    return np.concatenate([[0], np.cumsum(counts)]).astype(int), step


def _channels(problem: Problem) -> Iterator[tuple[str, np.ndarray, np.ndarray, str]]:
    """Name, rows (samples,), coordinate (samples,) and its unit, of each channel of the data."""
    data, model = problem.data, problem.model
    if not isinstance(model, JointModel):
        for name in data.channels:
            yield name, np.arange(problem.samples), data.coordinate.values, data.coordinate.unit
        return
    places = {model.channels[column].name: part for part in model.parts for column in part.columns}
    for name in data.channels:
        part = places[name]
        yield name, part.rows, part.coordinate.values, part.coordinate.unit
