"""A first look at a record: the frequency of the mode, and where its free decay begins and ends."""

import numpy as np

from dalembert.errors import DataError, InputError, counted
from dalembert.inverse.decays.band_pass import analytic_signal
from dalembert.inverse.decays.decay_record import LEAST, PERIODS, DecayRecord
from dalembert.inverse.decays.free_decay import NEAR, FreeDecay
from dalembert.inverse.decays.other_modes import with_other_modes
from dalembert.inverse.decays.sensors import Sensors
from dalembert.inverse.mistakes.patterns import FEWEST, plateaus


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


def first_look(record: DecayRecord, expected: float | None, start: float | None) -> FreeDecay:
    """Look at a record: noise, begin, end, other modes. ``expected``: frequency near that of the mode, Hz.

    Raises
    ------
    DataError
        For a record that is too short, or does not decay.
    """
    frequency = mode_frequency(record, expected)
    if start is not None and not record.times[0] <= start < record.times[-1]:
        raise InputError(
            f"ring_down: start is {start:g} s; expected a time of the record, {record.times[0]:.6g} to "
            f"{record.times[-1]:.6g} s"
        )
    record = record.between(record.largest(frequency) if start is None else start, record.times[-1])
    periods = record.duration * frequency
    if periods < PERIODS:
        raise DataError(
            f"ring_down: the free decay lasts {record.duration:.3g} s, {periods:.2g} periods of {frequency:.6g} Hz; "
            f"expected at least {PERIODS}. Record for longer, or look whether the frequency is that of the mode"
        )
    for name, column in zip(record.channels, record.values.T, strict=True):
        ends = plateaus(column)
        # At a smooth extreme, samples agree in the last digit over this part of a period.
        digit = np.diff(np.unique(column)).min()
        flat = 4 * float(np.sqrt(2 * digit / np.abs(column).max())) / (2 * np.pi * frequency * record.step)
        if np.count_nonzero(ends) > max(flat, FEWEST):
            raise DataError(
                f"ring_down: {counted(int(ends.sum()), 'sample')} of {name!r} are clipped at "
                f"{np.abs(column[ends]).max():.4g}, the first at {record.times[np.argmax(ends)]:.6g} s. Hit more "
                "softly, take a larger range, or give the part after the last clipped sample, by Measurements.between"
            )
    record = record.thinned(frequency)
    signal = analytic_signal(record, frequency)
    # Deviations in proportion to the motion, as nothing is known of the noise yet.
    sensors = Sensors(record.orders, 1e-3 * np.sqrt(np.mean(record.values**2, axis=0)) + np.finfo(float).tiny)
    decay = FreeDecay(record, signal.rates(frequency), sensors, signal).ended()
    decay = with_other_modes(decay.with_noise())
    if expected is not None:
        # A stronger mode in the band of the filter may be the first so far.
        decay = decay.beginning_with(expected)
    return decay if start is not None else decay.begun()
