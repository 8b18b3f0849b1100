"""Measurements of a decay: which channels, what they measure, and where the hammer has left the structure."""

from collections.abc import Mapping, Sequence

import numpy as np

from dalembert.data import Measurements
from dalembert.data.filtering import even_spacing
from dalembert.errors import DataError, counted, require_known
from dalembert.inverse.decays.decay_record import DecayRecord
from dalembert.inverse.decays.sensors import QUANTITIES, quantity_of
from dalembert.inverse.mistakes.patterns import plateaus

CONTACT = 0.02
"""Part of the largest force below which the hammer has left the structure."""


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
    for name in (*(channels or ()), *([force] if force else [])):
        require_known("channel", name, data.channels, "ring_down")
    chosen = tuple(channels or (name for name in data.channels if name != force))
    columns = [data.channels.index(name) for name in chosen]
    orders = tuple(QUANTITIES[quantity_of(data, name, quantity)] for name in chosen)
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
    for name, column in zip(chosen, values.T, strict=True):
        ends = plateaus(column)
        if ends.any():
            at = times[np.argmax(ends)]
            raise DataError(
                f"ring_down: {counted(int(ends.sum()), 'sample')} of {name!r} are clipped at "
                f"{np.abs(column[ends]).max():.4g}, the first at {at:.6g} s. Hit more softly, take a larger range, or "
                "give the part after the last clipped sample, by Measurements.between"
            )
    record = DecayRecord(float(times[0]), step, values, chosen, orders)
    if force is None:
        return record
    pushed = np.abs(data.values[:, data.channels.index(force)])
    top = float(np.nanmax(pushed))
    if not top > 0:
        raise DataError(f"ring_down: the force {force!r} is 0 at all times. Name the hammer's channel, or leave it out")
    # Two samples behind the end of the pulse, since the sensor's filter has spread it.
    last = int(np.flatnonzero(pushed > CONTACT * top)[-1])
    return record.between(float(times[min(last + 2, len(times) - 1)]), float(times[-1]))
