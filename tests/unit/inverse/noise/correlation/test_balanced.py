"""Tests of series that differ in noise keep their level."""

import numpy as np
import pytest

from correlated_noise import series
from dalembert.inverse.noise.correlation.balanced import balanced
from dalembert.inverse.noise.correlation.correlation import correlated_series
from dalembert.inverse.noise.correlation.series import Series

TIMES = np.arange(200.0)
SLOPES = np.concatenate([np.stack([wave(TIMES / 5), wave(TIMES / 9)], axis=1) for wave in (np.sin, np.cos)])
BASIS = np.linalg.qr(SLOPES)[0]
FIRST = series(TIMES)
PAIR = (FIRST, Series("y", FIRST.rows + 200, TIMES, FIRST.grid, FIRST.step, "s"))


def residuals(seed: int, ratio: float) -> np.ndarray:
    """What an unweighted fit leaves of white noise whose second half is ``ratio`` times as large."""
    noise = np.random.default_rng(seed).standard_normal(400) * np.repeat([1.0, ratio], 200)
    return noise - BASIS @ (BASIS.T @ noise)


@pytest.mark.parametrize("ratio", [1.0, 10.0, 100.0])
def test_white_noise_is_taken_for_correlated_as_often_as_the_level_says(ratio: float) -> None:
    """At 1 %, 4 of 400 are expected; without the balance, all are at a ratio of 100."""
    alarms = sum(bool(correlated_series(PAIR, *balanced(PAIR, residuals(seed, ratio), BASIS))) for seed in range(400))
    assert alarms <= 8


def test_residuals_are_those_of_a_weighted_fit() -> None:
    noise = residuals(1, 50.0)
    left, basis = balanced(PAIR, noise, BASIS)
    sizes = np.repeat([np.std(half) for half in np.split(left, 2)], 200)
    weighted = np.linalg.lstsq(SLOPES / sizes[:, None], noise / sizes, rcond=None)[0]
    np.testing.assert_allclose(left, noise - SLOPES @ weighted, atol=2e-4)
    np.testing.assert_allclose(basis.T @ basis, np.eye(2), atol=1e-14)


def test_what_the_fit_did_not_explain_is_kept() -> None:
    """Residuals along the basis, as those of a parameter on its bound, remain."""
    noise, more = residuals(2, 10.0), SLOPES[:, 0]
    np.testing.assert_allclose(
        balanced(PAIR, noise + more, BASIS)[0], balanced(PAIR, noise, BASIS)[0] + more, atol=1e-12
    )


def test_one_series_keeps_its_bits() -> None:
    noise = residuals(3, 1.0)[:200]
    left, basis = balanced(PAIR[:1], noise, BASIS[:200])
    assert left is noise
    assert basis.shape == (200, 2)
