"""Measured motion: channels along a coordinate, and how exact they are."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from dalembert.arguments import names_of
from dalembert.data.labels import by_name, check_labels, coordinate_of, cut, digest, real_numbers, table_of
from dalembert.errors import DataError, shown, unknown
from dalembert.forward import Coordinate

MISSING = ("refuse", "leave-out")
TURN = 2 * np.pi
FIRST = "first"
SAME = 1e-9  # part of the span below which two times are the same


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
    origin : str
        The file that they come from, and what a text file was taken to be, in words.
    sampled : array of bool, shape (samples, channels), optional
        Where the sensor of each channel takes samples, if not at all of the coordinate: a missing value elsewhere is
        no gap. See :func:`merged`.

    Raises
    ------
    DataError
        For values that are not real numbers, a coordinate that goes backwards, shapes that do not fit, names that
        repeat, deviations not positive, an unknown word for ``missing``, a wrapping channel that there is not.
    InputError
        For channels or ``wraps`` that are not names.
    """

    coordinate: Coordinate
    channels: tuple[str, ...]
    values: np.ndarray
    deviations: np.ndarray | None = None
    missing: str = "refuse"
    wraps: tuple[str, ...] = ()
    origin: str = ""
    sampled: np.ndarray | None = None

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
        names = names_of(by_name(channels), "Measurements", "channels")
        return cls(
            along, names, table_of(along, channels), _deviations(deviations, names), missing,
            names_of(wraps, "Measurements", "wraps"),
        )  # fmt: skip

    @property
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

    def since(self, start: float | str) -> "Measurements":
        """The same samples, with times that count from ``start``, or from the first sample if that is ``"first"``.

        A model's motion begins at time 0, and few records do.

        Raises
        ------
        DataError
            For another word.

        Examples
        --------
        >>> data = Measurements.of([48.2, 48.3, 48.4], {"x": [0.0, 1.0, 2.0]})
        >>> data.since("first").coordinate.values.round(9).tolist(), data.since(48.0).coordinate.values[0].round(9)
        ([0.0, 0.1, 0.2], np.float64(0.2))
        """
        along = self.coordinate
        shifted = replace(along, values=along.values - beginning(along.values, start))
        return replace(self, coordinate=shifted)

    def first(self, samples: int) -> "Measurements":
        """The first ``samples`` samples."""
        return self._rows(slice(samples), cut(self.coordinate, samples))

    def between(self, begin: float, end: float) -> "Measurements":
        """The samples from ``begin`` to ``end`` of the coordinate, both included.

        Raises
        ------
        DataError
            If there are none.
        """
        along = self.coordinate.values
        return self._picked((along >= begin) & (along <= end), f"from {begin:.10g} to {end:.10g}")

    def every(self, step: int) -> "Measurements":
        """Every ``step``-th sample, the first one among them; the others' information is lost.

        Raises
        ------
        DataError
            For a step below 1, and for channels with different time stamps, of which some would be lost.
        """
        if step < 1:
            raise DataError(f"every {step} samples; expected at least 1")
        if step > 1 and not self.taken.all():
            raise DataError(
                f"every {step} samples of channels with different time stamps; decimate them, or thin each record "
                "before they are merged"
            )
        return self._picked(np.arange(len(self.values)) % step == 0, "")

    def filtered(self, cutoff: float) -> "Measurements":
        """The channels without what is faster than a cutoff frequency, without delay.

        A Butterworth filter of fourth order runs forward and back (``scipy.signal.sosfiltfilt``). A component at the
        frequency f keeps the share 1 / (1 + (f / cutoff)⁸) of its amplitude: 0.5 at the cutoff, 0.996 at half of it,
        0.9998 at a third. So the response of a model is compared with filtered data as it is, where the motion lies
        below a third of the cutoff.

        Stretches between gaps, of missing values and of time stamps, are filtered for themselves; one that is shorter
        than a period of the cutoff becomes missing. Deviations are those of the filtered noise, if it was white.
        Filtered noise is correlated from sample to sample until the data are :meth:`decimated`.

        Parameters
        ----------
        cutoff : float
            Hz, less than half the sampling rate.

        Raises
        ------
        DataError
            For samples that are unevenly spaced or do not lie along time, and a cutoff that is too high.

        Examples
        --------
        >>> times = np.arange(2000) / 1000
        >>> slow, fast = np.sin(2 * np.pi * 3 * times), 0.2 * np.sin(2 * np.pi * 200 * times)
        >>> data = Measurements.of(times, {"x": slow + fast}, deviations=0.1).filtered(40.0)
        >>> bool(np.abs(data.values[200:-200, 0] - slow[200:-200]).max() < 1e-3), data.deviations.round(3)
        (True, array([0.027]))
        """
        from dalembert.data.filtering import filtered

        return filtered(self, cutoff)

    def decimated(self, factor: int, cutoff: float | None = None) -> "Measurements":
        """Every ``factor``-th sample of the :meth:`filtered` channels, the first one among them.

        Parameters
        ----------
        factor : int
        cutoff : float, optional
            Of the filter in Hz; 0.4 of the new sampling rate if not given.

        Raises
        ------
        DataError
            For a factor below 1, a cutoff above half the new sampling rate, and what :meth:`filtered` refuses.

        Examples
        --------
        >>> times = np.arange(2000) / 1000
        >>> data = Measurements.of(times, {"x": np.sin(20 * times)}).decimated(10)
        >>> len(data.values), round(float(data.coordinate.values[1]), 6)
        (200, 0.01)
        """
        from dalembert.data.filtering import decimated

        return decimated(self, factor, cutoff)

    def _picked(self, mask: np.ndarray, what: str) -> "Measurements":
        along = self.coordinate
        if not np.any(mask):
            raise DataError(
                f"no sample lies {what}; the {along.name} runs from {along.values[0]:.10g} to {along.values[-1]:.10g} "
                f"{along.unit}"
            )
        return self._rows(mask, Coordinate(along.name, along.unit, along.values[mask]))

    def _rows(self, rows: slice | np.ndarray, along: Coordinate) -> "Measurements":
        sampled = None if self.sampled is None else self.sampled[rows]
        return replace(self, coordinate=along, values=self.values[rows], sampled=sampled)

    def resampled(self, samples: ArrayLike, *, gap: float | None = None) -> "Measurements":
        """The channels at other samples of the coordinate, by cubic splines through the values.

        A spline is no filter: the new samples are values of the same motion, which is what a model sampled there
        gives too, aliased or not; for a spectrum, data must be low-pass filtered before they are sampled more coarsely.
        Noise is not averaged away, and where the new samples are denser than the old ones neighbours share it, so that
        they hold less information than they are counted as.

        New samples in a gap are missing: between values that are missing, and where the coordinate has a step of more
        than 1.5 times the usual one (which 95 % of the steps do not exceed). Wrapping channels are interpolated
        without their jumps and wrapped again.

        Parameters
        ----------
        samples : array, shape (new samples,)
            Growing, within the data.
        gap : float, optional
            Longest step of the coordinate that is no gap, in place of 1.5 times the usual one.

        Raises
        ------
        DataError
            For samples that lie outside the data, or do not grow.

        Examples
        --------
        >>> data = Measurements.of([0.0, 0.3, 0.5, 1.0], {"x": [0.0, 0.09, 0.25, 1.0]})
        >>> data.resampled([0.0, 0.4, 0.8]).values.round(12).tolist()
        [[0.0], [0.16], [0.64]]
        """
        from dalembert.data.resampling import resampled

        return resampled(self, np.array(samples, dtype=float), gap)

    def with_derivative(
        self,
        channel: str,
        name: str,
        *,
        order: int = 1,
        window: int | None = None,
        degree: int = 3,
        deviation: float | None = None,
        gap: float | None = None,
    ) -> "Measurements":
        """The measurements and a channel ``name`` beside them, a derivative of another one.

        Its deviation, where the data have deviations, is ``deviation``, or else the error that
        :func:`~dalembert.data.derivative` tells, which takes the same arguments.

        Examples
        --------
        >>> times = np.linspace(0, 1, 51)
        >>> data = Measurements.of(times, {"x": times**2}, deviations=1e-3).with_derivative("x", "vx")
        >>> data.channels, bool(np.max(np.abs(data.values[:, 1] - 2 * times)) < 5 * data.deviations[1])
        (('x', 'vx'), True)
        """
        from dalembert.data.derivative import derivative

        found = derivative(self, channel, order=order, window=window, degree=degree, gap=gap)
        deviations = self.deviations
        if deviations is not None:
            deviations = np.append(deviations, found.error if deviation is None else deviation)
        values = np.column_stack([self.values, found.values])
        taken = self.taken[:, [*range(len(self.channels)), self.channels.index(channel)]]
        sampled = None if self.sampled is None else taken
        return replace(self, channels=(*self.channels, name), values=values, deviations=deviations, sampled=sampled)

    @property
    def fingerprint(self) -> str:
        """Hash of all that the measurements say."""
        arrays = [self.values] if self.deviations is None else [self.values, self.deviations]
        arrays += [self.wrapping] if self.wraps else []
        return digest(self.coordinate, self.channels, *arrays)


