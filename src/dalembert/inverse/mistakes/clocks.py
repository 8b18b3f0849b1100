"""Times of a record that are shifted or stretched."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from dalembert.inverse.mistakes.record import TIME, FittedRecord
from dalembert.inverse.noise.correlation.series import Series

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline

RESOLUTION = 12
"""Times in a period of the response at which it is interpolated."""

FEWEST = 8
"""Fewest values of a series whose times are judged."""


@dataclass(frozen=True, eq=False)
class Clock:
    """Series that share a clock."""

    name: str  # of the experiment, or of the channel; empty for all
    series: tuple[Series, ...]
    period: float  # shortest time in which the response of one of them swings: 2π rms/rms of its rate
    last: list[tuple[np.ndarray, "list[CubicSpline]"]] = field(default_factory=list)
    """The last response and its splines: many numbers are tried with one response."""
    placed: dict[str, Any] = field(default_factory=dict)
    """Where the values of each series are among the last rows that were asked for."""

    @cached_property
    def rows(self) -> np.ndarray:
        return np.concatenate([signal.rows for signal in self.series])

    @property
    def length(self) -> float:
        """Duration of the longest record."""
        return max(signal.length for signal in self.series)

    def read(
        self, response: np.ndarray, time: Callable[[np.ndarray], np.ndarray], rows: np.ndarray | None = None
    ) -> np.ndarray:
        """Return a response (samples × channels, ...) whose series are read at other times; NaN outside the record.

        ``time`` goes from the times of the record to these. With ``rows``, only these rows are returned.
        """
        if not self.last or self.last[0][0] is not response:
            from scipy.interpolate import CubicSpline  # fits without mistakes start without it

            splines = [CubicSpline(signal.along, response[signal.rows], extrapolate=False) for signal in self.series]
            self.last[:] = [(response, splines)]
        shown = response.copy() if rows is None else response[rows]
        for signal, spline in zip(self.series, self.last[0][1], strict=True):
            where, along = (signal.rows, signal.along) if rows is None else self._placed(signal, rows)
            shown[where] = spline(time(along))
        return shown

    def _placed(self, signal: Series, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Where values of a series are among rows, and their times; remembered for the last rows."""
        if self.placed.get("rows") is not rows:
            self.placed.clear()
            self.placed["rows"] = rows
        if signal.name not in self.placed:
            index = np.minimum(np.searchsorted(signal.rows, rows), len(signal.rows) - 1)
            where = np.flatnonzero(signal.rows[index] == rows)
            self.placed[signal.name] = where, signal.along[index[where]]
        return self.placed[signal.name]


def clocks(record: FittedRecord, *, channels: bool) -> Iterator[Clock]:
    """Yield the clock of each experiment, that of all, and with ``channels`` that of each channel of an experiment."""
    known = [signal for signal in record.series if signal.unit == TIME and len(signal.rows) >= FEWEST]
    names = dict.fromkeys(signal.experiment for signal in known)
    groups = [(name, [signal for signal in known if signal.experiment == name]) for name in names]
    if len(groups) > 1:
        groups.append(("", known))
    if channels and len(known) > len(names):
        groups += [(signal.name, [signal]) for signal in known]
    for name, series in groups:
        period = min((_period(record, signal) for signal in series), default=0.0)
        if period > 0:
            yield Clock(name, tuple(series), period)


def _period(record: FittedRecord, signal: Series) -> float:
    """2π rms/rms of the rate, of the data's response; infinite where it does not move."""
    response = record.response_of(signal)
    rate = np.gradient(response, signal.along)
    size = np.sqrt(np.mean((response - response.mean()) ** 2) / max(np.mean(rate**2), np.finfo(float).tiny))
    return max(2 * np.pi * float(size), 4 * signal.step)
