"""Measurements through a low-pass filter without delay."""

from dataclasses import replace

import numpy as np

from dalembert.arguments import is_real, is_whole
from dalembert.data.measurements import TURN, Measurements
from dalembert.data.stretches import stretches
from dalembert.errors import DataError

ORDER = 4  # of the Butterworth filter, which runs forward and back
_EVEN = 0.05  # of the distance of samples: how far one of them may differ
_GAP = 1.5  # distances of samples from which one is a gap


def filtered(data: Measurements, cutoff: float) -> Measurements:
    """Measurements without what is faster than a cutoff frequency (Hz); see `Measurements.filtered`."""
    along = data.coordinate
    if along.unit != "s":
        raise DataError(f"the samples lie along the {along.name} in {along.unit}; a low-pass filter needs times")
    if not is_real(cutoff) or not 0 < cutoff < np.inf:
        raise DataError(f"the cutoff frequency is {cutoff} Hz; expected a positive number")
    step, joined = _spacing(along.values)
    rate = 1.0 / step
    if cutoff >= rate / 2:
        raise DataError(
            f"the cutoff frequency is {cutoff:g} Hz and the sampling rate {rate:.6g} Hz; expected less than half of it"
        )
    sections = _sections(cutoff, rate)
    values = np.column_stack(
        [
            _channel(column, there, joined, sections, int(np.ceil(rate / cutoff)))
            for column, there in zip(data.continuous.T, data.present.T, strict=True)
        ]
    )
    if not np.any(np.isfinite(values), axis=0).all():
        raise DataError(
            f"no stretch of samples is as long as the period of the cutoff frequency, {1 / cutoff:.3g} s; expected a "
            "higher cutoff, or fewer gaps"
        )
    turned = (values + TURN / 2) % TURN - TURN / 2
    deviations = (
        None if data.deviations is None else data.deviations * _noise_gain(sections, int(np.ceil(rate / cutoff)))
    )
    missing = "leave-out" if np.any(np.isnan(values) & data.present) else data.missing
    return replace(data, values=np.where(data.wrapping, turned, values), deviations=deviations, missing=missing)


def decimated(data: Measurements, factor: int, cutoff: float | None) -> Measurements:
    """Every ``factor``-th sample of filtered measurements; see `Measurements.decimated`."""
    if not is_whole(factor) or factor < 1:
        raise DataError(f"every {factor}-th sample; expected a whole number of at least 1")
    rate = 1.0 / _spacing(data.coordinate.values)[0] / factor
    if cutoff is not None and cutoff > rate / 2:
        raise DataError(
            f"the cutoff frequency is {cutoff:g} Hz and every {factor}-th sample a rate of {rate:.6g} Hz; expected a "
            "cutoff of at most half the rate, since what is faster would appear as a slow motion"
        )
    if factor == 1 and cutoff is None:
        return data
    return filtered(data, 0.4 * rate if cutoff is None else cutoff).every(factor)


def _spacing(times: np.ndarray) -> tuple[float, np.ndarray]:
    """Distance of the samples, s, and whether each sample follows the one before it without a gap."""
    apart = np.diff(times)
    if len(apart) < 1:
        raise DataError("there is one sample; a low-pass filter needs several")
    step = float(np.median(apart))
    close = apart < _GAP * step
    uneven = close & (np.abs(apart - step) > _EVEN * step)
    if np.any(uneven):
        at = int(np.argmax(uneven))
        raise DataError(
            f"the samples are not evenly spaced: mostly {step:.6g} s, and {apart[at]:.6g} s behind {times[at]:.10g} s; "
            "a low-pass filter needs even ones; resample the data first"
        )
    step = float(np.mean(apart[close]))
    return step, np.concatenate([[False], close])


def _sections(cutoff: float, rate: float) -> np.ndarray:
    """Second-order sections of a Butterworth filter that has half of a component at the cutoff after both runs."""
    from scipy.signal import butter

    return np.asarray(butter(ORDER, cutoff, fs=rate, output="sos"))


def _channel(
    values: np.ndarray, present: np.ndarray, joined: np.ndarray, sections: np.ndarray, period: int
) -> np.ndarray:
    """A channel filtered between its gaps; stretches shorter than a period of the cutoff are missing."""
    from scipy.signal import sosfiltfilt

    result = np.full(len(values), np.nan)
    for run in stretches(present):
        starts = run.start + np.flatnonzero(~joined[run.start + 1 : run.stop]) + 1
        for begin, end in zip([run.start, *starts], [*starts, run.stop], strict=True):
            if end - begin > period:
                result[begin:end] = sosfiltfilt(sections, values[begin:end], padlen=min(3 * period, end - begin - 1))
    return result


def _noise_gain(sections: np.ndarray, period: int) -> float:
    """Share of the standard deviation of white noise that passes: the root of the sum of the squared answer."""
    from scipy.signal import sosfiltfilt

    impulse = np.zeros(40 * period + 1)
    impulse[20 * period] = 1.0
    return float(np.sqrt(np.sum(sosfiltfilt(sections, impulse, padlen=0) ** 2)))
