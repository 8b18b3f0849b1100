"""Bounds of a candidate box on a surrogate, how they change with it, and what true runs say of them."""

from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest

from dalembert.forward import PythonModel
from dalembert.inverse.bands.band_descent import jacobian_of, screened
from dalembert.inverse.bands.band_problem import pose
from dalembert.inverse.bands.candidate import candidate
from dalembert.inverse.bands.check import LOSS, check, scale
from dalembert.inverse.bands.correction import corrected
from dalembert.inverse.bands.unknowns import unknowns_of
from dalembert.inverse.problem.journal import Journal
from dalembert.surrogate import Tensor, fit
from small_models import banded

TIMES = np.linspace(0, 3, 16)


def swing(rate, size):
    return np.stack([size * np.cos(rate * TIMES), size**2 * np.sin(rate * TIMES)], axis=1)


SWING = PythonModel(swing, {"rate": (0.5, 2.0), "size": (0.5, 1.5)}, ["x", "y"], TIMES)


def posed(intervals=None, order=12):
    unknowns = unknowns_of(SWING.parameters, intervals)
    problem = pose(SWING, banded(SWING, [0.9, 0.8], [1.2, 1.0], 41), None, unknowns, Journal(len(TIMES)))
    return problem, fit(problem.run, *unknowns.bounds, Tensor(order))


@pytest.mark.parametrize("intervals", [None, ["rate"], ["size"]])
@pytest.mark.parametrize("seed", range(4))
def test_the_jacobian_is_that_of_central_differences(intervals, seed):
    problem, surrogate = posed(intervals)
    unknowns = problem.unknowns
    random = np.random.default_rng(seed).uniform(0.2, 0.8, len(unknowns.lower))
    x = unknowns.lower + (unknowns.upper - unknowns.lower) * random

    def residual(x):
        at = candidate(problem, surrogate.polynomial, x)
        return problem.residual(at.bounds.lower, at.bounds.upper)

    step = 1e-6
    differences = [(residual(x + step * way) - residual(x - step * way)) / (2 * step) for way in np.eye(len(x))]
    ours = jacobian_of(problem, surrogate.polynomial, candidate(problem, surrogate.polynomial, x))
    apart = np.abs(ours - np.transpose(differences))
    # Where the extreme jumps from one point to another, the derivative does too: nowhere else may it differ.
    assert np.mean(apart < 1e-6) > 0.98
    assert np.median(apart) < 1e-8


def test_a_radius_of_zero_has_the_slope_of_one_that_grows():
    problem, surrogate = posed()
    x = problem.unknowns.of(*np.tile(problem.unknowns.search.points(np.array([1.1, 0.9])), (2, 1)))
    ours = jacobian_of(problem, surrogate.polynomial, candidate(problem, surrogate.polynomial, x))
    for column in (2, 3):
        grown = x.copy()
        grown[column] = 1e-6
        residuals = [
            problem.residual(at.bounds.lower, at.bounds.upper)
            for at in (candidate(problem, surrogate.polynomial, place) for place in (x, grown))
        ]
        np.testing.assert_allclose(ours[:, column], (residuals[1] - residuals[0]) / 1e-6, atol=2e-5)


def test_a_check_takes_every_bound_of_the_surrogate_with_few_runs():
    problem, surrogate = posed()
    x = problem.unknowns.of(*(problem.unknowns.search.points(np.array(end)) for end in ([0.8, 0.7], [1.3, 1.1])))
    at = candidate(problem, surrogate.polynomial, x)
    checked = check(problem, surrogate.polynomial, at)
    assert len(checked.points) < len(np.unique(np.concatenate([at.bounds.at_lower, at.bounds.at_upper]), axis=0))
    values = surrogate.polynomial(checked.points)
    assert np.all(values.min(axis=0) <= at.bounds.lower + LOSS * scale(problem))
    assert np.all(values.max(axis=0) >= at.bounds.upper - LOSS * scale(problem))
    np.testing.assert_allclose(checked.values, problem.run(checked.points))
    np.testing.assert_array_equal(checked.error, np.abs(values - checked.values).max(axis=0))


def test_failed_runs_are_left_out_of_a_check_and_none_at_all_is_none():
    problem, surrogate = posed()
    at = candidate(problem, surrogate.polynomial, (problem.unknowns.lower + problem.unknowns.upper) / 2)
    whole = check(problem, surrogate.polynomial, at)
    worst = whole.points[0] * problem.unknowns.parameters.scale

    def fragile(rate, size):
        if abs(rate - worst[0]) < 1e-9 and abs(size - worst[1]) < 1e-9:
            raise RuntimeError("here not")
        return swing(rate, size)

    def model(function):
        return PythonModel(function, SWING.parameters, ["x", "y"], TIMES)

    rest = check(replace(problem, model=model(fragile)), surrogate.polynomial, at)
    np.testing.assert_array_equal(rest.points, whole.points[1:])
    assert check(replace(problem, model=model(lambda rate, size: 1 / 0)), surrogate.polynomial, at) is None


def test_a_correction_makes_a_coarse_surrogate_better_on_the_box():
    problem, surrogate = posed(order=5)
    x = problem.unknowns.of(*(problem.unknowns.search.points(np.array(end)) for end in ([0.9, 0.8], [1.2, 1.0])))
    at = candidate(problem, surrogate.polynomial, x)
    checked = check(problem, surrogate.polynomial, at)
    better = corrected(
        surrogate.polynomial,
        at,
        np.concatenate([surrogate.points, checked.points]),
        np.concatenate([surrogate.values, checked.values]),
        len(checked.points),
    )
    box = at.lower + (at.upper - at.lower) * np.random.default_rng(0).random((200, 2))
    truth = problem.run(box)
    before, after = (np.abs(polynomial(box) - truth).max() for polynomial in (surrogate.polynomial, better))
    assert after < 0.3 * before


def test_starts_are_the_best_boxes_and_not_close_to_each_other():
    problem, surrogate = posed()
    unknowns = problem.unknowns
    starts = screened(problem, surrogate.polynomial, 400, 3, seed=1)
    assert starts.shape == (3, 4)
    width = unknowns.upper - unknowns.lower
    gaps = [np.max(np.abs(one - other) / width) for one, other in combinations(starts, 2)]
    assert min(gaps) > 0.1
    found = [candidate(problem, surrogate.polynomial, x).bounds for x in starts]
    misfit = [problem.misfit(bounds.lower, bounds.upper) for bounds in found]
    assert misfit == sorted(misfit)
