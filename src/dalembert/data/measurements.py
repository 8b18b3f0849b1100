"""Measured motion: channels along a coordinate, and how exact they are."""

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from dalembert.errors import DataError, unknown
from dalembert.forward import Coordinate


@dataclass(frozen=True, eq=False)
class Measurements:
    """Measured channels along a coordinate, usually time.

    Parameters
    ----------
    coordinate : Coordinate
        What the samples lie along; its values grow strictly, shape (samples,).
    channels : tuple of str
        Names as in the model that is to explain them.
    values : array, shape (samples, channels)
        In SI units.
    deviations : array, shape (channels,), optional
        Standard deviation of each channel's noise, in the channel's unit.

    Raises
    ------
    DataError
        For a coordinate that goes backwards, shapes that do not fit, names that repeat, deviations not positive.
    """

    coordinate: Coordinate
    channels: tuple[str, ...]
    values: np.ndarray
    deviations: np.ndarray | None = None

    def __post_init__(self) -> None:
        samples = self.coordinate.values
        expected = (len(samples), len(self.channels))
        if len(samples) == 0 or len(self.channels) == 0:
            raise DataError(
                f"the data hold {expected[0]} samples of {expected[1]} channels; expected at least one of each"
            )
        if self.values.shape != expected:
            raise DataError(
                f"the values have shape {self.values.shape}; expected (samples, channels) = {expected} "
                f"for {', '.join(self.channels)}"
            )
        repeated = sorted({name for name in self.channels if self.channels.count(name) > 1})
        if repeated:
            raise DataError(f"channel names must differ; repeated: {', '.join(repeated)}")
        if not np.all(np.isfinite(samples)):
            row = int(np.argmin(np.isfinite(samples)))
            raise DataError(f"sample {row}: {self.coordinate.name} is {samples[row]}; expected a finite number")
        back = np.flatnonzero(np.diff(samples) <= 0)
        if len(back):
            row = int(back[0]) + 1
            raise DataError(
                f"sample {row}: {self.coordinate.name} {samples[row]:.10g} comes after {samples[row - 1]:.10g}; "
                "expected values that grow; sort the samples or remove the repeated one"
            )
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

    @classmethod
    def of(
        cls,
        coordinate: Coordinate | ArrayLike,
        channels: Mapping[str, ArrayLike],
        deviations: Mapping[str, float] | ArrayLike | None = None,
    ) -> "Measurements":
        """Measurements from columns by name.

        Parameters
        ----------
        coordinate : Coordinate or array, shape (samples,)
            An array is taken as times in seconds.
        channels : mapping of str to array, shape (samples,)
        deviations : number, mapping by channel, or array of shape (channels,), optional
            Standard deviations of the noise; one number holds for all channels.

        Examples
        --------
        >>> data = Measurements.of([0.0, 0.1], {"AB.end.x": [1.0, 0.9], "AB.end.y": [0.0, -0.1]}, deviations=1e-3)
        >>> data.values.shape, data.deviations
        ((2, 2), array([0.001, 0.001]))
        """
        if not isinstance(coordinate, Coordinate):
            coordinate = Coordinate("time", "s", np.array(coordinate, dtype=float))
        columns = [np.array(column, dtype=float) for column in channels.values()]
        for name, column in zip(channels, columns, strict=True):
            if column.shape != coordinate.values.shape:
                raise DataError(
                    f"channel {name!r} has shape {column.shape}; expected {coordinate.values.shape}, "
                    f"one value a {coordinate.name}"
                )
        values = np.stack(columns, axis=1) if columns else np.empty((len(coordinate.values), 0))
        return cls(coordinate, tuple(channels), values, _deviations(deviations, tuple(channels)))

    def first(self, samples: int) -> "Measurements":
        """The first ``samples`` samples."""
        start = Coordinate(self.coordinate.name, self.coordinate.unit, self.coordinate.values[:samples])
        return Measurements(start, self.channels, self.values[:samples], self.deviations)

    @property
    def fingerprint(self) -> str:
        """Hash of all that the measurements say."""
        parts = [self.coordinate.values, self.values, *([] if self.deviations is None else [self.deviations])]
        names = "\n".join([self.coordinate.name, self.coordinate.unit, *self.channels])
        return hashlib.sha256(
            names.encode() + b"".join(np.ascontiguousarray(part).tobytes() for part in parts)
        ).hexdigest()


def _deviations(given: Mapping[str, float] | ArrayLike | None, channels: tuple[str, ...]) -> np.ndarray | None:
    """Deviations of shape (channels,) from a number, a mapping by name or an array."""
    if given is None:
        return None
    if isinstance(given, Mapping):
        for name in given:
            if name not in channels:
                raise DataError(unknown("channel", name, channels, "deviations"))
        missing = [name for name in channels if name not in given]
        if missing:
            raise DataError(
                f"no deviation given for channel {missing[0]!r}; give one for each of {', '.join(channels)}"
            )
        return np.array([given[name] for name in channels], dtype=float)
    array = np.array(given, dtype=float)
    return np.full(len(channels), float(array)) if array.ndim == 0 else array