def beginning(along: np.ndarray, start: float | str) -> float:
    """The time of a record (samples,) at which the motion begins: a number, or its first one.

    Raises
    ------
    DataError
        For another word.
    """
    if isinstance(start, str):
        if start != FIRST:
            raise DataError(f"start is {start!r}; expected {FIRST!r}, or the time at which the motion begins")
        return float(along[0])
    return float(start)


def merged(parts: Sequence[Measurements]) -> Measurements:
    """Channels of several records of the same experiment, at the times of all of them.

    A channel is missing where another record has a sample and its own has none. That is no gap: filters, derivatives
    and splines take each channel at its own samples. Times that differ by less than a billionth of the span are the
    same.

    Raises
    ------
    DataError
        For a channel in two records, records along different coordinates, deviations of some records only.

    Examples
    --------
    >>> angle = Measurements.of([0.0, 0.1, 0.2], {"angle": [0.0, 1.0, 2.0]})
    >>> force = Measurements.of([0.0, 0.2], {"force": [5.0, 6.0]})
    >>> merged([angle, force]).values.tolist()
    [[0.0, 5.0], [1.0, nan], [2.0, 6.0]]
    """
    first = parts[0]
    if len(parts) == 1:
        return first
    if len({(part.coordinate.name, part.coordinate.unit) for part in parts}) > 1:
        raise DataError("the records lie along different coordinates; expected times, or frequencies, of all of them")
    if len({part.deviations is None for part in parts}) > 1:
        raise DataError("some records have deviations and some have none; give them for all channels or for none")
    stamps = np.unique(np.concatenate([part.coordinate.values for part in parts]))
    stamps = stamps[np.concatenate([[True], np.diff(stamps) > SAME * max(float(np.ptp(stamps)), 1e-300)])]
    middles = (stamps[:-1] + stamps[1:]) / 2
    tables, sampled = [], []
    for part in parts:
        rows = np.searchsorted(middles, part.coordinate.values)
        for collected, own, empty in ((tables, part.values, np.nan), (sampled, part.taken, False)):
            table = np.full((len(stamps), len(part.channels)), empty)
            table[rows] = own
            collected.append(table)
    deviations = [part.deviations for part in parts if part.deviations is not None]
    return Measurements(
        replace(first.coordinate, values=stamps),
        tuple(name for part in parts for name in part.channels),
        np.hstack(tables),
        np.concatenate(deviations) if deviations else None,
        missing="leave-out",
        wraps=tuple(name for part in parts for name in part.wraps),
        origin="; ".join(filter(None, (part.origin for part in parts))),
        sampled=np.hstack(sampled),
    )


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
        return np.array([_deviation(given[name], name) for name in channels])
    array = real_numbers(given, "deviations")
    return np.full(len(channels), float(array)) if array.ndim == 0 else array


def _deviation(given: float, channel: str) -> float:
    number = real_numbers(given, f"the deviation of channel {channel!r}")
    if number.ndim:
        raise DataError(f"the deviation of channel {channel!r} is {shown(given)}; expected one number")
    return float(number)
