"""Derivative channels: exact on polynomials, the filter of Savitzky and Golay, and an error that is told honestly."""

import numpy as np
import pytest
from scipy.signal import savgol_filter

from dalembert.data import Measurements, derivative
from dalembert.errors import DataError, InputError

UNEVEN = np.cumsum(np.random.default_rng(4).uniform(0.5, 1.5, 60)) / 60


@pytest.mark.parametrize("order", [1, 2, 3])
def test_polynomials_are_differentiated_exactly_at_uneven_samples(order):
    polynomial = np.polynomial.Polynomial([1.0, -2.0, 3.0, 4.0])
    found = derivative(Measurements.of(UNEVEN, {"x": polynomial(UNEVEN)}), "x", order=order)
    np.testing.assert_allclose(found.values, polynomial.deriv(order)(UNEVEN), atol=1e-7 * 100**order / 100)
    assert found.error < 1e-5 * 10**order


@pytest.mark.parametrize(("window", "degree", "order"), [(21, 3, 1), (11, 2, 1), (15, 4, 2)])
def test_at_even_samples_it_is_the_filter_of_savitzky_and_golay(window, degree, order):
    times = np.linspace(0, 2, 200)
    x = np.sin(9 * times) + 1e-2 * np.random.default_rng(0).standard_normal(200)
    found = derivative(Measurements.of(times, {"x": x}), "x", order=order, window=window, degree=degree)
    filtered = savgol_filter(x, window, degree, deriv=order, delta=times[1], mode="interp")
    np.testing.assert_allclose(found.values, filtered, atol=1e-9 * np.max(np.abs(filtered)))
    assert found.window == window


def test_the_noise_told_is_the_noise_that_there_is():
    times = np.linspace(0, 2, 101)
    noise = 0.02 * np.random.default_rng(1).standard_normal((400, 101))
    found = [derivative(Measurements.of(times, {"x": one}, 0.02), "x", window=15) for one in noise]
    spread = np.std([one.values for one in found], axis=0)
    np.testing.assert_allclose(spread, found[0].noise, rtol=0.15)


@pytest.mark.parametrize("known", [True, False], ids=["noise known", "noise unknown"])
@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize(("rate", "noise"), [(9, 1e-3), (3, 1e-2), (20, 1e-2)])
def test_the_error_told_is_no_less_than_there_is_and_not_much_more(rate, noise, order, known):
    times = np.linspace(0, 2, 200)
    exact = rate * np.cos(rate * times) if order == 1 else -(rate**2) * np.sin(rate * times)
    shares = []
    for seed in range(12):
        x = np.sin(rate * times) + noise * np.random.default_rng(seed).standard_normal(200)
        found = derivative(Measurements.of(times, {"x": x}, noise if known else None), "x", order=order)
        shares.append(np.sqrt(np.mean((found.values - exact) ** 2)) / found.error)
    assert np.median(shares) > 0.25
    assert max(shares) < 1.2
    assert found.deviation == pytest.approx(noise, rel=0 if known else 0.3)


def test_a_long_record_is_looked_at_in_places_and_differentiated_everywhere():
    times = np.linspace(0, 20, 20_000)
    x = np.sin(3 * times) + 1e-3 * np.random.default_rng(0).standard_normal(len(times))
    found = derivative(Measurements.of(times, {"x": x}), "x")
    wrong = found.values - 3 * np.cos(3 * times)
    assert 0.25 < np.sqrt(np.mean(wrong**2)) / found.error < 1.2
    assert found.window > 101


def test_a_window_too_wide_for_the_motion_is_told_by_what_it_leaves():
    times = np.linspace(0, 2, 200)
    found = derivative(Measurements.of(times, {"x": np.sin(20 * times)}, 1e-3), "x", window=101)
    assert found.left > 100 * found.deviation


def test_a_wrapping_channel_has_the_derivative_of_its_continuous_angle():
    times = np.linspace(0, 3, 301)
    data = Measurements.of(times, {"angle": (5 * times + np.pi) % (2 * np.pi) - np.pi}, wraps=["angle"])
    more = data.with_derivative("angle", "rate")
    np.testing.assert_allclose(more.values[:, 1], 5, atol=1e-9)
    assert more.wraps == ("angle",)
    assert more.deviations is None


def test_no_window_reaches_over_a_gap():
    times = np.linspace(0, 1, 101)
    x = np.where(times < 0.5, times, 100 - times)
    x[[50, 97]] = np.nan
    data = Measurements.of(times, {"x": x}, 1e-3, missing="leave-out").with_derivative("x", "vx")
    slopes = data.values[:, 1]
    np.testing.assert_allclose(slopes[:50], 1, atol=1e-9)
    np.testing.assert_allclose(slopes[51:97], -1, atol=1e-9)
    assert np.all(np.isnan(slopes[[50, *range(97, 101)]]))  # three samples are too few


def test_the_channel_takes_its_error_as_its_deviation_unless_another_is_given():
    times = np.linspace(0, 1, 101)
    data = Measurements.of(times, {"x": np.sin(times)}, 1e-3)
    assert data.with_derivative("x", "vx").deviations[1] == derivative(data, "x").error
    assert data.with_derivative("x", "vx", deviation=0.5).deviations.tolist() == [1e-3, 0.5]


SHORT = Measurements.of([0.0, 1.0, 2.0], {"x": [0.0, 1.0, 4.0]})
LONG = Measurements.of(np.arange(20.0), {"x": np.arange(20.0)})


@pytest.mark.parametrize(
    ("kind", "wrong", "sentence"),
    [
        (DataError, lambda: derivative(LONG, "y"), "derivative: unknown channel 'y'; known: x"),
        (
            DataError,
            lambda: derivative(SHORT, "x"),
            "channel 'x': fewer than 7 samples without a gap; expected at least as many for a derivative by "
            "polynomials of degree 3; take a smaller window or degree",
        ),
        (InputError, lambda: derivative(LONG, "x", order=0), "order is 0; expected at least 1"),
        (
            InputError,
            lambda: derivative(LONG, "x", order=2, degree=1),
            "degree is 1 for a derivative of order 2; expected at least the order",
        ),
        (
            InputError,
            lambda: derivative(LONG, "x", window=8),
            "window is 8; expected an odd number of at least 7 samples for degree 3",
        ),
    ],
)
def test_what_cannot_be_is_refused(kind, wrong, sentence):
    with pytest.raises(kind) as error:
        wrong()
    assert str(error.value) == sentence
