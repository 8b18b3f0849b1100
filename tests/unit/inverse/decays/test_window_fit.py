"""Decaying modes in a window: exact for what the polynomials contain, and the effect of noise to first order."""

import numpy as np
import pytest

from dalembert.inverse.decays.sensors import Sensors
from dalembert.inverse.decays.window_fit import Window, fit_window

OMEGA, SIGMA, BEND = 60.0, 1.5, 4.0  # rad/s, 1/s, rad/s^2
HALF = 0.3


def wave(times, order):
    """A displacement e^{-σt} cos(ωt + βt²/2), or its derivatives by time."""
    rate = -SIGMA + 1j * (OMEGA + BEND * times)
    factor = {0: 1.0, 1: rate, 2: rate**2 + 1j * BEND}[order]
    return factor * np.exp(-SIGMA * times + 1j * (OMEGA * times + BEND * times**2 / 2))


def window(noise=0.0, orders=(0,)):
    times = np.linspace(-HALF, HALF, 301)
    values = np.stack([wave(times, order).real for order in orders], axis=1)
    return Window(times, values + noise, HALF)


def guess(degree=2, modes=1):
    exponents = np.zeros((modes, degree + 1), dtype=complex)
    exponents[:, 1] = (-1.0 + 1.002j * OMEGA) * HALF
    return exponents


@pytest.mark.parametrize("orders", [(0,), (1,), (2,), (0, 1, 2)])
def test_a_mode_of_changing_frequency_is_exact_at_every_kind_of_sensor(orders):
    fit = fit_window(window(orders=orders), guess(), Sensors(orders, np.ones(len(orders))))
    assert fit.converged
    assert fit.slope(0.5) == pytest.approx(-SIGMA + 1j * (OMEGA + BEND * 0.5 * HALF), rel=1e-9)
    assert fit.amplitudes[0] == pytest.approx(np.ones(len(orders)), rel=1e-9)


def test_two_modes_are_separated():
    at = window()
    other = np.exp((-3.0 + 1j * 1.4 * OMEGA) * at.times)
    both = Window(at.times, at.values + 0.5 * other.real[:, None], HALF)
    exponents = guess(modes=2)
    exponents[1, 1] = (-2.0 + 1.41j * OMEGA) * HALF
    fit = fit_window(both, exponents, Sensors((0,), np.ones(1)))
    assert fit.slope(0.0) == pytest.approx(-SIGMA + 1j * OMEGA, rel=1e-8)
    assert fit.slope(0.0, 1) == pytest.approx(-3.0 + 1.4j * OMEGA, rel=1e-6)
    assert abs(fit.amplitudes[1, 0]) == pytest.approx(0.5, rel=1e-6)


def test_gains_are_the_derivatives_of_frequency_and_decay_rate_by_the_samples():
    sensors = Sensors((0, 2), np.array([1.0, 3000.0]))
    exact = fit_window(window(orders=(0, 2)), guess(), sensors)
    noise = np.random.default_rng(4).standard_normal((301, 2)) * sensors.deviations
    predicted = np.einsum("icj,jc->i", exact.slope_gains(0.2), noise)
    size = 1e-6
    moved = fit_window(window(size * noise, (0, 2)), guess(), sensors).slope(0.2) - exact.slope(0.2)
    assert np.array([moved.real, moved.imag]) / size == pytest.approx(predicted, rel=1e-4)


def test_frequency_has_the_bound_of_cramer_and_rao_of_a_wave_of_constant_amplitude():
    # Rife and Boorstyn 1974: var ω = 24 σ²/(A² N³ Δt²), and as much for the decay rate.
    times = np.linspace(-HALF, HALF, 2001)
    constant = Window(times, np.cos(300.0 * times)[:, None], HALF)
    exponents = np.zeros((1, 3), dtype=complex)
    exponents[0, 1] = 300.1j * HALF
    fit = fit_window(constant, exponents, Sensors((0,), np.ones(1)))
    bound = np.sqrt(24 / (len(times) ** 3 * (times[1] - times[0]) ** 2))
    place = fit.best_place(np.ones(1))
    deviations = np.sqrt(np.sum(fit.slope_gains(place) ** 2, axis=(1, 2)))
    assert abs(place) < 0.02
    assert deviations == pytest.approx([bound, bound], rel=0.03)


def test_a_window_without_an_oscillation_does_not_converge():
    times = np.linspace(-HALF, HALF, 301)
    noise = np.random.default_rng(0).standard_normal((301, 1))
    fit = fit_window(Window(times, noise, HALF), guess(4), Sensors((0,), np.ones(1)))
    assert not fit.converged or abs(fit.amplitudes[0, 0]) < 1.0
