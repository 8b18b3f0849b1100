"""Least squares with bounds, failed samples and exact jacobians."""

import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.optimize import LeastSquares

TIMES = np.linspace(0, 1, 20)


def decay(x):
    return x[0] * np.exp(-x[1] * TIMES)


def slope(x):
    return np.stack([np.exp(-x[1] * TIMES), -x[0] * TIMES * np.exp(-x[1] * TIMES)], axis=1)


def test_parameters_come_back_exactly_from_exact_data():
    data = decay([2.0, 3.0])
    found = LeastSquares().minimise(lambda x: decay(x) - data, slope, [0, 0], [10, 10], [8, 0.5])
    np.testing.assert_allclose(found.x, [2, 3], rtol=1e-12)
    assert found.success
    assert found.stationary
    assert found.misfit < 1e-26


def test_starting_at_the_solution_costs_one_residual():
    data = decay([2.0, 3.0])
    found = LeastSquares().minimise(lambda x: decay(x) - data, slope, [0, 0], [10, 10], [2, 3])
    assert (found.evaluations, found.misfit) == (1, 0)


def test_the_solution_of_a_linear_problem_at_a_bound_is_the_constrained_one():
    """Least (x + y − 3)² + (x − y)² with y ≤ 1: x = (3 − y + y)/2 at y = 1."""
    matrix, right = np.array([[1.0, 1.0], [1.0, -1.0]]), np.array([3.0, 0.0])
    found = LeastSquares(trials=200).minimise(lambda x: matrix @ x - right, lambda x: matrix, [-5, -5], [5, 1], [0, 0])
    np.testing.assert_allclose(found.x, [1.5, 1.0], atol=1e-6)


def test_a_failed_trial_shortens_the_step():
    """The first step from 3 overshoots to where the square root does not exist."""
    seen = []

    def residual(x):
        seen.append(x[0])
        with np.errstate(invalid="ignore"):
            return np.sqrt(x) - 0.1

    found = LeastSquares(trials=100).minimise(
        residual, lambda x: 0.5 / np.sqrt(x)[:, None], [-100], [100], [3.0], scale=10
    )
    assert min(seen) < 0
    np.testing.assert_allclose(found.x, 0.01, rtol=1e-8)


def test_a_start_that_fails_is_told_and_not_raised():
    found = LeastSquares().minimise(lambda x: x * np.nan, slope, [0, 0], [1, 1], [0.5, 0.5])
    assert (found.success, found.misfit, found.evaluations) == (False, np.inf, 1)
    assert found.message == "the first point could not be simulated"


def test_a_residual_that_sees_nothing_ends_at_once():
    found = LeastSquares().minimise(lambda x: np.ones(3), lambda x: np.zeros((3, 2)), [0, 0], [1, 1], [0.2, 0.3])
    assert (found.success, found.evaluations, found.x.tolist()) == (True, 1, [0.2, 0.3])
    assert found.message == "converged: the residual does not change with the parameters"


def test_too_few_trials_are_told():
    data = decay([2.0, 3.0])
    found = LeastSquares(trials=3).minimise(lambda x: decay(x) - data, slope, [0, 0], [10, 10], [8, 0.5])
    assert not found.success
    assert found.message == "stopped after 3 trial points, not converged; allow more with LeastSquares(trials=...)"
    assert found.evaluations == 3


def test_the_path_does_not_depend_on_where_the_origin_of_a_parameter_lies():
    data = decay([2.0, 3.0])
    one = LeastSquares().minimise(lambda x: decay(x) - data, slope, [0, 0], [10, 10], [8, 0.5])
    shifted = LeastSquares().minimise(
        lambda x: decay(x - 64) - data, lambda x: slope(x - 64), [64, 64], [74, 74], [72, 64.5]
    )
    assert one.evaluations == shifted.evaluations
    np.testing.assert_allclose(one.x, shifted.x - 64, rtol=1e-11)


def test_progress_is_told_at_the_start_and_after_each_accepted_step():
    data, seen = decay([2.0, 3.0]), []
    found = LeastSquares().minimise(
        lambda x: decay(x) - data, slope, [0, 0], [10, 10], [8, 0.5], on_iteration=seen.append
    )
    assert seen[0].iteration == 0
    assert seen[0].best == pytest.approx(np.sum((decay([8, 0.5]) - data) ** 2))
    assert np.all(np.diff([one.best for one in seen]) < 0)
    assert seen[-1].iteration == found.iterations


def valley(x):
    """Rosenbrock's residuals, and as many others as there are parameters more."""
    return np.array([1.0 - x[0], 100 * (x[1] - x[0] ** 2), *x[2:]])


def valley_slope(x):
    slopes = np.eye(len(x))
    slopes[:2, :2] = [[-1.0, 0.0], [-200 * x[0], 100.0]]
    return slopes


def test_a_coarse_descent_ends_after_a_step_that_gains_little():
    """In the valley the linear model always foresees a fall to zero."""
    coarse, fine = (
        LeastSquares(gain=gain).minimise(valley, valley_slope, [-2, -2], [2, 2], [-1.5, 1.0]) for gain in (0.5, 1e-3)
    )
    assert coarse.success
    assert coarse.evaluations < fine.evaluations / 5
    np.testing.assert_allclose(fine.x, 1.0, rtol=1e-8)


def test_one_of_many_descents_is_judged_sooner():
    """A constant residual of 20 makes the progress along the valley small: the sum of squares falls from 404 to 400."""
    many, last = (
        LeastSquares(gain=gain).minimise(
            lambda x: np.append(valley(x), 20.0),
            lambda x: np.vstack([valley_slope(x), np.zeros(5)]),
            [-2] * 5,
            [2] * 5,
            [-1.0, 1.0, 0.0, 0.0, 0.0],
        )
        for gain in (1e-3, 1e-14)
    )
    assert "stopped, not converged" in many.message
    assert many.evaluations < 25
    assert last.success
    np.testing.assert_allclose(last.misfit, 400.0)


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ({"trials": 0}, "LeastSquares: trials is 0; expected a whole number of at least 1"),
        ({"tolerance": 0.0}, "LeastSquares: tolerance is 0; expected a number between 3e-16 and 1"),
        ({"gain": 2.0}, "LeastSquares: gain is 2; expected a number between 3e-16 and 1"),
    ],
)
def test_wrong_settings_are_answered_in_a_sentence(settings, sentence):
    with pytest.raises(InputError) as error:
        LeastSquares(**settings)
    assert str(error.value) == sentence
