"""Measurements of a decay: which channels, what they measure, and where the hammer has left the structure."""

from collections.abc import Mapping, Sequence

import numpy as np

from dalembert.data import Measurements
from dalembert.errors import DataError, InputError, counted, repeated, require_known
from dalembert.inverse.decays.decay_record import DecayRecord
from dalembert.inverse.decays.sensors import quantity_of

CONTACT, NOISE, QUIET = 0.02, 8.0, 5
"""Part of the largest force, and of its median, below which a number of samples say that the hammer has left."""
UNEVEN = 0.02
"""Relative difference of steps that is no gap."""


def measured_decay(
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
    named = [*(channels or ()), *([force] if force else []), *(quantity if isinstance(quantity, Mapping) else ())]
    for name in named:
        require_known("channel", name, data.channels, "ring_down")
    chosen = tuple(channels or (name for name in data.channels if name != force))
    if several := repeated(chosen):
        raise InputError(f"ring_down: channels names {', '.join(map(repr, several))} more than once. Name each once")
    columns = [data.channels.index(name) for name in chosen]
    orders, units = zip(*(quantity_of(data, name, quantity) for name in chosen), strict=True)
    times, values = data.coordinate.values, data.values[:, columns]
    if data.coordinate.unit != "s":
        raise DataError(f"ring_down: the samples lie along the {data.coordinate.name}; expected times in s")
    rows = ~np.isfinite(values).all(axis=1)
    if rows.any():
        raise DataError(
            f"ring_down: the decay has {counted(int(rows.sum()), 'missing sample')}, the first at "
            f"{times[np.argmax(rows)]:.6g} s. Give the part without gaps, by Measurements.between"
        )
    apart = np.diff(times)
    step = float(np.mean(apart)) if len(apart) else 1.0
    uneven = np.flatnonzero(np.abs(apart - step) > UNEVEN * step)
    if len(uneven) or not len(apart):
        place = f"behind {times[uneven[0]]:.6g} s " if len(uneven) else ""
        raise DataError(
            f"ring_down: the samples {place}are not evenly spaced. Give a part without gaps, by Measurements.between, "
            "or resample the record, by Measurements.resampled"
        )
    for name, column in zip(chosen, values.T, strict=True):
        if not np.ptp(column) > 0:
            raise DataError(f"ring_down: {name!r} is {column[0]:.4g} at all times. Leave it out, by channels=[...]")
    # A constant is fitted in each window; without it sizes of the motion are those of the vibration.
    values = values - np.median(values, axis=0)
    record = DecayRecord(float(times[0]), step, values, chosen, orders, units)
    if force is None:
        return record
    pushed = data.values[:, data.channels.index(force)]
    pushed = np.abs(
        np.nan_to_num(pushed - np.nanmedian(pushed)) if np.isfinite(pushed).any() else np.zeros(len(pushed))
    )
    top = int(np.argmax(pushed))
    level = max(CONTACT * pushed[top], NOISE * float(np.median(pushed)))
    if not pushed[top] > level:
        raise DataError(f"ring_down: the force {force!r} has no pulse. Name the hammer's channel, or leave it out")
    # The first samples behind the peak that all are small; the sensor's filter has spread the end of the pulse.
    small = np.convolve(pushed[top:] <= level, np.ones(QUIET), mode="valid")
    quiet = np.flatnonzero(small == QUIET)
    if not len(quiet):
        raise DataError(
            f"ring_down: the force {force!r} does not end. Give the start of the free decay, start=..., and leave the "
            "force out"
        )
    return record.between(float(times[top + quiet[0]]), float(times[-1]))
