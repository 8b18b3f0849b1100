"""The law of a decay: linear oscillators, sliders and springs, against closed forms."""

import numpy as np
import pytest

from dalembert.inverse.decays.equivalent_law import EquivalentLaw, equivalent_law

SIZES = np.geomspace(6.0, 0.6, 40)


def law(stiffnesses, elastic, viscous, slips=(1.0,)):
    return EquivalentLaw(SIZES, np.array(slips), np.array(stiffnesses), np.array(elastic), viscous, np.zeros((0, 2)))


def test_a_damped_linear_oscillator_has_its_damped_frequency():
    slopes = law([0.0], [4.0, 0.0, 0.0], 0.2).slopes(SIZES)
    assert -slopes.real == pytest.approx(np.full(40, 0.1), rel=1e-6)
    assert slopes.imag == pytest.approx(np.full(40, np.sqrt(4 - 0.01)), rel=1e-6)


def test_a_slider_takes_its_energy_from_the_springs():
    # From one reversal to the next, k (a² - b²)/2 = 2 F (a + b - 2 x_s)/2 ... in the limit of small loss per period:
    # d ln a/dφ = D/(2 π k a²) with D = 4 k_t x_s (a - x_s), where the slider slips and stores no more.
    for size in (1.5, 3.0):
        slope = law([1e-3], [1.0, 0.0, 0.0], 0.0).slopes(size)
        expected = 4e-3 * (size - 1) / (2 * np.pi * size**2)
        assert -slope.real / slope.imag == pytest.approx(expected, rel=2e-3)


def test_a_slider_that_sticks_is_a_spring():
    slope = law([0.1], [1.0, 0.0, 0.0], 0.01).slopes(0.8)
    assert slope.imag == pytest.approx(np.sqrt(1.1 - 0.005**2), rel=1e-6)
    assert -slope.real == pytest.approx(0.005, rel=1e-4)


def test_a_spring_that_stiffens_decays_as_the_action():
    # a √ω falls as e^{-ct/2}: σ = c/2/(1 + ½ d ln ω/d ln a) with ω² = 1 + ¾ k_3 a².
    cubic, damping = 0.02, 0.01
    slopes = law([0.0], [1.0, 0.75 * cubic * SIZES.max() ** 2, 0.0], damping).slopes(SIZES)
    squares = 1 + 0.75 * cubic * SIZES**2
    change = 0.75 * cubic * SIZES**2 / squares
    assert -slopes.real == pytest.approx(damping / 2 / (1 + change / 2), rel=1e-3)


@pytest.mark.parametrize(
    ("stiffnesses", "elastic", "viscous"),
    [([0.1], [1.0, 0.0, 0.0], 0.004), ([0.0], [1.0, 0.4, 0.0], 0.03), ([0.0], [1.0, 0.0, 0.0], 0.02)],
)
def test_the_law_of_a_decay_gives_its_periodic_motions(stiffnesses, elastic, viscous):
    truth = law(stiffnesses, elastic, viscous)
    slopes = truth.slopes(SIZES)
    fitted = equivalent_law(SIZES, slopes, np.abs(np.stack([slopes.real, slopes.imag], 1)) * [1e-4, 1e-6])
    frequencies, damping = fitted.periodic(SIZES, slopes)
    expected, ratios = truth.periodic(SIZES, slopes)
    # A corner of the damping lies between sliders of the fitted law.
    far = np.abs(np.log(SIZES)) > 0.15
    assert frequencies[far] == pytest.approx(expected[far], rel=5e-5)
    assert damping[far] == pytest.approx(ratios[far], rel=5e-3)


def test_noise_makes_no_friction():
    slopes = law([0.0], [1.0, 0.0, 0.0], 0.02).slopes(SIZES)
    rng = np.random.default_rng(2)
    noisy = slopes + 1e-4 * (rng.standard_normal(40) + 1j * rng.standard_normal(40))
    fitted = equivalent_law(SIZES, noisy, np.full((40, 2), 1e-4))
    _, damping = fitted.periodic(SIZES, noisy)
    assert damping == pytest.approx(-noisy.real / noisy.imag, rel=1e-3)
    assert fitted.stiffnesses.sum() < 2e-3
