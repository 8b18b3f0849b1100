"""A free decay at evenly spaced times."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.signal import firwin, oaconvolve

LEAST, MOST = 16, 48
"""Samples of a period: fewer do not show the harmonics, more than the second are thinned."""
PERIODS = 12
"""Periods that a decay needs."""


@dataclass(frozen=True)
class DecayRecord:
    """Free decay at evenly spaced times.

    ``start``: time of the first sample; ``values`` (samples, channels); ``orders`` (channels,): derivatives by time
    that the sensors see; ``units`` of their displacements; ``passed``: deviation of white noise with the power of that
    at the mode, over the deviation before the record was thinned.
    """

    start: float
    step: float
    values: np.ndarray
    channels: tuple[str, ...]
    orders: tuple[int, ...]
    units: tuple[str, ...] = ()
    passed: float = 1.0

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
        factor = int(np.ceil(1 / (self.step * frequency * MOST) - 1e-9))
        if factor < 2:
            return self
        # Half of the new rate is `MOST`/2 periods: the filter is flat over the mode and its harmonics.
        taps = np.asarray(firwin(16 * factor + 1, 0.8 / factor, window="blackman"))
        phases = 2 * np.pi * frequency * self.step * (np.arange(len(taps)) - len(taps) // 2)
        gain = float(taps @ np.cos(phases))
        slow = oaconvolve(self.values, taps[:, None], mode="valid", axes=0)[::factor]
        return replace(
            self,
            start=self.start + 8 * factor * self.step,
            step=factor * self.step,
            # The gain of the filter at the mode; its noise has the same density at fewer samples.
            values=slow / gain,
            passed=self.passed / np.sqrt(factor),
        )

    def largest(self, frequency: float) -> float:
        """Time at which the amplitude of a mode of a frequency, Hz, is largest, by the mean square over a period."""
        length = max(int(1 / (frequency * self.step)), 1)
        squares = np.sum((self.values / np.sqrt(np.mean(self.values**2, axis=0))) ** 2, axis=1)
        means = np.convolve(squares, np.ones(length) / length, mode="valid")
        # The window of a period begins where the motion is free, not where it grows.
        return float(self.times[int(np.argmax(means))])
