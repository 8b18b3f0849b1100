"""Tests of noise against SciPy, and at their edges."""

import numpy as np
import pytest
from scipy.stats import spearmanr

from dalembert.inverse.diagnostics.noise_tests import normality, rank_correlation, runs


def test_rank_correlation_is_that_of_scipy_with_equal_values():
    rng = np.random.default_rng(3)
    first, second = rng.integers(0, 6, 40).astype(float), rng.standard_normal(40)
    expected = spearmanr(first, second)
    np.testing.assert_allclose(rank_correlation(first, second), (expected.statistic, expected.pvalue), rtol=1e-12)


def test_a_constant_has_no_rank_correlation():
    assert rank_correlation(np.ones(20), np.arange(20.0)) == (0.0, 1.0)


def test_runs_of_few_signs_are_not_judged():
    count, expected, probability = runs(np.concatenate([np.ones(30), -np.ones(9)]))
    assert (count, probability) == (2, 1.0)
    assert expected == pytest.approx(2 * 30 * 9 / 39 + 1)


def test_alternating_signs_are_too_many_runs():
    count, expected, probability = runs(np.tile([1.0, -1.0], 30))
    assert count == 60 > expected
    assert probability < 1e-10


@pytest.mark.parametrize("size", [0.0, 1.0, 3.0, 6.0])
def test_normality_falls_with_the_skewness_of_the_values(size):
    noise = np.random.default_rng(11).standard_normal(300)
    assert (normality(noise + 0.1 * size * noise**2) < 0.001) == (size > 2)


def test_normality_of_grossly_abnormal_values_is_zero():
    assert normality(np.concatenate([np.zeros(500), [1e6]])) == 0.0
