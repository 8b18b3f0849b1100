"""Channels that were recorded along a coordinate: their values, their gaps, and parts of them."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Self, TypeVar

import numpy as np

from dalembert.argument_readers import names_of
from dalembert.data.labels import check_labels, coordinate_of, cut, digest, real_numbers
from dalembert.errors import DataError, unknown
from dalembert.forward import Coordinate

MISSING = ("refuse", "leave-out")
TURN = 2 * np.pi
FIRST = "first"


@dataclass(frozen=True, eq=False)
class Record:
    """Channels along a coordinate, and their parts. The parameters are those of :class:`dalembert.data.Measurements`,
    which adds what filters, derivatives and splines make of them.
    """

    coordinate: Coordinate
    channels: tuple[str, ...]
    values: np.ndarray
    deviations: np.ndarray | None = None
    missing: str = "refuse"
    wraps: tuple[str, ...] = ()
    origin: str = ""
    sampled: np.ndarray | None = None
    source_units: Mapping[str, str] = field(default_factory=dict, kw_only=True)

    def __post_init__(self) -> None:
        for name, value in (
            ("coordinate", coordinate_of(self.coordinate)),
            ("channels", names_of(self.channels, "Measurements", "channels")),
            ("values", real_numbers(self.values, "values")),
            ("deviations", None if self.deviations is None else real_numbers(self.deviations, "deviations")),
            ("wraps", names_of(self.wraps, "Measurements", "wraps")),
        ):
            object.__setattr__(self, name, value)
        check_labels(self.coordinate, self.channels, values=self.values)
        if self.sampled is not None and np.shape(self.sampled) != self.values.shape:
            raise DataError(f"sampled of shape {np.shape(self.sampled)} was given; expected {self.values.shape}")
        if self.missing not in MISSING:
            raise DataError(unknown("word", str(self.missing), MISSING, "missing"))
        for name in self.wraps:
            if name not in self.channels:
                raise DataError(unknown("channel", name, self.channels, "wraps"))
        if self.deviations is not None:
            self._check_deviations(self.deviations)

    def _check_deviations(self, deviations: np.ndarray) -> None:
        if deviations.shape != (len(self.channels),):
            raise DataError(
                f"deviations of shape {deviations.shape} were given; expected ({len(self.channels)},), "
                f"one a channel: {', '.join(self.channels)}"
            )
        for name, deviation in zip(self.channels, deviations, strict=True):
            if not (np.isfinite(deviation) and deviation > 0):
                raise DataError(f"channel {name!r}: its deviation is {deviation}; expected a positive number")

    @cached_property
    def present(self) -> np.ndarray:
        """Mask of the values that were measured, shape (samples, channels)."""
        return np.isfinite(self.values)

    @property
    def taken(self) -> np.ndarray:
        """Mask of the samples that each channel's sensor takes, measured or lost, shape (samples, channels)."""
        return np.ones(self.values.shape, dtype=bool) if self.sampled is None else np.asarray(self.sampled, dtype=bool)

    @property
    def wrapping(self) -> np.ndarray:
        """Mask of the channels that wrap, shape (channels,)."""
        return np.isin(self.channels, self.wraps)

    @property
    def continuous(self) -> np.ndarray:
        """The values, shape (samples, channels), wrapping channels without their jumps by whole turns."""
        values = self.values.copy()
        for column in np.flatnonzero(self.wrapping):
            present = self.present[:, column]
            values[present, column] = np.unwrap(values[present, column])
        return values

    def difference(self, response: np.ndarray) -> np.ndarray:
        """Response − values, both (..., samples, channels); NaN where a value is missing.

        In wrapping channels less the nearest number of whole turns, so that it lies within ±π:

        >>> from dalembert.data import Measurements
        >>> Measurements.of([0.0], {"angle": [3.1]}, wraps=["angle"]).difference(np.array([[-3.1]])).round(6).item()
        0.083185
        """
        difference = response - self.values
        if not self.wraps:
            return difference
        return np.where(self.wrapping, difference - TURN * np.rint(difference / TURN), difference)

    def since(self, start: float | str) -> Self:
        """The same samples, with times that count from ``start``, or from the first sample if that is ``"first"``.

        A model's motion begins at time 0, and few records do.

        Examples
        --------
        >>> from dalembert.data import Measurements
        >>> data = Measurements.of([48.2, 48.3, 48.4], {"x": [0.0, 1.0, 2.0]})
        >>> data.since("first").coordinate.values.round(9).tolist(), data.since(48.0).coordinate.values[0].round(9)
        ([0.0, 0.1, 0.2], np.float64(0.2))
        """
        along = self.coordinate
        shifted = replace(along, values=along.values - beginning(along.values, start))
        return replace(self, coordinate=shifted)

    def first(self, samples: int) -> Self:
        """The first ``samples`` samples."""
        return self._rows(slice(samples), cut(self.coordinate, samples))

    def between(self, begin: float, end: float) -> Self:
        """The samples from ``begin`` to ``end`` of the coordinate, both included."""
        along = self.coordinate.values
        return self._picked((along >= begin) & (along <= end), f"from {begin:.10g} to {end:.10g}")

    def every(self, step: int) -> Self:
        """Every ``step``-th sample, the first one among them; the others' information is lost."""
        if step < 1:
            raise DataError(f"every {step} samples; expected at least 1")
        if step > 1 and not self.taken.all():
            raise DataError(
                f"every {step} samples of channels with different time stamps; decimate them, or thin each record "
                "before they are merged"
            )
        return self._picked(np.arange(len(self.values)) % step == 0, "")

    def _picked(self, mask: np.ndarray, what: str) -> Self:
        along = self.coordinate
        if not np.any(mask):
            raise DataError(
                f"no sample lies {what}; the {along.name} runs from {along.values[0]:.10g} to {along.values[-1]:.10g} "
                f"{along.unit}"
            )
        return self._rows(mask, Coordinate(along.name, along.unit, along.values[mask]))

    def _rows(self, rows: slice | np.ndarray, along: Coordinate) -> Self:
        sampled = None if self.sampled is None else self.sampled[rows]
        return replace(self, coordinate=along, values=self.values[rows], sampled=sampled)

    @property
    def fingerprint(self) -> str:
        """Hash of all that the measurements say."""
        arrays = [self.values] if self.deviations is None else [self.values, self.deviations]
        arrays += [self.wrapping] if self.wraps else []
        return digest(self.coordinate, self.channels, *arrays)


Recorded = TypeVar("Recorded", bound=Record)


def beginning(along: np.ndarray, start: float | str) -> float:
    """The time of a record (samples,) at which the motion begins: a number, or its first one."""
    if isinstance(start, str):
        if start != FIRST:
            raise DataError(f"start is {start!r}; expected {FIRST!r}, or the time at which the motion begins")
        return float(along[0])
    return float(start)
