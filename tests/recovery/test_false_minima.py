"""Known truth behind many false minima: two stiffnesses of an oscillating chain, from far away and with noise."""

import re

import numpy as np
import pytest

from dalembert.data import Measurements
from dalembert.forward import PythonModel
from dalembert.inverse import identify

TIMES = np.linspace(0, 20, 41)
TRUTH = np.array([20.0, 2.0])


def chain(k1, k2):
    """Two unit masses on springs k1 (to ground) and k2, released with the second one displaced by 1.

    Some 16 periods of the fast mode over the horizon: a stiffness that is off by a few per cent is out of step at the
    end, and the misfit has a false minimum about every period.
    """
    mean, half = (k1 + 2 * k2) / 2, np.sqrt(k1**2 + 4 * k2**2) / 2
    slow, fast = np.sqrt(mean - half), np.sqrt(mean + half)
    a, b = k1 + k2 - slow**2, k1 + k2 - fast**2
    x1 = k2 * (np.cos(slow * TIMES) - np.cos(fast * TIMES)) / (a - b)
    x2 = (a * np.cos(slow * TIMES) - b * np.cos(fast * TIMES)) / (a - b)
    v1 = k2 * (fast * np.sin(fast * TIMES) - slow * np.sin(slow * TIMES)) / (a - b)
    v2 = (b * fast * np.sin(fast * TIMES) - a * slow * np.sin(slow * TIMES)) / (a - b)
    return np.stack([x1, x2, v1, v2], axis=1)


CHANNELS = ["first.x", "second.x", "first.vx", "second.vx"]
MODEL = PythonModel(chain, {"k1": (2.0, 200.0), "k2": (0.2, 20.0)}, CHANNELS, TIMES)
FAR = [(2.0, 0.5), (5.0, 0.2), (0.2, 5.0), (0.15, 0.15), (8.0, 8.0)]


def data(noise, seed=0, deviations=None):
    exact = chain(*TRUTH)
    noisy = exact + noise * np.random.default_rng(seed).standard_normal(exact.shape)
    return Measurements.of(TIMES, dict(zip(CHANNELS, noisy.T, strict=True)), deviations)


@pytest.mark.parametrize("far", FAR)
def test_one_descent_ends_in_a_false_minimum(far):
    """The case is hard: this is what the others are for."""
    alone = identify(MODEL, data(0.0), start=TRUTH * far, starts=1, horizon=None)
    assert np.max(np.abs(alone.values / TRUTH - 1)) > 0.3
    assert re.search(r"The response explains (nothing|[\d.]+ %) of the data's variation", alone.status)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("far", FAR)
def test_exact_data_give_the_truth_exactly_from_anywhere(far, seed):
    fit = identify(MODEL, data(0.0), start=TRUTH * far, seed=seed)
    np.testing.assert_allclose(fit.values, TRUTH, rtol=1e-9)
    assert fit.misfit < 1e-16
    assert fit.simulations < 700


@pytest.mark.parametrize("known", [None, 0.1], ids=["noise unknown", "noise known"])
@pytest.mark.parametrize("far", FAR)
def test_noisy_data_give_the_truth_within_its_deviations_from_anywhere(far, known):
    fit = identify(MODEL, data(0.1, seed=1, deviations=known), start=TRUTH * far)
    assert np.all(np.abs(fit.values - TRUTH) < 4 * fit.deviations)
    assert fit.success
    near = identify(MODEL, data(0.1, seed=1, deviations=known), start=TRUTH, starts=1, horizon=None)
    np.testing.assert_allclose(fit.values, near.values, atol=0.01 * np.max(fit.deviations))
    np.testing.assert_allclose(fit.deviations, near.deviations, rtol=1e-3)


def test_an_easy_start_is_settled_by_its_growing_horizon_alone():
    fit = identify(MODEL, data(0.0), start=TRUTH * [2.0, 0.5])
    assert len(fit.starts) == 1
    assert fit.simulations < 60


def test_a_best_end_that_was_reached_twice_ends_the_search():
    fit = identify(MODEL, data(0.02, seed=2), start=TRUTH * [1.1, 0.9])
    assert 3 <= len(fit.starts) < 8
    np.testing.assert_allclose(fit.values, TRUTH, rtol=0.01)
