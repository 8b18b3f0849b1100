"""Measured motion: channels along a coordinate, and how exact they are."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from dalembert.argument_readers import names_of
from dalembert.data.derivatives import derivative
from dalembert.data.filtering import decimated, filtered
from dalembert.data.labels import by_name, coordinate_of, real_numbers, table_of
from dalembert.data.record import Record
from dalembert.data.resampling import resampled
from dalembert.errors import DataError, shown, unknown
from dalembert.forward import Coordinate

SAME = 1e-9  # part of the span below which two times are the same


@dataclass(frozen=True, eq=False)
class Measurements(Record):
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
    source_units : mapping of str to str
        Unit in which the file gave a channel, or the coordinate by its name, as it was written; none where it gave SI
        units without naming them. The values are in SI units.

    Raises
    ------
    DataError
        For values that are not real numbers, a coordinate that goes backwards, shapes that do not fit, names that
        repeat, deviations not positive, an unknown word for ``missing``, a wrapping channel that there is not.
    InputError
        For channels or ``wraps`` that are not names.
    """

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
        return decimated(self, factor, cutoff)

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
        :func:`~dalembert.data.derivative` returns, which takes the same arguments.

        Examples
        --------
        >>> times = np.linspace(0, 1, 51)
        >>> data = Measurements.of(times, {"x": times**2}, deviations=1e-3).with_derivative("x", "vx")
        >>> data.channels, bool(np.max(np.abs(data.values[:, 1] - 2 * times)) < 5 * data.deviations[1])
        (('x', 'vx'), True)
        """
        rate = derivative(self, channel, order=order, window=window, degree=degree, gap=gap)
        deviations = self.deviations
        if deviations is not None:
            deviations = np.append(deviations, rate.error if deviation is None else deviation)
        values = np.column_stack([self.values, rate.values])
        taken = self.taken[:, [*range(len(self.channels)), self.channels.index(channel)]]
        sampled = None if self.sampled is None else taken
        return replace(self, channels=(*self.channels, name), values=values, deviations=deviations, sampled=sampled)


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
        for collected, array, empty in ((tables, part.values, np.nan), (sampled, part.taken, False)):
            table = np.full((len(stamps), len(part.channels)), empty)
            table[rows] = array
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
        source_units={name: unit for part in reversed(parts) for name, unit in part.source_units.items()},
    )


def _deviations(deviations: Mapping[str, float] | ArrayLike | None, channels: tuple[str, ...]) -> np.ndarray | None:
    """Deviations of shape (channels,) from a number, a mapping by name or an array."""
    if deviations is None:
        return None
    if isinstance(deviations, Mapping):
        for name in deviations:
            if name not in channels:
                raise DataError(unknown("channel", name, channels, "deviations"))
        missing = [name for name in channels if name not in deviations]
        if missing:
            raise DataError(
                f"no deviation given for channel {missing[0]!r}; give one for each of {', '.join(channels)}"
            )
        return np.array([_deviation(deviations[name], name) for name in channels])
    array = real_numbers(deviations, "deviations")
    return np.full(len(channels), float(array)) if array.ndim == 0 else array


def _deviation(deviation: float, channel: str) -> float:
    number = real_numbers(deviation, f"the deviation of channel {channel!r}")
    if number.ndim:
        raise DataError(f"the deviation of channel {channel!r} is {shown(deviation)}; expected one number")
    return float(number)
