"""Lines in the residuals of windows: other modes, and harmonics that are not fitted."""

from typing import NamedTuple

import numpy as np

from dalembert.inverse.decays.free_decay import FreeDecay
from dalembert.inverse.decays.record_windows import WindowEstimates

APART = 2.0
"""Lines of a window by which another mode must be apart from the frequencies that the first one has."""
STRONG = 50.0
"""Power of a line of the residuals, over the median one, from which it belongs to another mode."""
VISIBLE = 3e-3
"""Amplitude of another mode, as part of that of the first, from which it is fitted with it."""
PROMINENT, AROUND = 10.0, 16
"""Power of a line over the median of its neighbours, and how many of them to each side."""


class Line(NamedTuple):
    """A line in the residuals, Hz; ``harmonic``: the number of that of the first mode which it is, or 0."""

    frequency: float
    harmonic: int


def strongest_line(fits: WindowEstimates, decay: FreeDecay, periods: float) -> Line | None:
    """The strongest line that is neither fitted nor what the polynomials of the first mode leave."""
    count = 2 * max(len(fit.residuals) for fit in fits.fits)
    frequencies = np.fft.rfftfreq(count, decay.record.step)
    beside = APART * decay.frequency / periods
    others = decay.rates.slopes[1:, 0].imag / (2 * np.pi)
    best, strongest = None, 0.0
    for fit in fits.fits:
        taper = np.hanning(len(fit.residuals))[:, None]
        lines = np.abs(np.fft.rfft(taper * fit.residuals / decay.sensors.deviations, count, axis=0)) ** 2
        power = lines.sum(axis=1)
        # The first mode visits these frequencies within the window, and its harmonics their multiples.
        visited = np.array([fit.slope(place).imag for place in np.linspace(-1, 1, 9)]) / (2 * np.pi)
        low, high = visited.min(), visited.max()
        far = frequencies > beside
        for number in (1, *decay.harmonics):
            far &= (frequencies < number * low - beside) | (frequencies > number * high + beside)
        for other in others:
            far &= np.abs(frequencies - other) > beside
        if not far.any():
            continue
        place = int(np.flatnonzero(far)[np.argmax(power[far])])
        around = power[max(place - AROUND, 0) : place + AROUND + 1]
        is_line = power[place] > STRONG * np.median(power[far]) and power[place] > PROMINENT * np.median(around)
        # A tapered line of amplitude A has the power (A n/4)².
        relative = 4 * np.sqrt(power[place]) / len(fit.residuals)
        size = np.sqrt(np.sum(2 * np.mean(fit.window.values**2, axis=0) / decay.sensors.deviations**2))
        if is_line and relative > VISIBLE * size and power[place] > strongest:
            frequency, strongest = float(frequencies[place]), float(power[place])
            multiple = round(frequency / float(np.median(visited)))
            close = beside / (2 * APART)
            is_harmonic = multiple > 1 and multiple * low - close < frequency < multiple * high + close
            best = Line(frequency, multiple if is_harmonic else 0)
    return best
