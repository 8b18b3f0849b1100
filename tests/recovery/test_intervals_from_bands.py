"""Known intervals of the flexible double pendulum, found again from its bands, exact ones and noisy ones."""

import numpy as np
import pytest

import dalembert as da
from conclusions import codes
from dalembert.surrogate import Adaptive, bounds, fit
from flexible_pendulum import CHANNELS, tip

MIDDLES = {"theta1": np.pi / 4, "theta2": np.pi / 6, "youngs_ab": 2e7}
SEARCHED = {"theta1": (0.6, 1.0), "theta2": (0.4, 0.65), "youngs_ab": (1.7e7, 2.3e7)}


SEEDS = [0, *(pytest.param(seed, marks=pytest.mark.slow) for seed in (1, 2))]


def posed(number: int, tolerance: float) -> tuple[da.TimeResponse, np.ndarray, da.Bands]:
    """Model with the first parameters, their middles, and bands over ±5 % of them, exact to the tolerance."""
    names = list(MIDDLES)[:number]
    model, middle = tip({name: SEARCHED[name] for name in names}), np.array([MIDDLES[name] for name in names])

    def run(points: np.ndarray) -> np.ndarray:
        return model.evaluate(points).only().reshape(len(points), -1)

    surrogate = fit(run, 0.95 * middle, 1.05 * middle, Adaptive(tolerance))
    found = bounds(surrogate.polynomial, 0.95 * middle, 1.05 * middle)
    lower, upper = (side.reshape(-1, 2) for side in (found.lower, found.upper))
    columns = {channel: (lower[:, k], upper[:, k]) for k, channel in enumerate(CHANNELS)}
    return model, middle, da.Bands.of(model.coordinate, columns)


def noisy(bands: da.Bands, deviation: np.ndarray, seed: int) -> da.Bands:
    """Bands with independent normal noise on each bound, exchanged where they cross."""
    noise = deviation * np.random.default_rng(seed).standard_normal((2, *bands.lower.shape))
    return da.Bands(
        bands.coordinate, bands.channels, *np.sort([bands.lower + noise[0], bands.upper + noise[1]], axis=0)
    )


@pytest.fixture(scope="module")
def angles():
    return posed(2, 1e-7)


def test_both_angles_come_back_from_exact_bands(angles):
    model, middle, bands = angles
    found = da.identify_bands(model, bands)
    assert found.simulations <= 120
    np.testing.assert_allclose(found.box.lower / middle, 0.95, atol=1e-6)
    np.testing.assert_allclose(found.box.upper / middle, 1.05, atol=1e-6)
    assert found.checked_misfit < 1e-11


@pytest.mark.slow
def test_three_parameters_come_back_from_exact_bands():
    model, middle, bands = posed(3, 1e-6)
    found = da.identify_bands(model, bands)
    np.testing.assert_allclose(found.box.lower / middle, 0.95, atol=1e-4)
    np.testing.assert_allclose(found.box.upper / middle, 1.05, atol=1e-4)


@pytest.mark.parametrize(("noise", "allowed"), [(0.005, 1e-3), (0.02, 5e-3)], ids=["0.5 %", "2 %"])
@pytest.mark.parametrize("seed", SEEDS)
def test_noise_that_is_a_part_of_the_width_of_the_bands_leaves_the_ends_nearly_right(angles, noise, allowed, seed):
    model, middle, bands = angles
    found = da.identify_bands(model, noisy(bands, noise * bands.width, seed))
    ends = np.array([found.box.lower / middle - 0.95, found.box.upper / middle - 1.05])
    assert np.abs(ends).max() < allowed
    assert "uncorrelated-residuals" in codes(found)


@pytest.mark.parametrize(("noise", "allowed"), [(0.005, 2e-2), (0.02, 6e-2)], ids=["0.5 %", "2 %"])
@pytest.mark.parametrize("seed", SEEDS)
def test_noise_that_is_a_part_of_the_motion_shows_in_the_deviations_that_are_told(angles, noise, allowed, seed):
    """0.5 % of the motion is a tenth of the width of the bands; no method finds the ends better than 0.4 %."""
    model, middle, bands = angles
    amplitude = np.sqrt(np.mean(bands.middle**2, axis=0))
    found = da.identify_bands(model, noisy(bands, noise * amplitude, seed))
    middles, radii = found.middle - middle, found.radius - 0.05 * middle
    assert np.all(np.abs(middles) < 4 * found.middle_deviations)
    assert np.all(np.abs(radii) < 4 * found.radius_deviations)
    assert np.abs(middles / middle).max() < allowed
    assert np.all(found.middle_deviations / middle > 1e-3)
