"""Filters and derivatives of measured motion."""

import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.inverse.inertial import filtered_motion, lowpass

TIMES = np.arange(4000) / 1000


@pytest.mark.parametrize("frequency", [5.0, 20.0, 30.0])
def test_the_gain_is_that_of_butterworth_twice(frequency):
    """1 / (1 + (f/f_c)^8) of the analogue filter; the digital one warps frequencies by tan(pi f / rate)."""
    wave = np.sin(2 * np.pi * frequency * TIMES)
    ratio = np.tan(np.pi * frequency / 1000) / np.tan(np.pi * 20.0 / 1000)
    middle = slice(1000, 3000)
    np.testing.assert_allclose(lowpass(wave, 1000.0, 20.0)[middle], wave[middle] / (1 + ratio**8), atol=1e-7)


def test_derivatives_of_two_harmonics():
    rates = 2 * np.pi * np.array([0.7, 2.0])
    path = np.sin(np.outer(TIMES, rates))
    found = filtered_motion(TIMES + 5.0, path, 3 * path, 40.0)
    times = found.times - 5.0
    angles = np.outer(times, rates)
    assert found.times[0] == pytest.approx(5.075)
    assert found.decimation == 12
    np.testing.assert_allclose(found.positions, np.sin(angles), atol=1e-4)
    np.testing.assert_allclose(found.velocities[20:-20], rates * np.cos(angles)[20:-20], atol=1e-5)
    np.testing.assert_allclose(found.accelerations[20:-20], -(rates**2) * np.sin(angles)[20:-20], atol=1e-4)
    np.testing.assert_allclose(found.torques, 3 * found.positions, rtol=1e-12, atol=1e-12)


def test_decimated_noise_is_hardly_correlated():
    noise = np.random.default_rng(0).standard_normal((40000, 1))
    times = np.arange(40000) / 1000
    kept, every = (filtered_motion(times, noise, noise, 20.0, decimation=n).torques[:, 0] for n in (None, 1))
    assert np.corrcoef(every[1:], every[:-1])[0, 1] > 0.99
    assert abs(np.corrcoef(kept[1:], kept[:-1])[0, 1]) < 0.2


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"cutoff": 600.0}, "lowpass: the cutoff frequency is 600 Hz and the sampling rate 1000 Hz; expected a cutoff between 0 and half the rate"),
        ({"times": TIMES[:-1]}, "filtered_motion: times, positions and torques have the shapes (3999,), (4000, 1) and (4000, 1); expected (samples,), (samples, joints) and (samples, joints)"),
        ({"times": TIMES**2}, "filtered_motion: the times are not even: mostly 0.003999 s, and 1e-06 s after 0 s. Resample the record"),
        ({"decimation": 0}, "filtered_motion: decimation is 0; expected a whole number of at least 1"),
        ({"cutoff": 1.0}, "filtered_motion: 4000 samples leave 0 after 3000 are dropped at each end. Give a longer record or a higher cutoff"),
        ({"cutoff": 0.2}, "lowpass: 4000 samples are shorter than the period of the cutoff frequency (5000 samples). Give a longer record or a higher cutoff"),
        ({"torques": np.full((4000, 1), np.nan)}, "filtered_motion: a time, position or torque is not finite. Remove this sample, and resample"),
    ],
)  # fmt: skip
def test_invalid_input(change, message):
    given = {"times": TIMES, "positions": TIMES[:, None], "torques": TIMES[:, None], "cutoff": 20.0, **change}
    with pytest.raises(InputError) as refused:
        filtered_motion(**given)
    assert str(refused.value) == message
