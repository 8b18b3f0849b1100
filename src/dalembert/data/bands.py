"""Bands: a lower and an upper bound of each channel along a coordinate."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from dalembert.argument_readers import names_of
from dalembert.data.labels import by_name, check_labels, coordinate_of, cut, digest, real_numbers, table_of
from dalembert.errors import DataError, shown
from dalembert.forward import Coordinate


@dataclass(frozen=True, eq=False)
class Bands:
    """Bounds of channels along a coordinate, usually time: measured, published or computed.

    Parameters
    ----------
    coordinate : Coordinate
        What the samples lie along; its values grow strictly, shape (samples,).
    channels : tuple of str
        Names as in the model that is to explain them.
    lower, upper : array, shape (samples, channels)
        In SI units; equal where a value is known exactly.
    source_units : mapping of str to str
        Unit in which the file gave the bounds of a channel, as it was written.

    Raises
    ------
    DataError
        For a bound that is not finite, or a lower one above its upper one, with the channel and the sample; for a
        coordinate that goes backwards, shapes that do not fit, names that repeat.

    Examples
    --------
    >>> bands = Bands.of([0.0, 0.1], {"AB.end.x": ([0.9, 0.8], [1.1, 1.2])})
    >>> bands.middle[:, 0].round(12).tolist(), bands.width[:, 0].round(12).tolist()
    ([1.0, 1.0], [0.2, 0.4])
    """

    coordinate: Coordinate
    channels: tuple[str, ...]
    lower: np.ndarray
    upper: np.ndarray
    source_units: Mapping[str, str] = field(default_factory=dict, kw_only=True)

    def __post_init__(self) -> None:
        for name, value in (
            ("coordinate", coordinate_of(self.coordinate)),
            ("channels", names_of(self.channels, "Bands", "channels")),
            ("lower", real_numbers(self.lower, "lower bounds")),
            ("upper", real_numbers(self.upper, "upper bounds")),
        ):
            object.__setattr__(self, name, value)
        check_labels(self.coordinate, self.channels, **{"lower bounds": self.lower, "upper bounds": self.upper})
        for side in ("lower", "upper"):
            bounds = getattr(self, side)
            if not np.all(np.isfinite(bounds)):
                place = np.argwhere(~np.isfinite(bounds))[0]
                raise DataError(
                    f"{self._place(*place)}: the {side} bound is {bounds[tuple(place)]}; expected a finite number"
                )
        if np.any(self.lower > self.upper):
            place = np.argwhere(self.lower > self.upper)[0]
            lower, upper = self.lower[tuple(place)], self.upper[tuple(place)]
            raise DataError(
                f"{self._place(*place)}: the lower bound {lower:.10g} is larger than the upper bound {upper:.10g}; "
                "expected the lower one first; look whether the columns are exchanged"
            )

    def _place(self, sample: int, column: int) -> str:
        along = self.coordinate
        at = f"{along.name} {along.values[sample]:.10g} {along.unit}".rstrip()
        return f"channel {self.channels[column]!r}, sample {sample} ({at})"

    @classmethod
    def of(cls, coordinate: Coordinate | ArrayLike, channels: Mapping[str, tuple[ArrayLike, ArrayLike]]) -> "Bands":
        """Bands from pairs of columns by name.

        Parameters
        ----------
        coordinate : Coordinate or array, shape (samples,)
            An array is taken as times in seconds.
        channels : mapping of str to (lower, upper), each of shape (samples,)
        """
        along = coordinate_of(coordinate)
        names = names_of(by_name(channels), "Bands", "channels")
        for name, pair in channels.items():
            if not hasattr(pair, "__len__") or isinstance(pair, str):
                raise DataError(f"channel {name!r} is {shown(pair)}; expected two columns, (lower, upper)")
            if len(pair) != 2:
                raise DataError(f"channel {name!r}: {len(pair)} columns were given; expected two, (lower, upper)")
        lower, upper = (table_of(along, {name: pair[side] for name, pair in channels.items()}) for side in (0, 1))
        return Bands(along, names, lower, upper)

    @property
    def middle(self) -> np.ndarray:
        """(lower + upper) / 2, shape (samples, channels)."""
        return (self.lower + self.upper) / 2

    @property
    def radius(self) -> np.ndarray:
        """(upper − lower) / 2, shape (samples, channels)."""
        return self.width / 2

    @property
    def width(self) -> np.ndarray:
        """Upper − lower, shape (samples, channels)."""
        return self.upper - self.lower

    def first(self, samples: int) -> "Bands":
        """The first ``samples`` samples."""
        return Bands(cut(self.coordinate, samples), self.channels, self.lower[:samples], self.upper[:samples])

    @property
    def fingerprint(self) -> str:
        """Hash of all that the bands say."""
        return digest(self.coordinate, self.channels, self.lower, self.upper)
