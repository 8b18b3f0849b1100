"""Estimates of a record in the windows that suit its noise."""

from dataclasses import dataclass, replace

import numpy as np

from dalembert.errors import DataError
from dalembert.inverse.decays.band_pass import HALF_BAND, analytic_signal
from dalembert.inverse.decays.equivalent_law import equivalent_law
from dalembert.inverse.decays.free_decay import FreeDecay
from dalembert.inverse.decays.noise_level import noise_at_mode
from dalembert.inverse.decays.record_windows import WindowEstimates, estimate, even_places
from dalembert.inverse.decays.sensors import Phasors
from dalembert.inverse.decays.window_choice import Suited, suited_windows

BESIDE = 1.0
"""Half of the band of the filter, in parts of a window's frequency that separates the modes."""
UNCERTAIN = 0.3
"""Relative deviation of the decay rate from which a window says nothing on the damping."""
BESIDES = 2
"""Neighbours to each side of a window whose median rate says whether its deviation is small."""
LOOK = (6.0, 2)
"""Periods and degree of the windows from which the first law comes."""
ROUNDS = 2
"""Times that windows are chosen, each time by the law of the windows before."""


@dataclass(frozen=True)
class IdentifiedDecay:
    """Estimates of a record with their bias (windows,), 1/s, the noise (channels,), and the covariance (windows, 2,
    windows, 2) of −σ and ω. ``band`` (windows,): −σ + iω by the band-pass filter.
    """

    decay: FreeDecay
    estimates: WindowEstimates
    bias: np.ndarray
    noise: np.ndarray
    covariance: np.ndarray
    band: Phasors

    @property
    def strengths(self) -> np.ndarray:
        """Mean amplitudes of the channels over the deviations of their noise, (channels,)."""
        rates = np.abs(self.estimates.slopes)[:, None] ** np.array(self.decay.record.orders)
        return np.mean(np.abs(self.estimates.amplitudes) * rates, axis=0) / self.noise

    @property
    def other_modes(self) -> np.ndarray:
        """Frequencies, Hz, of the other modes, from the longest window with each."""
        result = []
        for mode, slopes in enumerate(self.decay.rates.slopes[1:], 1):
            windows = self.estimates.with_mode(mode)
            longest = max(windows, key=lambda place: self.estimates.halves[place[0]], default=None)
            slope = slopes[0] if longest is None else self.estimates.fits[longest[0]].slope(0.0, longest[1])
            result.append(slope.imag / (2 * np.pi))
        return np.array(result)

    def amplitude_deviations(self, column: int) -> np.ndarray:
        """Standard deviations of the amplitudes of a channel, about: those of a wave of known frequency in white noise,
        times what the polynomial of the logarithm adds in the middle of a window, 3/2 or 15/8.
        """
        order, estimates = self.decay.record.orders[column], self.estimates
        deviations = []
        for fit, slope, middle, time in zip(
            estimates.fits, estimates.slopes, estimates.middles, estimates.times, strict=True
        ):
            # Energy of the wave over the square of its amplitude at the time of the estimate.
            energy = np.sum(np.exp(2 * slope.real * (fit.window.times - (time - middle)))) / 2
            factor = 1.5 if fit.exponents.shape[1] == 3 else 1.875
            deviations.append(factor * self.noise[column] / np.sqrt(energy * abs(slope) ** (2 * order)))
        return np.array(deviations)


def identified_decay(decay: FreeDecay) -> IdentifiedDecay:
    """The windows of a free decay that suit its noise."""
    places = even_places(decay.record, decay.rates, max(LOOK[0], decay.shortest), LOOK[1], 0.5)
    first = estimate(decay.record, places, decay.rates, decay.sensors, decay.harmonics)
    suited = Suited(first, np.zeros(len(first)))
    for _ in range(ROUNDS):
        known = sure_windows(suited, decay.sensors.deviations, decay)
        deviations = np.sqrt(known.estimates.variances(decay.sensors.deviations))
        # The amplitude of the sensor with the least noise for its motion.
        sizes = np.abs(known.estimates.amplitudes)
        seen = sizes.mean(axis=0) * (2 * np.pi * decay.frequency) ** np.array(decay.record.orders)
        size = sizes[:, int(np.argmax(seen / decay.sensors.deviations))]
        law = equivalent_law(size, known.estimates.slopes, np.hypot(deviations, known.bias[:, None]))
        suited = suited_windows(decay, law, known.estimates)
        decay = replace(
            decay, sensors=replace(decay.sensors, deviations=noise_at_mode(suited.estimates, decay.sensors))
        )
    noise = decay.sensors.deviations
    suited = sure_windows(suited, noise, decay)
    estimates = suited.estimates
    degree = max(fit.exponents.shape[1] - 1 for fit in estimates.fits)
    half_band = min(HALF_BAND, BESIDE / decay.shortest if decay.shortest else HALF_BAND)
    signal = decay.signal if half_band == HALF_BAND else analytic_signal(decay.record, decay.frequency, half_band)
    band = signal.slopes(estimates.middles, estimates.halves, degree, noise)
    return IdentifiedDecay(decay, estimates, suited.bias, noise, estimates.covariance(noise), band)


def sure_windows(suited: Suited, noise: np.ndarray, decay: FreeDecay) -> Suited:
    """The windows from the first to the last that know the decay rate, by the median rate of their neighbours: a window
    whose rate is large by chance is not better than others.

    Raises
    ------
    DataError
        Where none does, or the amplitude grows.
    """
    estimates = suited.estimates
    rates = -estimates.slopes.real
    smooth = np.array(
        [np.median(rates[max(place - BESIDES, 0) : place + BESIDES + 1]) for place in range(len(estimates))]
    )
    deviations = np.sqrt(estimates.variances(noise)[:, 0]) if len(estimates) else np.zeros(0)
    sure = np.flatnonzero(deviations < UNCERTAIN * np.abs(smooth))
    if not len(sure):
        fall = 1 - np.exp(-float(np.median(rates)) * decay.record.duration) if len(rates) else 0.0
        raise DataError(
            f"ring_down: the record is too short, or too noisy, for the damping: in its {decay.record.duration:.3g} s "
            f"the amplitude falls by {100 * fall:.2g} %. Record for longer, or hit harder"
        )
    if np.median(rates[sure]) < 0:
        raise DataError(
            "ring_down: the amplitude grows. Give the part of the record in which the mode decays, start=..., or look "
            "whether something excites it"
        )
    rows = np.zeros(len(estimates), dtype=bool)
    rows[sure[0] : sure[-1] + 1] = True
    return Suited(estimates.kept(rows), suited.bias[rows])
