"""Autoregressive and Ornstein–Uhlenbeck processes of residuals."""

from dataclasses import replace

import numpy as np
import pytest

from correlated_noise import autoregressive, exponential, left, polynomials, series
from dalembert.inverse.noise.correlation.autoregression import Autoregression, autocorrelations, levinson, moments
from dalembert.inverse.noise.correlation.ornstein_uhlenbeck import OrnsteinUhlenbeck, ornstein_uhlenbeck

AR3 = np.array([0.5, -0.3, 0.2])


def covariance(process, along):
    """Of all pairs of values at even places."""
    lags = np.abs(np.subtract.outer(along, along)).astype(int)
    return process.covariances[lags]


def test_levinson_gives_back_the_process_of_its_autocorrelations():
    found, variances = levinson(autocorrelations(AR3, 6), 0.999)
    np.testing.assert_allclose(found[2], AR3, atol=1e-13)
    np.testing.assert_allclose(found[4], [*AR3, 0, 0], atol=1e-13)
    assert variances[2] == pytest.approx(variances[4])


def test_autocorrelations_satisfy_the_recursion():
    found = autocorrelations(AR3, 40)
    np.testing.assert_allclose(found[3:], AR3[0] * found[2:-1] + AR3[1] * found[1:-2] + AR3[2] * found[:-3], atol=1e-14)
    np.testing.assert_allclose(found[1], AR3[0] + AR3[1] * found[1] + AR3[2] * found[2])


def test_a_process_that_would_grow_is_made_stationary():
    (row,), _ = levinson(np.array([1.0, 1.2]), 0.99)
    assert row == pytest.approx([0.99])


@pytest.mark.parametrize("places", [np.arange(12.0), np.array([0.0, 1.0, 2.0, 5.0, 6.0, 11.0])])
def test_the_product_with_the_covariance_of_even_values(places):
    process = Autoregression(AR3, autocorrelations(AR3, 12))
    basis = np.random.default_rng(0).standard_normal((len(places), 2))
    expected = basis.T @ covariance(process, places) @ basis
    np.testing.assert_allclose(process.product(series(places), basis), expected, rtol=1e-12)


def test_the_product_with_the_covariance_of_uneven_values():
    along = np.sort(np.random.default_rng(0).uniform(0, 10, 15))
    basis = np.random.default_rng(1).standard_normal((15, 3))
    expected = 2.0 * basis.T @ np.exp(-np.abs(np.subtract.outer(along, along)) / 1.7) @ basis
    found = OrnsteinUhlenbeck(2.0, 1.7, 0.5).product(series(along), basis)
    np.testing.assert_allclose(found, expected, rtol=1e-12)


@pytest.mark.parametrize(("coefficient", "number"), [(0.6, 60), (0.9, 300), (-0.5, 60)])
def test_the_bias_of_a_short_record_is_taken_off(coefficient, number):
    """Three parameters take slow noise with them; the moments of the residuals alone are too small."""
    plain, corrected = [], []
    for seed in range(300):
        values, basis = left(autoregressive(seed, number, coefficient), polynomials(np.arange(number), 2))
        own = moments(series(np.arange(number, dtype=float)), values, basis)
        plain.append(own.process.covariances[:2])
        for _ in range(4):
            own = own.corrected(own.process.product(own.series, basis))
        corrected.append(own.process.covariances[:2])
    before, after = np.mean(plain, axis=0), np.mean(corrected, axis=0)
    assert abs(after[0] - 1) < 0.1
    assert abs(after[1] / after[0] - coefficient) < max(0.03, abs(before[1] / before[0] - coefficient) / 1.5)


def test_the_correlation_time_of_uneven_samples_is_recovered():
    along = np.sort(np.random.default_rng(3).uniform(0, 400, 400))
    found = [
        ornstein_uhlenbeck(series(along), *left(exponential(seed, along, 2.5), polynomials(along, 2)))
        for seed in range(60)
    ]
    assert np.mean([process.time for process in found]) == pytest.approx(2.5, rel=0.08)
    assert np.mean([process.variance for process in found]) == pytest.approx(1.0, rel=0.05)


def test_the_decay_is_that_of_the_slowest_root():
    assert Autoregression(np.array([0.5]), np.ones(2)).decay(0.1) == pytest.approx(0.1 / np.log(2))
    swing = np.array([2 * 0.9 * np.cos(0.7), -0.81])  # roots 0.9 exp(±0.7 i)
    assert Autoregression(swing, np.ones(3)).decay(1.0) == pytest.approx(-1 / np.log(0.9))


def test_a_process_is_stationary_where_corrected_covariances_are_not_those_of_one():
    """The equations of high orders were almost singular, and autocorrelations of 3e6 came out."""
    own = series(np.arange(201.0))
    impossible = replace(moments(own, np.ones(201), np.zeros((201, 1))), covariances=(-1.5) ** np.arange(11))
    process = impossible.process
    assert np.max(np.abs(process.covariances)) <= process.variance * (1 + 1e-9)
    assert np.isfinite(process.decay(own.step))
