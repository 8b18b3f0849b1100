"""Tests of whiteness: how often they take white noise for correlated, and what they see."""

import numpy as np
import pytest

from correlated_noise import autoregressive, exponential, left, polynomials, series
from dalembert.inverse.experiments.experiment import Experiment
from dalembert.inverse.experiments.experiments import joint
from dalembert.inverse.noise.correlation.series import Series, even_grid, series_of
from dalembert.inverse.noise.correlation.whiteness import p_value, p_value_of_period
from dalembert.inverse.problem.journal import Journal
from dalembert.inverse.problem.problem import pose
from small_models import DECAY, measured


def gaps(number):
    """An even grid of which a third is missing, in stretches and here and there."""
    rng = np.random.default_rng(5)
    kept = np.ones(3 * number // 2, dtype=bool)
    kept[number // 3 : number // 2] = False
    kept[rng.choice(np.flatnonzero(kept)[1:-1], np.count_nonzero(kept) - number, replace=False)] = False
    return np.flatnonzero(kept).astype(float)


SAMPLES = {
    "even": np.arange,
    "gaps": gaps,
    "uneven": lambda number: np.sort(np.random.default_rng(6).uniform(0, number, int(number))),
}


@pytest.mark.parametrize("samples", SAMPLES.values(), ids=SAMPLES)
@pytest.mark.parametrize("number", [20, 60, 200])
@pytest.mark.parametrize("degree", [0, 3])
def test_white_noise_is_taken_for_correlated_as_often_as_the_level_says(samples, number, degree):
    along = samples(float(number)) if samples is np.arange else samples(number)
    own = series(along)
    values = np.array(
        [
            p_value(own, *left(np.random.default_rng(seed).standard_normal(number), polynomials(along, degree)))
            for seed in range(1000)
        ]
    )
    assert np.mean(values < 0.05) < 0.085
    assert np.mean(values < 0.01) < 0.035


@pytest.mark.parametrize("samples", SAMPLES.values(), ids=SAMPLES)
def test_correlated_noise_is_seen(samples):
    along = samples(200.0) if samples is np.arange else samples(200)
    own = series(along)
    found = [p_value(own, *left(exponential(seed, along, 2.0), polynomials(along, 1))) for seed in range(100)]
    assert np.mean(np.array(found) < 0.01) > 0.97


def test_a_gap_is_no_neighbourhood():
    """Alternating noise with every other sample missing is the same value throughout."""
    noise = autoregressive(0, 400, -0.9)
    kept = np.arange(0, 400, 2)
    own = series(np.arange(400.0))
    assert p_value(own, noise, np.zeros((400, 1))) < 1e-9
    sparse = Series("x", kept, kept.astype(float), kept, 1.0, "s")
    with_gaps = p_value(sparse, noise[kept], np.zeros((200, 1)))
    assert with_gaps == pytest.approx(p_value(series(np.arange(200.0)), noise[kept], np.zeros((200, 1))), abs=0.2)


def test_few_values_are_not_tested():
    assert p_value(series(np.arange(9.0)), np.arange(9.0), np.zeros((9, 1))) == 1


@pytest.mark.parametrize(
    ("along", "grid"),
    [
        ([0.0, 0.1, 0.2, 0.3], [0, 1, 2, 3]),
        ([0.0, 0.1003, 0.1998, 0.5], [0, 1, 2, 5]),
        ([0.0, 1.0, 2.4, 3.4], None),
        ([0.0, 1.0, 2.0, 500.0], None),
    ],
)
def test_even_samples_may_have_gaps_and_jitter(along, grid):
    found = even_grid(np.array(along))[0]
    assert (found is None) == (grid is None)
    if grid is not None:
        np.testing.assert_array_equal(found, grid)


def test_each_channel_of_each_experiment_is_a_series():
    data = measured(DECAY, [2.0, 0.8], noise=0.1)
    model, together = joint([Experiment("a", DECAY, data), Experiment("b", DECAY, data, local=("size",))])
    problem = pose(model, together, None, Journal(len(together.values)))  # pyright: ignore
    found = list(series_of(problem))
    assert [own.name for own in found] == ["a.x", "b.x"]
    for own in found:
        np.testing.assert_allclose(together.values.ravel()[own.rows], data.values[:, 0])
        np.testing.assert_allclose(own.along, data.coordinate.values)


def test_a_period_is_seen_and_white_noise_is_taken_for_one_as_often_as_the_level_says():
    assert p_value_of_period(np.cos(np.arange(64.0))) < 1e-9
    assert [p_value_of_period(np.full(64, level)) for level in (0.0, 0.1)] == [1.0, 1.0]
    rng = np.random.default_rng(0)
    values = np.array([p_value_of_period(rng.standard_normal(64)) for _ in range(2000)])
    for level in (0.02, 0.1, 0.5):
        assert abs(np.mean(values < level) - level) < 4 * np.sqrt(level * (1 - level) / 2000)
