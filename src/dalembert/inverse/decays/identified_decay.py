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

    def other_modes(self) -> np.ndarray:
        """Frequencies, Hz, of the other modes of a decay, from the longest window with self."""
        result = []
        for mode in range(1, len(self.decay.rates.slopes)):
            fits = [fit for fit in self.estimates.fits if len(fit.amplitudes) > mode]
            longest = max(fits, key=lambda fit: fit.window.half, default=None)
            slope = self.decay.rates.slopes[mode, 0] if longest is None else longest.slope(0.0, mode)
            result.append(slope.imag / (2 * np.pi))
        return np.array(result)

    def amplitude_deviations(self, column: int) -> np.ndarray:
        """Standard deviations of the amplitudes of a channel: that of a wave of known frequency in white noise."""
        order = self.decay.record.orders[column]
        deviations = []
        for fit, slope in zip(self.estimates.fits, self.estimates.slopes, strict=True):
            # Energy of the fitted wave for unit amplitude of the displacement, at the middle of the window.
            growth = np.exp(-2 * -slope.real * fit.window.times)
            deviations.append(self.noise[column] / np.sqrt(np.sum(growth) * abs(slope) ** (2 * order) / 2))
        return np.array(deviations)


def identified_decay(decay: FreeDecay) -> IdentifiedDecay:
    """The windows of a free decay that suit its noise."""
    places = even_places(decay.record, decay.rates, max(LOOK[0], decay.shortest), LOOK[1], 0.5)
    first = estimate(decay.record, places, decay.rates, decay.sensors, decay.harmonics)
    suited = Suited(first, np.zeros(len(first)))
    for _ in range(ROUNDS):
        known = sure_windows(suited, decay.sensors.deviations, decay)
        deviations = np.sqrt(known.estimates.variances(decay.sensors.deviations))
        law = equivalent_law(
            np.abs(known.estimates.amplitudes).sum(axis=1),
            known.estimates.slopes,
            np.hypot(deviations, known.bias[:, None]),
        )
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
    """The windows that know the decay rate."""
    estimates = suited.estimates
    rates = -estimates.slopes.real
    sure = (
        np.sqrt(estimates.variances(noise)[:, 0]) < UNCERTAIN * np.abs(rates) if len(estimates) else np.zeros(0, bool)
    )
    if not sure.any():
        fall = 1 - np.exp(-float(np.median(rates)) * decay.record.duration) if len(rates) else 0.0
        raise DataError(
            f"ring_down: the record is too short, or too noisy, for the damping: in its {decay.record.duration:.3g} s "
            f"the amplitude falls by {100 * fall:.2g} %. Record for longer, or hit harder"
        )
    if np.mean(rates[sure] < 0) > 0.5:
        raise DataError(
            "ring_down: the amplitude grows. Give the part of the record in which the mode decays, start=..., or look "
            "whether something excites it"
        )
    rows = sure & (rates > 0)
    return Suited(estimates.kept(rows), suited.bias[rows])
