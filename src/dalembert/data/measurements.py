"""Measured motion: channels along a coordinate, and how exact they are."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from dalembert.data.labels import check_labels, coordinate_of, cut, digest, table_of
from dalembert.errors import DataError, unknown
from dalembert.forward import Coordinate

MISSING = ("refuse", "leave-out")
TURN = 2 * np.pi


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
    missing : {"refuse", "leave-out"}
        What a NaN among the values means to a method: a defect, or a sample that was not measured and does not count.
    wraps : tuple of str
        Channels that are angles in rad known up to whole turns: their differences count modulo 2π.

    Raises
    ------
    DataError
        For a coordinate that goes backwards, shapes that do not fit, names that repeat, deviations not positive, an
        unknown word for ``missing``, a wrapping channel that there is not.
    """

    coordinate: Coordinate
    channels: tuple[str, ...]
    values: np.ndarray
    deviations: np.ndarray | None = None
    missing: str = "refuse"
    wraps: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        check_labels(self.coordinate, self.channels, values=self.values)
        if self.missing not in MISSING:
            raise DataError(unknown("word", self.missing, MISSING, "missing"))
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

    @classmethod
    def of(
        cls,
        coordinate: Coordinate | ArrayLike,
        channels: Mapping[str, ArrayLike],
        deviations: Mapping[str, float] | ArrayLike | None = None,
        *,
        missing: str = "refuse",
        wraps: Iterable[str] = (),
    ) -> "Measurements":
        """Measurements from columns by name.

        Parameters
        ----------
        coordinate : Coordinate or array, shape (samples,)
            An array is taken as times in seconds.
        channels : mapping of str to array, shape (samples,)
        deviations : number, mapping by channel, or array of shape (channels,), optional
            Standard deviations of the noise; one number holds for all channels.
        missing : {"refuse", "leave-out"}
            With ``"leave-out"`` a NaN is a sample that was not measured, and does not count.
        wraps : iterable of str
            Channels that are angles known up to whole turns.

        Examples
        --------
        >>> data = Measurements.of([0.0, 0.1], {"AB.end.x": [1.0, 0.9], "AB.end.y": [0.0, -0.1]}, deviations=1e-3)
        >>> data.values.shape, data.deviations
        ((2, 2), array([0.001, 0.001]))
        """
        along = coordinate_of(coordinate)
        names = tuple(channels)
        return cls(along, names, table_of(along, channels), _deviations(deviations, names), missing, tuple(wraps))

    @property
    def present(self) -> np.ndarray:
        """Mask of the values that were measured, shape (samples, channels)."""
        return np.isfinite(self.values)

    @property
    def wrapping(self) -> np.ndarray:
        """Mask of the channels that wrap, shape (channels,)."""
        return np.isin(self.channels, self.wraps)

    @property
    def continuous(self) -> np.ndarray:
        """The values, shape (samples, channels), wrapping channels without their jumps by whole turns."""
        values = self.values.copy()
        for column in np.flatnonzero(self.wrapping):
            there = self.present[:, column]
            values[there, column] = np.unwrap(values[there, column])
        return values

    def difference(self, response: np.ndarray) -> np.ndarray:
        """Response − values, both (..., samples, channels); NaN where a value is missing.

        In wrapping channels less the nearest number of whole turns, so that it lies within ±π:

        >>> Measurements.of([0.0], {"angle": [3.1]}, wraps=["angle"]).difference(np.array([[-3.1]])).round(6).item()
        0.083185
        """
        difference = response - self.values
        if not self.wraps:
            return difference
        return np.where(self.wrapping, difference - TURN * np.rint(difference / TURN), difference)

    def first(self, samples: int) -> "Measurements":
        """The first ``samples`` samples."""
        return replace(self, coordinate=cut(self.coordinate, samples), values=self.values[:samples])

    @property
    def fingerprint(self) -> str:
        """Hash of all that the measurements say."""
        arrays = [self.values] if self.deviations is None else [self.values, self.deviations]
        arrays += [self.wrapping] if self.wraps else []
        return digest(self.coordinate, self.channels, *arrays)


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
