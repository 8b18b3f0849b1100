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
            decay = decay.with_noise()
    return decay


def with_mode(decay: FreeDecay, line: float, periods: float) -> FreeDecay | None:
    """With a mode at the frequency of a line, Hz; None where none fits."""
    guess = replace(decay, rates=decay.rates.with_mode(2 * np.pi * line * (1j - LIGHT), np.inf))
    fits = guess.windows(periods, 2)
    last = len(guess.rates.slopes) - 1
    near = [
        place
        for place, fit in enumerate(fits.fits)
        if len(fit.exponents) == last + 1
        and abs(fit.slope(0.0, last).imag / (2 * np.pi) - line) < APART * decay.frequency / periods
    ]
    if not near:
        return None
    strongest = min(near, key=lambda place: fits.fits[place].misfit_over(last))
    fit = fits.fits[strongest]
    slope, rates = fit.slope(0.0, last), decay.rates
    if len(near) > 1 and abs(line / decay.frequency - 1) < HALF_BAND:
        # Within the band of the filter the beat of both modes is in the rates: windows that separate them have none.
        rates = rates.with_first(fits.middles[near], np.array([fits.fits[place].slope(0.0) for place in near]))
    # It ends where its amplitude comes to that of the noise in a window: a wave of n samples has the deviation √(2/n).
    sizes = np.abs(fit.amplitudes[last]) * np.abs(slope) ** np.array(decay.record.orders)
    signal = float(np.max(sizes / decay.sensors.deviations)) * np.sqrt(len(fit.residuals) / 2)
    duration = np.log(max(signal / FAINT, 1.0)) / max(-slope.real, 1e-12)
    return replace(decay, rates=rates.with_mode(slope, fits.middles[strongest] + duration))
