"""The free part of a measured decay: evenly sampled, after the contact of the hammer, and above the noise."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.signal import firwin, oaconvolve

from dalembert.data import Measurements
from dalembert.data.filtering import even_spacing
from dalembert.errors import DataError, InputError, counted, require_known
from dalembert.inverse.mistakes.patterns import plateaus
from dalembert.unit_table import readings
from dalembert.units import si_unit

QUANTITIES = {"displacement": 0, "strain": 0, "velocity": 1, "acceleration": 2}
"""What sensors measure, and how many derivatives by time of the displacement that is."""
_BY_UNIT = {
    "m": "displacement", "rad": "displacement", "m/s": "velocity", "rad/s": "velocity", "m/s^2": "acceleration",
    "rad/s^2": "acceleration",
}  # fmt: skip
LEAST, MOST = 16, 48
"""Samples of a period: fewer do not show the harmonics, more than the second are thinned."""
PERIODS = 12
"""Periods that a decay needs."""
CONTACT = 0.02
"""Part of the largest force below which the hammer has left the structure."""


@dataclass(frozen=True)
class DecayRecord:
    """Free decay at evenly spaced times. ``start``: time of the first sample; ``values`` (samples, channels);
    ``orders`` (channels,): derivatives by time that the sensors see.
    """

    start: float
    step: float
    values: np.ndarray
    channels: tuple[str, ...]
    orders: tuple[int, ...]

    @cached_property
    def times(self) -> np.ndarray:
        return self.start + self.step * np.arange(len(self.values))

    @property
    def duration(self) -> float:
        return self.step * (len(self.values) - 1)

    def rows(self, begin: float, end: float) -> slice:
        """The samples between two times, both included."""
        first = int(np.ceil((begin - self.start) / self.step - 1e-9))
        last = int(np.floor((end - self.start) / self.step + 1e-9))
        return slice(max(first, 0), min(last + 1, len(self.values)))

    def between(self, begin: float, end: float) -> "DecayRecord":
        rows = self.rows(begin, end)
        return replace(self, start=self.start + self.step * rows.start, values=self.values[rows])

    def thinned(self, frequency: float) -> "DecayRecord":
        """The record with at most ``MOST`` samples of a period of the mode, after a low-pass filter without delay."""
        factor = int(1 / (self.step * frequency * MOST))
        if factor < 2:
            return self
        # Half of the new rate is `MOST`/2 periods: the filter is flat over the mode and its harmonics.
        taps = np.asarray(firwin(16 * factor + 1, 0.8 / factor, window="blackman"))
        slow = oaconvolve(self.values, taps[:, None], mode="valid", axes=0)[::factor]
        return replace(self, start=self.start + 8 * factor * self.step, step=factor * self.step, values=slow)


def decay_record(
    data: Measurements, channels: Sequence[str] | None, quantity: str | Mapping[str, str] | None, force: str | None
) -> DecayRecord:
    """The chosen channels of measurements, from the end of the contact where a channel of the hammer's force says it.

    Raises
    ------
    DataError
        For samples that do not lie evenly along time, missing or clipped ones.
    InputError
        For an unknown channel or quantity, and channels that measure nothing that is known.
    """
    for name in (*(channels or ()), *([force] if force else [])):
        require_known("channel", name, data.channels, "ring_down")
    chosen = tuple(channels or (name for name in data.channels if name != force))
    columns = [data.channels.index(name) for name in chosen]
    orders = tuple(QUANTITIES[_quantity(data, name, quantity)] for name in chosen)
    times, values = data.coordinate.values, data.values[:, columns]
    if data.coordinate.unit != "s":
        raise DataError(f"ring_down: the samples lie along the {data.coordinate.name}; expected times in s")
    step = even_spacing(times)
    rows = ~np.isfinite(values).all(axis=1)
    if rows.any():
        raise DataError(
            f"ring_down: the decay has {counted(int(rows.sum()), 'missing sample')}, the first at "
            f"{times[np.argmax(rows)]:.6g} s. Give the part without gaps, by Measurements.between"
        )
    _refuse_clipped(chosen, times, values)
    record = DecayRecord(float(times[0]), step, values, chosen, orders)
    return record if force is None else record.between(_contact_end(data, force), float(times[-1]))


def _quantity(data: Measurements, name: str, quantity: str | Mapping[str, str] | None) -> str:
    """What a channel measures: as given, or by its unit."""
    word = quantity if isinstance(quantity, str) else (quantity or {}).get(name)
    if word is None:
        units = map(si_unit, readings(data.source_units.get(name, "")))
        word = next((_BY_UNIT[unit] for unit in units if unit in _BY_UNIT), None)
    if word is None:
        raise InputError(
            f"ring_down: channel {name!r} may measure a displacement, a velocity, an acceleration or a strain. "
            f"Say which, for example quantity={{{name!r}: 'acceleration'}}"
        )
    require_known("quantity", word, QUANTITIES, "ring_down")
    return word


def _refuse_clipped(channels: Sequence[str], times: np.ndarray, values: np.ndarray) -> None:
    for name, column in zip(channels, values.T, strict=True):
        ends = plateaus(column)
        if ends.any():
            at = times[np.argmax(ends)]
            raise DataError(
                f"ring_down: {counted(int(ends.sum()), 'sample')} of {name!r} are clipped at "
                f"{np.abs(column[ends]).max():.4g}, the first at {at:.6g} s. Hit more softly, take a larger range, or "
                "give the part after the last clipped sample, by Measurements.between"
            )


def _contact_end(data: Measurements, force: str) -> float:
    """Time at which the hammer's force is over."""
    pushed = np.abs(data.values[:, data.channels.index(force)])
    top = float(np.nanmax(pushed))
    if not top > 0:
        raise DataError(f"ring_down: the force {force!r} is 0 at all times. Name the hammer's channel, or leave it out")
    # Twice the distance of samples behind, since the sensor's filter has spread the end of the pulse.
    last = int(np.flatnonzero(pushed > CONTACT * top)[-1])
    return float(data.coordinate.values[min(last + 2, len(pushed) - 1)])
