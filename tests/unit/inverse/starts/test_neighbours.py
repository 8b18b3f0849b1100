"""Minima beside a minimum."""

import numpy as np

from dalembert.data import Measurements
from dalembert.forward import PythonModel
from dalembert.inverse.least_squares.descent import descend
from dalembert.inverse.problem.journal import Journal
from dalembert.inverse.problem.problem import pose
from dalembert.inverse.starts.neighbours import neighbours
from dalembert.optimize import LeastSquares

TIMES = np.linspace(0, 10, 41)
SWING = PythonModel(lambda rate: np.cos(rate * TIMES), {"rate": (0.5, 8.0)}, ["x"], TIMES)


def noisy(model, values, noise, seed=0):
    exact = model.evaluate(np.array([values])).only()[0]
    columns = exact + noise * np.random.default_rng(seed).standard_normal(exact.shape)
    return Measurements.of(TIMES, dict(zip(("x", "y"), columns.T, strict=False)))


def posed(model, data):
    return pose(model, data, None, Journal(len(TIMES)))


def test_the_minimum_a_period_away_is_seen_from_a_false_one():
    problem = posed(SWING, noisy(SWING, [4.0], 0.1))
    false = descend([problem], LeastSquares(), problem.search.points(np.array([4.75])))
    assert abs(problem.search.vectors(false.point)[0] - 4.0) > 0.4
    found = problem.search.vectors(neighbours(problem, false))
    assert abs(found[0, 0] - 4.0) < 0.15


def test_from_the_only_minimum_none_is_seen():
    line = PythonModel(lambda slope: slope * TIMES, {"slope": (-5.0, 5.0)}, ["x"], TIMES)
    problem = posed(line, noisy(line, [1.0], 0.1))
    assert neighbours(problem, descend([problem], LeastSquares(), np.array([0.1]))).shape == (0, 1)
