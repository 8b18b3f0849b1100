"""Measurements through a low-pass filter without delay."""

from dataclasses import replace

import numpy as np

from dalembert.arguments import is_integer, is_real
from dalembert.data.record import TURN, Record, Recorded
from dalembert.data.stretches import gaps, stretches
from dalembert.errors import DataError

ORDER = 4  # of the Butterworth filter, which runs forward and back
_EVEN = 0.05  # of the distance of samples: how far one of them may differ


def filtered(data: Recorded, cutoff: float) -> Recorded:
    """Measurements without what is faster than a cutoff frequency (Hz); see `Measurements.filtered`."""
    from scipy.signal import butter, sosfiltfilt

    along = _times(data)
    if not is_real(cutoff) or not 0 < cutoff < np.inf:
        raise DataError(f"the cutoff frequency is {cutoff} Hz; expected a positive number")
    values, gains = np.full(data.values.shape, np.nan), np.ones(len(data.channels))
    for column, (present, known) in enumerate(zip(data.present.T, data.continuous.T, strict=True)):
        rate = 1.0 / _spacing(along[present])
        if cutoff >= rate / 2:
            raise DataError(
                f"the cutoff frequency is {cutoff:g} Hz and the sampling rate {rate:.6g} Hz; expected less than half "
                "of it"
            )
        period = int(np.ceil(rate / cutoff))
        sections = np.asarray(butter(ORDER, cutoff, fs=rate, output="sos"))
        values[present, column] = _between_gaps(along[present], known[present], sections, period)
        # Share of the standard deviation of white noise that passes: the root of the sum of the squared answer.
        impulse = np.zeros(40 * period + 1)
        impulse[20 * period] = 1.0
        gains[column] = float(np.sqrt(np.sum(sosfiltfilt(sections, impulse, padlen=0) ** 2)))
    if not np.any(np.isfinite(values), axis=0).all():
        raise DataError(
            f"no stretch of samples is as long as the period of the cutoff frequency, {1 / cutoff:.3g} s; expected a "
            "higher cutoff, or fewer gaps"
        )
    turned = (values + TURN / 2) % TURN - TURN / 2
    deviations = None if data.deviations is None else data.deviations * gains
    missing = "leave-out" if np.any(np.isnan(values) & data.present) else data.missing
    return replace(data, values=np.where(data.wrapping, turned, values), deviations=deviations, missing=missing)


def decimated(data: Recorded, factor: int, cutoff: float | None) -> Recorded:
    """Every ``factor``-th sample of filtered measurements; see `Measurements.decimated`."""
    along = _times(data)
    if not is_integer(factor) or factor < 1:
        raise DataError(f"every {factor}-th sample; expected a whole number of at least 1")
    if factor == 1 and cutoff is None:
        return data
    steps = [_spacing(along[present]) for present in data.present.T]
    rate = min(1.0 / step for step in steps) / factor
    if cutoff is not None and cutoff > rate / 2:
        raise DataError(
            f"the cutoff frequency is {cutoff:g} Hz and every {factor}-th sample a rate of {rate:.6g} Hz; expected a "
            "cutoff of at most half the rate, since what is faster would appear as a slow motion"
        )
    slow = filtered(data, 0.4 * rate if cutoff is None else cutoff)
    kept = np.column_stack(
        [_numbers(along, present, step) % factor == 0 for present, step in zip(data.present.T, steps, strict=True)]
    )
    rows = np.any(kept, axis=1)
    values = np.where(kept, slow.values, np.nan)[rows]
    sampled = None if slow.sampled is None else kept[rows]
    return replace(slow, coordinate=replace(slow.coordinate, values=along[rows]), values=values, sampled=sampled)


def is_even(data: Record) -> bool:
    """Return whether the samples of each channel are evenly spaced between gaps, as filters need them."""
    try:
        for present in data.present.T:
            _spacing(data.coordinate.values[present])
    except DataError:
        return False
    return True


def _times(data: Record) -> np.ndarray:
    along = data.coordinate
    if along.unit != "s":
        raise DataError(f"the samples lie along the {along.name} in {along.unit}; a low-pass filter needs times")
    return along.values


def _numbers(along: np.ndarray, present: np.ndarray, step: float) -> np.ndarray:
    """Number of each sample of a channel on its even grid, gaps counted, (samples,); -1 where it has none."""
    places = along[present]
    numbers = np.full(len(along), -1)
    numbers[present] = np.rint((places[0] - along[0]) / step) + np.rint((places - places[0]) / step)
    return numbers


def _spacing(times: np.ndarray) -> float:
    """Distance of even samples, s, between gaps."""
    apart = np.diff(times)
    if len(apart) < 1:
        raise DataError("there is one sample; a low-pass filter needs several")
    close = np.delete(np.arange(len(apart)), gaps(times))
    step = float(np.median(apart[close]))
    uneven = close[np.abs(apart[close] - step) > _EVEN * step]
    if len(uneven):
        at = int(uneven[0])
        raise DataError(
            f"the samples are not evenly spaced: mostly {step:.6g} s, and {apart[at]:.6g} s behind {times[at]:.10g} s; "
            "a low-pass filter needs even ones; resample the data first"
        )
    return float(np.mean(apart[close]))


def _between_gaps(times: np.ndarray, values: np.ndarray, sections: np.ndarray, period: int) -> np.ndarray:
    """A channel filtered between its gaps; stretches shorter than a period of the cutoff are missing."""
    from scipy.signal import sosfiltfilt

    result = np.full(len(values), np.nan)
    for run in stretches(np.ones(len(values), dtype=bool), times):
        length = run.stop - run.start
        if length > period:
            result[run] = sosfiltfilt(sections, values[run], padlen=min(3 * period, length - 1))
    return result
