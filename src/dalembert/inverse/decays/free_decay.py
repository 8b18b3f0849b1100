"""Where the free decay of a mode begins and ends in a record, and which other modes vibrate with it."""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from dalembert.errors import DataError, InputError
from dalembert.inverse.decays.band_pass import HALF_BAND, AnalyticSignal, analytic_signal
from dalembert.inverse.decays.decay_record import LEAST, PERIODS, DecayRecord
from dalembert.inverse.decays.record_windows import Place, Rates, WindowEstimates, estimate, even_places, half_length
from dalembert.inverse.decays.window_fit import HARMONICS, Sensors, WindowFit

SHORT = (4.0, 4)
"""Periods and degree of windows of the first look at a record."""
LOOKS = (8.0, 16.0, 32.0, 64.0)
"""Periods of windows whose residuals show other modes: longer ones separate closer modes."""
APART = 2.0
"""Lines of a window by which another mode must be apart from the frequencies that the first one has."""
NEAR = 0.2
"""Relative distance from an expected frequency within which the mode is looked for."""
STARTS = 24
"""Half periods behind the largest amplitude within which the free decay begins."""
CLEAN = 5e-3
"""Residual of a window, as part of the amplitude, that is no sign of the hammer's contact or of other modes."""
END = 3.0
"""Amplitude in deviations of the noise of the band at which a decay ends."""
STRONG = 50.0
"""Power of a line of the residuals, over the median one, from which it belongs to another mode."""
VISIBLE = 3e-3
"""Amplitude of another mode, as part of that of the first, from which it is fitted with it."""
SEPARATE = 1.5
"""Periods of the beat of two modes that a window must have."""
FAINT = 3.0
"""Amplitude in deviations below which another mode is no longer fitted."""
PROMINENT, AROUND = 10.0, 16
"""Power of a line over the median of its neighbours, and how many of them to each side."""
LIGHT = 0.005
"""Damping ratio from which other modes are fitted."""
MOST_MODES = 6


@dataclass(frozen=True)
class FreeDecay:
    """A free decay with what a first look at it says.

    ``rates``: of all modes; ``sensors``: with the deviations of the noise; ``signal``: of the first mode's band;
    ``harmonics`` of the first mode that show; ``clean``: whether the first window fits like the others.
    """

    record: DecayRecord
    rates: Rates
    sensors: Sensors
    signal: AnalyticSignal
    harmonics: tuple[int, ...] = HARMONICS
    clean: bool = True

    @property
    def frequency(self) -> float:
        """Mean frequency of the first mode, Hz."""
        return float(np.median(self.rates.slopes[0].imag)) / (2 * np.pi)

    @property
    def shortest(self) -> float:
        """Least length of a window, in periods, that separates the modes."""
        others = self.rates.slopes[1:, 0].imag / (2 * np.pi)
        return max([SEPARATE * self.frequency / abs(other - self.frequency) for other in others], default=0.0)

    @property
    def periods(self) -> float:
        """Length of the decay in periods."""
        return self.record.duration * self.frequency


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


def free_decay(record: DecayRecord, frequency: float, start: float | None) -> FreeDecay:
    """Look at a record: noise, begin, end, other modes.

    Raises
    ------
    DataError
        For a record that is too short, or does not decay.
    """
    record = record.thinned(frequency)
    if start is None:
        record = record.between(_largest(record, frequency), record.times[-1])
    else:
        record = record.between(start, record.times[-1])
    _require_long(record, frequency)
    signal = analytic_signal(record, frequency)
    rates = _band_rates(signal, frequency)
    decay = FreeDecay(record, rates, _first_sensors(record), signal)
    decay = _ended(decay)
    decay = _with_other_modes(_with_noise(decay))
    return decay if start is not None else _begun(decay)


def _require_long(record: DecayRecord, frequency: float) -> None:
    periods = record.duration * frequency
    if periods < PERIODS:
        raise DataError(
            f"ring_down: the free decay lasts {record.duration:.3g} s, {periods:.2g} periods of {frequency:.6g} Hz; "
            f"expected at least {PERIODS}. Record for longer, or look whether the frequency is that of the mode"
        )


def _largest(record: DecayRecord, frequency: float) -> float:
    """Time at which the amplitude is largest, by the mean square over a period."""
    length = max(int(1 / (frequency * record.step)), 1)
    squares = np.sum((record.values / np.sqrt(np.mean(record.values**2, axis=0))) ** 2, axis=1)
    means = np.convolve(squares, np.ones(length) / length, mode="valid")
    # The window of a period begins where the motion is free, not where it grows.
    return float(record.times[int(np.argmax(means))])


def _band_rates(signal: AnalyticSignal, frequency: float) -> Rates:
    """Rates of the first mode from its analytic signal."""
    half = 2 / frequency
    middles = np.arange(signal.times[0] + half, signal.times[-1] - half, half / 4)
    if len(middles) < 2:
        raise DataError("ring_down: the free decay is too short for a band-pass filter. Record for longer")
    slopes = signal.slopes(middles, np.full(len(middles), 0.999 * half), 2, np.ones(signal.logarithms.shape[1]))
    return Rates(middles, slopes[None])


def _first_sensors(record: DecayRecord) -> Sensors:
    """Deviations in proportion to the motion, as nothing is known yet."""
    return Sensors(record.orders, 1e-3 * np.sqrt(np.mean(record.values**2, axis=0)) + np.finfo(float).tiny)


