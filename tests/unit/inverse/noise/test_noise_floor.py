"""The noise floor: from given deviations, from rounding, from arithmetic."""

import numpy as np
import pytest

from dalembert.data import Measurements
from dalembert.forward import PythonModel
from dalembert.inverse.noise.noise_floor import noise_floor, quantum
from dalembert.inverse.problem.journal import Journal
from dalembert.inverse.problem.problem import pose
from dalembert.inverse.problem.random_residuals import autocorrelation, random_residuals

TIMES = np.linspace(0, 3, 200)
TRUE = np.sin(TIMES)
MODEL = PythonModel(lambda rate: np.sin(rate * TIMES), {"rate": (0.5, 2.0)}, ["x"], TIMES)


def floor(column, deviations=None, weights=None):
    data = Measurements.of(TIMES, {"x": column}, deviations)
    return noise_floor(pose(MODEL, data, weights, Journal(len(TIMES))))


def test_the_truth_lies_under_the_floor_of_given_deviations_and_twice_the_noise_does_not():
    rng = np.random.default_rng(0)
    for _ in range(50):
        noise = 0.05 * rng.standard_normal(200)
        known = floor(TRUE + noise, deviations=0.05)
        assert np.sum((noise / 0.05) ** 2) < known.misfit < np.sum((2 * noise / 0.05) ** 2)
        assert known.source == "given"
        assert not known.conclusive


def test_the_truth_lies_under_the_floor_of_rounded_data():
    rounded = np.round(TRUE, 4)
    known = floor(rounded)
    misfit = np.sum((rounded - TRUE) ** 2)
    assert misfit < known.misfit < 2 * misfit
    assert known.source == "rounded"
    assert known.conclusive


def test_unrounded_data_allow_a_millionth_of_the_signal():
    known = floor(TRUE)
    assert known.misfit == pytest.approx(200 * (1e-6 * TRUE.std()) ** 2, rel=0.4)
    assert known.source == "arithmetic"
    assert known.conclusive


def test_the_floor_scales_with_the_weights():
    assert floor(TRUE, weights=[4.0]).misfit == pytest.approx(4 * floor(TRUE).misfit)


@pytest.mark.parametrize(
    ("column", "unit"),
    [
        ([2.4392, -1.7071, 1.9142, 2.5], 1e-4),
        ([0.5, 1.25, 9.0], 0.0),
        ([0.5, 1.25, 900.25], 0.01),
        ([0.0, 1.0, 2.0], 0.0),
        ([0.0, 1500.0, -3.0], 1.0),
        ([np.pi, np.e, 1.0], 0.0),
        ([7.0, 7.0, 7.0], 0.0),
    ],
)
def test_the_last_decimal_of_rounded_data_is_found_where_they_span_a_thousand_of_it(column, unit):
    assert quantum(np.array(column)) == unit


def test_noise_looks_random_and_a_trend_does_not():
    rng = np.random.default_rng(1)
    noise = rng.standard_normal((41, 4))
    trend = noise + 3 * np.sin(np.linspace(0, 6, 41))[:, None]
    assert random_residuals(noise.ravel(), (41, 4))
    assert not random_residuals(trend.ravel(), (41, 4))
    assert autocorrelation(trend.ravel(), (41, 4)) > 0.5
