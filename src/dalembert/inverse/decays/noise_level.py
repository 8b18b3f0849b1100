"""The noise of sensors at the frequency of a mode, from the residuals of windows."""

import numpy as np

from dalembert.inverse.decays.record_windows import WindowEstimates
from dalembert.inverse.decays.window_fit import Sensors, WindowFit

BAND = (0.5, 1.5)
"""Lines from which the noise is estimated, as parts of the frequency of the mode."""


def noise_at_mode(estimates: WindowEstimates, sensors: Sensors) -> np.ndarray:
    """Standard deviation (channels,) of the white noise that has the power of the residuals near the mode.

    Only noise at the frequency of the mode disturbs its estimates. A fit takes a part of the noise out of its
    residuals, most at that frequency: with the orthonormal columns Q of the fit, white noise of unit variance leaves
    the power :math:`\\|w\\|^2 - \\|Q^T (w e)\\|^2` at a line e with the taper w.
    """
    power, expected = np.zeros(len(sensors.orders)), np.zeros(len(sensors.orders))
    for fit, slope in zip(estimates.fits, estimates.slopes, strict=True):
        each, left = _window(fit, slope.imag, sensors)
        power, expected = power + each, expected + left
    return np.sqrt(power / expected)


def _window(fit: WindowFit, omega: float, sensors: Sensors) -> tuple[np.ndarray, np.ndarray]:
    """Power of the residuals at the lines of the band, and that of unit white noise, (channels,) each."""
    times = fit.window.times
    step = times[1] - times[0]
    lines = np.arange(BAND[0], BAND[1], 2 * np.pi / (omega * step * len(times))) * omega
    taper = np.hanning(len(times) + 2)[1:-1]
    waves = taper * np.exp(-1j * np.outer(lines, times))
    power = np.sum(np.abs(waves @ fit.residuals) ** 2, axis=0)
    left = np.empty(len(sensors.orders))
    for channel, order in enumerate(sensors.orders):
        slopes = fit.tangents[channel]
        taken = np.sum(np.abs(waves @ fit.bases[order]) ** 2) + np.sum(np.abs(waves @ slopes.T) ** 2)
        left[channel] = len(lines) * np.sum(taper**2) - taken
    return power, left
