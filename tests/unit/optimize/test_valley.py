"""Long curved valleys, and plateaus where the jacobian loses its rank."""

import numpy as np
import pytest

from dalembert.optimize import LeastSquares
from dalembert.optimize.stopping import Stopped, Stopping

PLACES = np.linspace(7.5, 12.3, 40)
TRUTH = np.array([-2500.0, 46.7, 0.93])
DATA = TRUTH[0] * (TRUTH[1] + PLACES) ** (-1 / TRUTH[2]) + 2e-3 * np.random.default_rng(1).standard_normal(40)
LIMITS = np.array([20_000.0, 500.0, 8.5])


def residual(x):
    return x[0] * (x[1] + PLACES) ** (-1 / x[2]) - DATA


def jacobian(x):
    return np.stack([residual(x + step).imag / 1e-30 for step in 1e-30j * np.diag(np.ones(3))], axis=1)


def descent(start, **settings):
    counted = []

    def recorded(x):
        counted.append(x)
        return residual(x)

    found = LeastSquares(**settings).minimise(recorded, jacobian, -LIMITS, LIMITS, start, scale=LIMITS)
    return found, counted


@pytest.mark.parametrize("start", [[-2000.0, 50.0, 0.8], [-1500.0, 45.0, 0.85]])
def test_a_descent_reaches_the_end_of_a_curved_valley(start):
    """The gradient there, relative to the size of the columns and of the residual, is that of a minimum."""
    found, _ = descent(start)
    assert found.success
    slopes, rest = jacobian(found.x), residual(found.x)
    left = np.linalg.lstsq(slopes / np.linalg.norm(slopes, axis=0), rest, rcond=None)
    assert found.misfit - left[1][0] < 1e-12 * found.misfit


def test_a_descent_along_a_valley_keeps_to_its_trials_and_bounds():
    found, counted = descent([-1500.0, 45.0, 0.85], trials=40)
    assert not found.success
    assert found.message.startswith("stopped after 40 trial points, not converged")
    assert len(counted) == 40
    assert np.all(np.abs(counted) <= LIMITS)


def test_a_bound_in_the_valley_holds_the_minimum():
    limits = [LIMITS[0], 44.0, LIMITS[2]]
    found = LeastSquares().minimise(residual, jacobian, -np.array(limits), limits, [-1500.0, 43.0, 0.85], scale=LIMITS)
    assert found.success
    assert found.x[1] == pytest.approx(44.0, abs=1e-6)
    free = jacobian(found.x)[:, [0, 2]]
    parts = np.linalg.svd(free / np.linalg.norm(free, axis=0), full_matrices=False)[0].T @ residual(found.x)
    assert parts @ parts < 1e-10 * found.misfit


def test_hasty_descents_do_not_follow_a_valley():
    found, _ = descent([-1500.0, 45.0, 0.85], gain=1e-3)
    assert not found.success


def test_parameters_that_cannot_move_towards_a_far_minimum_have_not_converged():
    judge = Stopping(1e-13, 20)
    judge.at(np.array([1.0, 2.0]), np.array([[1e-3], [0.0]]), np.array([-9e9]), np.array([9e9]))
    assert not judge.at_rest(1e-8).success
    assert judge.foreseen == pytest.approx(0.2)


@pytest.mark.parametrize(("slope", "rough"), [(1e8, True), (np.inf, False)])
def test_parameters_at_rest_near_the_foreseen_minimum_have_converged(slope, rough):
    judge = Stopping(1e-13, 20)
    if np.isinf(slope):
        with pytest.raises(Stopped):
            judge.at(np.array([0.0, 2.0]), np.array([[1.0], [0.0]]), np.array([-9.0]), np.array([9.0]))
    else:
        judge.at(np.array([1.0, 2.0]), np.array([[slope], [0.0]]), np.array([-9.0]), np.array([9.0]))
    end = judge.at_rest(1e-8)
    assert (end.success, end.rough) == (True, rough)
