r"""Instantaneous frequency and decay rate by a band-pass filter and the Hilbert transform.

Both are one filter with complex coefficients, :math:`h(t) = 2 g(t) e^{i\omega_0 t}` with the low-pass filter g: its
output is the analytic signal z of the band about :math:`\omega_0`. A decaying oscillation passes it in proportion, so
that :math:`\mathrm{d} \ln z/\mathrm{d}t = -\sigma + i\omega` has no error from the filter where both are constant.
"""

from dataclasses import dataclass

import numpy as np
from scipy.signal import firwin, oaconvolve

from dalembert.errors import DataError
from dalembert.inverse.decays.decay_record import DecayRecord
from dalembert.inverse.decays.record_windows import Rates
from dalembert.inverse.decays.sensors import Phasors

HALF_BAND = 0.5
"""Half of the width of the band, as part of the frequency of the mode."""
HALF_LENGTH = 3.0
"""Half of the length of the filter, in periods of the mode."""


@dataclass(frozen=True)
class AnalyticSignal:
    """Logarithm of the analytic signal of each channel's displacement, (samples, channels), at times (samples,)."""

    times: np.ndarray
    logarithms: Phasors

    def slopes(self, middles: np.ndarray, halves: np.ndarray, degree: int, noise: np.ndarray) -> Phasors:
        """−σ + iω at times (points,), 1/s, by polynomials over windows of given half-lengths; NaN at the ends.

        ``noise`` (channels,): deviations by which the channels are weighted.
        """
        slopes = np.full(len(middles), complex(np.nan, np.nan))
        for point, (middle, half) in enumerate(zip(middles, halves, strict=True)):
            rows = np.abs(self.times - middle) <= half
            if self.times[0] > middle - half or self.times[-1] < middle + half:
                continue
            places = (self.times[rows] - middle) / half
            powers = places[:, None] ** np.arange(degree + 1)
            logs = self.logarithms[rows]
            # The error of ln z is that of z over its size: weights are its inverse square.
            sizes = np.exp(logs.real) / noise
            total, sum_of_weights = 0j, 0.0
            for channel in range(logs.shape[1]):
                weight = sizes[:, channel, None]
                numbers = np.linalg.lstsq(weight * powers, weight[:, 0] * logs[:, channel], rcond=None)[0]
                strength = float(np.sum(weight**2))
                total, sum_of_weights = total + strength * numbers[1] / half, sum_of_weights + strength
            slopes[point] = total / sum_of_weights
        return slopes

    def rates(self, frequency: float) -> Rates:
        """Rates over time of a mode near a frequency, Hz, from windows of four periods.

        Raises
        ------
        DataError
            Where the filter leaves no such window.
        """
        half = 2 / frequency
        middles = np.arange(self.times[0] + half, self.times[-1] - half, half / 4)
        if len(middles) < 2:
            raise DataError("ring_down: the free decay is too short for a band-pass filter. Record for longer")
        slopes = self.slopes(middles, np.full(len(middles), 0.999 * half), 2, np.ones(self.logarithms.shape[1]))
        return Rates(middles, slopes[None])


def analytic_signal(record: DecayRecord, frequency: float, half_band: float = HALF_BAND) -> AnalyticSignal:
    """The analytic signal of the band about a frequency, Hz, where the filter lies within the record."""
    reach = int(np.ceil(HALF_LENGTH * HALF_BAND / half_band / (frequency * record.step)))
    low_pass = np.asarray(firwin(2 * reach + 1, half_band * frequency, fs=1 / record.step, window="blackman"))
    taps = 2 * low_pass * np.exp(2j * np.pi * frequency * record.step * np.arange(-reach, reach + 1))
    if len(taps) > len(record.values):
        return AnalyticSignal(np.full(1, np.nan), np.full((1, len(record.orders)), complex(np.nan, np.nan)))
    filtered = oaconvolve(record.values, taps[:, None], mode="valid", axes=0)
    times = record.times[reach : len(record.values) - reach]
    logs = np.log(np.maximum(np.abs(filtered), np.finfo(float).tiny)) + 1j * np.unwrap(np.angle(filtered), axis=0)
    for channel, order in enumerate(record.orders):
        if order:
            # A velocity is the displacement times -σ + iω, an acceleration that once more.
            # The rate is averaged over a quarter of the filter to each side.
            half = max(reach // 2, 1)
            kernel = np.hanning(2 * half + 3)[1:-1]
            rates = np.pad(np.gradient(logs[:, channel], record.step), half, mode="edge")
            logs[:, channel] -= order * np.log(np.convolve(rates, kernel / kernel.sum(), mode="valid"))
    return AnalyticSignal(times, logs)
