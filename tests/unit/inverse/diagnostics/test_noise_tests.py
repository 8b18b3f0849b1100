"""Tests of noise against SciPy, and at their edges."""

import numpy as np
import pytest
from scipy.stats import halfnorm, pearsonr, rankdata, spearmanr

from dalembert.inverse.diagnostics.noise_tests import growth, normality, runs


def test_growth_is_the_correlation_of_half_normal_scores_with_ranks():
    rng = np.random.default_rng(3)
    sizes, quantity = np.abs(rng.standard_normal(40)), rng.integers(0, 6, 40).astype(float)
    expected = pearsonr(halfnorm.ppf(rankdata(sizes) / 41), rankdata(quantity))
    np.testing.assert_allclose(growth(sizes, quantity), (expected.statistic, expected.pvalue), rtol=1e-10)


@pytest.mark.parametrize(("sizes", "quantity"), [(np.ones(20), np.arange(20.0)), (np.arange(20.0), np.ones(20))])
def test_a_constant_does_not_grow(sizes, quantity):
    assert growth(sizes, quantity) == (0.0, 1.0)


def test_more_of_growing_noise_is_seen_than_by_ranks_at_the_same_level():
    """Noise that grows from 1 to 2.5 over 200 samples, and even noise, at 0.0005."""
    along = np.linspace(0.0, 1.0, 200)
    noise = np.abs(np.random.default_rng(5).standard_normal((400, 200)))
    grown = noise * (1 + 1.5 * along)
    seen = [sum(growth(one, along)[1] < 0.0005 for one in rows) for rows in (noise, grown)]
    by_ranks = sum(spearmanr(one, along).pvalue < 0.0005 for one in grown)
    assert seen[0] <= 2
    assert seen[1] > 1.15 * by_ranks > 200


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
