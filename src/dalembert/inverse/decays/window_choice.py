r"""Which windows suit a decay: as long as the noise asks for, as short as the change of the mode within them allows.

The equivalent law (:mod:`dalembert.inverse.decays.equivalent_law`) of first estimates gives a decay without noise,
whose rates are known at all times. Windows of each length and degree on it show their bias, and their variance follows
from the noise. At each place the window of least variance is taken whose bias is small against it.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from dalembert.errors import DataError
from dalembert.inverse.decays.decay_record import DecayRecord
from dalembert.inverse.decays.equivalent_law import EquivalentLaw
from dalembert.inverse.decays.free_decay import FreeDecay
from dalembert.inverse.decays.record_windows import (
    OVERLAP,
    Place,
    Rates,
    WindowEstimates,
    estimate,
    even_places,
    half_length,
)
from dalembert.inverse.decays.sensors import Phasors

DEGREES = (2, 4)
"""Degrees of the polynomials of phase and logarithm of the amplitude that are tried."""
LENGTHS = (3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128)
"""Lengths of windows that are tried, in periods of the mode."""
BIAS = 0.05
"""Square of the bias over the variance up to which a window counts as unbiased: intervals of 95 % cover 94 %."""
HOPELESS = 1e3
"""Square of the bias over the variance from which longer windows are not tried."""
FINE = 8
"""Steps of a period in which the rates of the law are followed."""


@dataclass(frozen=True)
class Option:
    """Windows of a length and degree: beginnings (windows,), and squares of their bias and variances, (rad/s)²."""

    periods: float
    degree: int
    begins: np.ndarray
    bias: np.ndarray
    variance: np.ndarray

    def at(self, begin: float) -> tuple[float, float]:
        """Square of the bias and variance of the window that begins at a time."""
        bias, variance = (np.log(np.maximum(part, 1e-300)) for part in (self.bias, self.variance))
        return (
            float(np.exp(np.interp(begin, self.begins, bias))),
            float(np.exp(np.interp(begin, self.begins, variance))),
        )


@dataclass(frozen=True)
class Suited:
    """Estimates in suited windows, and the root mean square of the bias of −σ and ω of each, 1/s."""

    estimates: WindowEstimates
    bias: np.ndarray


def suited_windows(decay: FreeDecay, law: EquivalentLaw, first: WindowEstimates) -> Suited:
    """Estimates of a decay in the windows that suit its noise, with the law and the estimates of a first look."""
    rates = decay.rates.with_first(*law_rates(decay.record, law, first))
    model = law_decay(decay, rates, first)
    options = list(options_of(decay, model, rates, decay.periods / 3))
    if not options:
        raise DataError(
            f"ring_down: the mode at {decay.frequency:.6g} Hz and one near it do not separate in a record of "
            f"{decay.record.duration:.3g} s. Record for longer, or measure where only one of them moves"
        )
    places, bias = zip(*suited_places(decay.record, rates, options), strict=True)
    estimates = estimate(decay.record, places, rates, decay.sensors, decay.harmonics)
    by_middle = dict(zip([place.middle for place in places], bias, strict=True))
    return Suited(estimates, np.array([by_middle[middle] for middle in estimates.middles]))


def law_rates(record: DecayRecord, law: EquivalentLaw, first: WindowEstimates) -> tuple[np.ndarray, Phasors]:
    """Times, and −σ + iω at them, as the law states them, through the amplitudes of first estimates."""
    # d ln a/dt = -σ(a), in steps of a part of a period, from the middle of the known amplitudes to both ends.
    step = 2 * np.pi / float(np.median(first.slopes.imag)) / FINE
    times = np.arange(record.start, record.times[-1] + step, step)
    place = len(first) // 2
    near = int(np.argmin(np.abs(times - first.times[place])))
    logs = np.empty(len(times))
    logs[near] = np.log(law.amplitudes[place])
    for ahead, way in ((range(near, len(times) - 1), 1), (range(near, 0, -1), -1)):
        for at in ahead:
            # The midpoint rule.
            middle = logs[at] + way * step / 2 * law.slopes_at(logs[at]).real
            logs[at + way] = logs[at] + way * step * law.slopes_at(middle).real
    return times, law.slopes_at(logs)


def law_decay(decay: FreeDecay, rates: Rates, first: WindowEstimates) -> DecayRecord:
    """The record of the law's decay, without noise, at all sensors."""
    record, middle = decay.record, len(first) // 2
    values = np.zeros(record.values.shape)
    for mode, slopes in enumerate(rates.at(record.times)):
        # Other modes by their first window, the first mode by that through which its rates go.
        windows = first.with_mode(mode)
        if not windows:
            continue
        place, row = windows[middle if mode == 0 else 0]
        near = int(np.argmin(np.abs(record.times - first.middles[place])))
        # ln u = ∫ λ dt, by the trapezoidal rule at the samples.
        logs = np.concatenate([[0], np.cumsum((slopes[1:] + slopes[:-1]) / 2 * record.step)])
        wave = np.exp(logs - logs[near])
        change = np.gradient(slopes, record.step)
        seen = {0: wave, 1: slopes * wave, 2: (slopes**2 + change) * wave}
        for channel, order in enumerate(record.orders):
            values[:, channel] += (first.fits[place].amplitudes[row, channel] * seen[order]).real
    return DecayRecord(record.start, record.step, values, record.channels, record.orders)


def options_of(decay: FreeDecay, model: DecayRecord, rates: Rates, longest: float) -> Iterator[Option]:
    for degree in DEGREES:
        lengths = [length for length in LENGTHS if length >= decay.shortest]
        for periods in lengths:
            if periods > max(longest, lengths[0]):
                break
            places = list(even_places(model, rates, periods, degree, 0.5))
            fitted = estimate(model, places, rates, decay.sensors, decay.harmonics)
            if not len(fitted):
                continue
            option = Option(
                periods,
                degree,
                begins=fitted.middles - fitted.halves,
                bias=np.abs(fitted.slopes - rates.at(fitted.times)[0]) ** 2,
                variance=fitted.variances(decay.sensors.deviations).sum(axis=1),
            )
            yield option
            if np.all(option.bias > HOPELESS * option.variance):
                break


def suited_places(record: DecayRecord, rates: Rates, options: list[Option]) -> Iterator[tuple[Place, float]]:
    """Yield windows that suit, from the begin of a record to its end, with their bias.

    Shorter ones from the begin of the record come first: they reach the largest amplitudes.
    """
    time, end = record.start, record.start + record.duration
    chosen = _chosen(options, time)
    while half_length(rates, time, chosen.periods) * 2 > record.duration:
        options = [option for option in options if option.periods < chosen.periods]
        chosen = _chosen(options, time)
    for option in options:
        if option.degree == chosen.degree and option.periods < chosen.periods:
            half = half_length(rates, time, option.periods)
            yield Place(time + half, half, option.degree), np.sqrt(option.at(time)[0] / 2)
    while time + 2 * (half := half_length(rates, time, chosen.periods)) <= end:
        yield Place(time + half, half, chosen.degree), np.sqrt(chosen.at(time)[0] / 2)
        time += 2 * half / OVERLAP
        chosen = _chosen(options, time)


def _chosen(options: list[Option], begin: float) -> Option:
    """The option of least variance among those without bias, or else that of the least error."""
    numbers = {id(option): option.at(begin) for option in options}
    unbiased = [option for option in options if numbers[id(option)][0] <= BIAS * numbers[id(option)][1]]
    if unbiased:
        return min(unbiased, key=lambda option: numbers[id(option)][1])
    return min(options, key=lambda option: sum(numbers[id(option)]))