def _ended(decay: FreeDecay) -> FreeDecay:
    """The decay to where its amplitude leaves the noise of the band."""
    signal, record = decay.signal, decay.record
    sizes = np.exp(signal.logarithms.real).sum(axis=1)
    # The level to which the amplitude falls at last: the noise of the band, or the end of the decay itself.
    tail = sizes[-max(len(sizes) // 10, 1) :]
    noise = float(np.sqrt(np.mean(tail**2)))
    above = np.flatnonzero(sizes > END * noise)
    if not len(above) or noise > sizes[0] / (END * END):
        return decay
    end = float(signal.times[above[-1]]) if above[-1] < len(sizes) - 1 else float(record.times[-1])
    if end - record.start < PERIODS / decay.frequency:
        return decay
    times = decay.rates.times
    return replace(
        decay,
        record=record.between(record.start, end),
        rates=replace(decay.rates, times=times[times <= end], slopes=decay.rates.slopes[:, times <= end]),
    )


def _with_noise(decay: FreeDecay) -> FreeDecay:
    """With the deviations of the noise, from the residuals of short windows."""
    for _ in range(2):
        fits = _windows(decay, max(SHORT[0], decay.shortest), SHORT[1])
        if not len(fits):
            raise DataError("ring_down: no decaying oscillation fits the record. Look whether the frequency is right")
        squares = np.array([np.sum(fit.residuals**2, axis=0) / _freedom(fit) for fit in fits.fits])
        # The lower quartile: modes that decay faster leave residuals in the first windows.
        levels = np.sqrt(np.quantile(squares, 0.25, axis=0))
        floor = 1e-9 * np.sqrt(np.mean(decay.record.values**2, axis=0)) + np.finfo(float).tiny
        decay = replace(decay, sensors=Sensors(decay.record.orders, np.maximum(levels, floor)))
    return decay


def _windows(decay: FreeDecay, periods: float, degree: int) -> WindowEstimates:
    """Windows of a number of periods, half of each in the next."""
    places = even_places(decay.record, decay.rates, periods, degree, 0.5)
    return estimate(decay.record, places, decay.rates, decay.sensors, decay.harmonics)


def _freedom(fit: WindowFit) -> float:
    """Samples of a window less the numbers that are fitted to each channel."""
    linear = next(iter(fit.bases.values())).shape[1]
    samples, channels = fit.residuals.shape
    return max(samples - linear - len(fit.gains) / channels, 1.0)


def _begun(decay: FreeDecay) -> FreeDecay:
    """The decay from where windows fit: behind the contact of the hammer, and modes that die out soon."""
    record, half_period = decay.record, 0.5 / decay.frequency
    ratios = []
    for number in range(STARTS):
        begin = record.start + number * half_period
        half = half_length(decay.rates, begin, max(SHORT[0], decay.shortest))
        place = Place(begin + half, half, SHORT[1])
        fits = estimate(record, [place], decay.rates, decay.sensors, decay.harmonics)
        ratios.append(_misfit(fits, decay.sensors) if len(fits) else np.inf)
        if ratios[-1] <= 2.0:
            break
    number = int(np.argmin(ratios))
    begin = record.start + number * half_period
    return replace(decay, record=record.between(begin, record.times[-1]), clean=ratios[number] <= 2.0)


def _misfit(fits: WindowEstimates, sensors: Sensors) -> float:
    """Mean square residual of the first window over that of the noise and of a small part of the amplitude."""
    fit = fits.fits[0]
    sizes = np.sqrt(2 * np.mean(fit.window.values**2, axis=0))
    squares = np.sum(fit.residuals**2, axis=0) / _freedom(fit)
    return float(np.max(squares / (sensors.deviations**2 + (CLEAN * sizes) ** 2)))


def _with_other_modes(decay: FreeDecay) -> FreeDecay:
    """With modes, and harmonics of the first, that residuals of windows show one after the other."""
    for periods in LOOKS:
        while periods <= decay.periods / 2 and len(decay.rates.slopes) <= MOST_MODES:
            fits = _windows(decay, periods, 4)
            line = _strongest_line(fits, decay, periods) if len(fits) else None
            if line is None:
                break
            if line.harmonic:
                decay = replace(decay, harmonics=(*decay.harmonics, line.harmonic))
            elif (better := _with_mode(decay, line.frequency, periods)) is not None:
                decay = better
            else:
                break
            decay = _with_noise(decay)
    return decay


def _with_mode(decay: FreeDecay, line: float, periods: float) -> FreeDecay | None:
    """With a mode at the frequency of a line, Hz; None where none fits."""
    guess = replace(decay, rates=decay.rates.with_mode(2 * np.pi * line * (1j - LIGHT), np.inf))
    fits = _windows(guess, periods, 2)
    last = len(guess.rates.slopes) - 1
    near = [
        place
        for place, fit in enumerate(fits.fits)
        if len(fit.exponents) == last + 1
        and abs(fit.slope(0.0, last).imag / (2 * np.pi) - line) < APART * decay.frequency / periods
    ]
    if not near:
        return None
    strongest = min(near, key=lambda place: _misfit_over(fits.fits[place], last))
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


def _misfit_over(fit: WindowFit, mode: int) -> float:
    """Squares of the residuals over those of the amplitude of a mode."""
    return float(np.sum(fit.residuals**2) / np.sum(np.abs(fit.amplitudes[mode]) ** 2))


class _Line(NamedTuple):
    """A line in the residuals, Hz; ``harmonic``: the number of that of the first mode which it is, or 0."""

    frequency: float
    harmonic: int


def _strongest_line(fits: WindowEstimates, decay: FreeDecay, periods: float) -> _Line | None:
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
            is_harmonic = multiple > 1 and multiple * low - beside < frequency < multiple * high + beside
            best = _Line(frequency, multiple if is_harmonic else 0)
    return best
