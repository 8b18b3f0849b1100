"""A first look at a record: the frequency of the mode, and where its free decay begins and ends."""

import numpy as np

from dalembert.errors import DataError, InputError
from dalembert.inverse.decays.band_pass import analytic_signal
from dalembert.inverse.decays.decay_record import LEAST, PERIODS, DecayRecord
from dalembert.inverse.decays.free_decay import FreeDecay
from dalembert.inverse.decays.other_modes import with_other_modes
from dalembert.inverse.decays.sensors import Sensors

NEAR = 0.2
"""Relative distance from an expected frequency within which the mode is looked for."""


def mode_frequency(record: DecayRecord, near: float | None) -> float:
    """Frequency, Hz, of the strongest line of the spectrum, or of the strongest near a frequency."""
    padded = 4 * len(record.values)
    # Velocities and accelerations over the frequency: lines as strong as displacements.
    frequencies = np.fft.rfftfreq(padded, record.step)
    lines = np.abs(np.fft.rfft(record.values - record.values.mean(axis=0), padded, axis=0))
    sizes = np.sqrt(np.mean(record.values**2, axis=0)) + np.finfo(float).tiny
    power = np.sum((lines / sizes) ** 2, axis=1)
    inside = frequencies > 2 / max(record.duration, record.step)
    if near is not None:
        if not 0 < near < 0.5 / record.step:
            raise InputError(
                f"ring_down: the frequency is {near:g} Hz; expected a positive one below {0.5 / record.step:.6g} Hz, "
                "half of the sampling rate"
            )
        inside &= np.abs(frequencies / near - 1) < NEAR
    if not inside.any() or not np.any(power[inside] > 0):
        raise DataError("ring_down: the record has no oscillation. Give a longer record, or another frequency")
    frequency = float(frequencies[np.flatnonzero(inside)[np.argmax(power[inside])]])
    if 1 / (record.step * frequency) < LEAST:
        raise DataError(
            f"ring_down: {1 / (record.step * frequency):.3g} samples in a period of {frequency:.6g} Hz; expected at "
            f"least {LEAST}. Sample faster"
        )
    return frequency


def first_look(record: DecayRecord, frequency: float, start: float | None) -> FreeDecay:
    """Look at a record: noise, begin, end, other modes.

    Raises
    ------
    DataError
        For a record that is too short, or does not decay.
    """
    record = record.thinned(frequency)
    record = record.between(record.largest(frequency) if start is None else start, record.times[-1])
    periods = record.duration * frequency
    if periods < PERIODS:
        raise DataError(
            f"ring_down: the free decay lasts {record.duration:.3g} s, {periods:.2g} periods of {frequency:.6g} Hz; "
            f"expected at least {PERIODS}. Record for longer, or look whether the frequency is that of the mode"
        )
    signal = analytic_signal(record, frequency)
    # Deviations in proportion to the motion, as nothing is known of the noise yet.
    sensors = Sensors(record.orders, 1e-3 * np.sqrt(np.mean(record.values**2, axis=0)) + np.finfo(float).tiny)
    decay = FreeDecay(record, signal.rates(frequency), sensors, signal).ended()
    decay = with_other_modes(decay.with_noise())
    return decay if start is not None else decay.begun()
