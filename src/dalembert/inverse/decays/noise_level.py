"""The noise of sensors at the frequency of a mode, from the residuals of windows."""

import numpy as np

from dalembert.inverse.decays.record_windows import WindowEstimates
from dalembert.inverse.decays.sensors import Sensors

LEAST = 1e-3
"""Part of the deviations of a first look below which noise is not estimated."""
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
        times = fit.window.times
        spacing = 2 * np.pi / ((times[1] - times[0]) * len(times))
        lines = np.arange(BAND[0] * slope.imag, BAND[1] * slope.imag, spacing)
        taper = np.hanning(len(times) + 2)[1:-1]
        waves = taper * np.exp(-1j * np.outer(lines, times))
        power += np.sum(np.abs(waves @ fit.residuals) ** 2, axis=0)
        for channel, order in enumerate(sensors.orders):
            taken = [np.sum(np.abs(waves @ columns) ** 2) for columns in (fit.bases[order], fit.tangents[channel].T)]
            expected[channel] += len(lines) * np.sum(taper**2) - sum(taken)
    return np.maximum(np.sqrt(power / expected), LEAST * sensors.deviations)
