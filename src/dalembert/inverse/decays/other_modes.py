"""Other modes that vibrate in a decay: lines in the residuals of windows; longer windows separate closer modes."""

from dataclasses import replace

import numpy as np

from dalembert.inverse.decays.band_pass import HALF_BAND
from dalembert.inverse.decays.free_decay import FreeDecay
from dalembert.inverse.decays.residual_lines import APART, strongest_line

LOOKS = (8.0, 16.0, 32.0, 64.0)
"""Periods of windows whose residuals show other modes: longer ones separate closer modes."""
FAINT = 3.0
"""Amplitude in deviations below which another mode is no longer fitted."""
LIGHT = 0.005
"""Damping ratio from which other modes are fitted."""
MOST_MODES = 6


def with_other_modes(decay: FreeDecay) -> FreeDecay:
    """With modes, and harmonics of the first, that residuals of windows show one after the other."""
    for periods in LOOKS:
        while periods <= decay.periods / 2 and len(decay.rates.slopes) <= MOST_MODES:
            fits = decay.windows(periods, 4)
            line = strongest_line(fits, decay, periods) if len(fits) else None
            if line is None:
                break
            if line.harmonic:
                decay = replace(decay, harmonics=(*decay.harmonics, line.harmonic))
            elif (better := with_mode(decay, line.frequency, periods)) is not None:
                decay = better
            else:
                break
            decay = with_ends(decay.with_noise())
    return with_ends(decay) if len(decay.rates.slopes) > 1 else decay


def with_mode(decay: FreeDecay, line: float, periods: float) -> FreeDecay | None:
    """With a mode at the frequency of a line, Hz; None where none that decays fits."""
    guess = replace(decay, rates=decay.rates.with_mode(2 * np.pi * line * (1j - LIGHT), np.inf))
    fits, last = guess.windows(periods, 2), len(guess.rates.slopes) - 1
    beside = APART * decay.frequency / periods
    others = decay.rates.slopes[1:, 0].imag / (2 * np.pi)
    near = []
    for window, row in fits.with_mode(last):
        slope = fits.fits[window].slope(0.0, row)
        frequency = slope.imag / (2 * np.pi)
        if slope.real < 0 and abs(frequency - line) < beside and np.all(np.abs(others - frequency) > beside / 2):
            near.append((window, row))
    if not near:
        return None
    best, row = min(near, key=lambda place: fits.fits[place[0]].misfit_over(place[1]))
    rates, windows = decay.rates, [window for window, _ in near]
    if len(near) > 1 and abs(line / decay.frequency - 1) < HALF_BAND:
        # Within the band of the filter the beat of both modes is in the rates: windows that separate them have none.
        rates = rates.with_first(fits.middles[windows], np.array([fits.fits[window].slope(0.0) for window in windows]))
    return replace(decay, rates=rates.with_mode(fits.fits[best].slope(0.0, row), np.inf))


def with_ends(decay: FreeDecay) -> FreeDecay:
    """With the times at which other modes fall below the noise, by their amplitudes in the first windows."""
    fits = decay.windows(max(LOOKS[0], decay.shortest), 2)
    orders, ends = np.array(decay.record.orders), [np.inf]
    for mode, slope in enumerate(decay.rates.slopes[1:, 0], 1):
        ends.append(np.inf)
        for window, row in fits.with_mode(mode)[:1]:
            fit = fits.fits[window]
            # A wave of n samples has the deviation √(2/n).
            sizes = np.abs(fit.amplitudes[row]) * np.abs(slope) ** orders / decay.sensors.deviations
            signal = float(np.max(sizes)) * np.sqrt(len(fit.residuals) / 2)
            duration = np.log(max(signal / FAINT, 1.0)) / max(-slope.real, 1e-12)
            ends[-1] = float(fits.middles[window]) + duration
    return replace(decay, rates=replace(decay.rates, ends=tuple(ends)))
