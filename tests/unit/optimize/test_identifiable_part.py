"""Descents that creep along directions which the residuals do not identify."""

import numpy as np
import pytest

from dalembert.optimize import LeastSquares, ResponseSensitivity
from dalembert.optimize.identifiable_part import creeps, identifiable_part
from dalembert.optimize.sum_of_squares import SumOfSquares
from inseparable import product

TIMES = np.linspace(0, 2, 81)
NOISE = 1e-2
DATA = product(1.0, 1.5, TIMES) + NOISE * np.random.default_rng(0).standard_normal(81)


class Noise:
    """White noise, and an error of the residuals if one is given."""

    def __init__(self, error=None, white=True):
        self.systematic, self.is_white = error, white

    def white(self, point):
        return self.is_white

    def error(self, point):
        return self.systematic


def residual(x):
    return product(*x, TIMES) - DATA


def jacobian(x):
    return np.stack([residual(x + step).imag / 1e-30 for step in 1e-30j * np.eye(2)], axis=1)


def descent(method, start, **settings):
    return method.minimise(residual, jacobian, [0.1, 0.1], [5.0, 5.0], start, **settings)


@pytest.mark.parametrize("start", [[3.0, 0.4], [0.3, 4.0]])
@pytest.mark.parametrize("method", [LeastSquares(), ResponseSensitivity()])
def test_a_descent_ends_where_the_identifiable_combination_has_converged(method, start):
    found = descent(method, start, disturbance=Noise())
    assert (found.success, len(found.left_out)) == (True, 1)
    assert found.message.endswith(", in the identifiable directions")
    assert found.evaluations <= 12
    # The product has its least squares value, and the factors stay near those of the start.
    alone = LeastSquares().minimise(
        lambda p: np.sin(p[0] * TIMES) - DATA, lambda p: (TIMES * np.cos(p[0] * TIMES))[:, None], [0.1], [9.0], [1.2]
    )
    assert np.prod(found.x) == pytest.approx(alone.x[0], abs=1e-3)
    np.testing.assert_allclose(found.x, start, rtol=0.3)


def test_without_a_disturbance_all_directions_count():
    found = descent(LeastSquares(), [3.0, 0.4])
    assert found.left_out is None
    assert found.evaluations > 50


def parts(residual, slopes, disturbance, fall=0.0):
    box = np.ones(slopes.shape[1])
    problem = SumOfSquares(abs, abs, 0 * box, box, box, abs, abs, disturbance)
    return identifiable_part(problem, 0.5 * box, residual, slopes, fall)


def left_out(*arguments):
    return len(parts(*arguments).left_out)


def rows(*columns):
    """Slopes along 42 residuals of variance 1/40 of their sum of squares, one unit in the rows of each column."""
    slopes = np.zeros((42, len(columns)))
    for k, size in enumerate(columns):
        slopes[k, k] = size
    return slopes


RESIDUAL = np.where(np.arange(42) < 2, 1e-3, 1.0)


def test_a_direction_is_left_out_where_the_noise_exceeds_the_bounds():
    """The standard deviations are 1/s widths; the standard deviation between the bounds is 0.289."""
    assert left_out(RESIDUAL, rows(100.0, 3.5), Noise()) == 0
    part = parts(RESIDUAL, rows(100.0, 3.4), Noise())
    np.testing.assert_allclose(np.abs(part.left_out), [[0.0, 1.0]], atol=1e-12)
    np.testing.assert_allclose(part.slopes, rows(100.0, 0.0), atol=1e-12)
    assert part.final


@pytest.mark.parametrize("fall", [1.0, 1e-3])
def test_a_small_singular_value_alone_is_not_unidentifiable(fall):
    tiny = 1e-9 * RESIDUAL
    assert left_out(tiny, rows(1.0, 1e-7), Noise(), fall * 1e-18) == 0
    assert left_out(tiny, rows(1.0, 1e-11), Noise(), fall * 1e-18) == 1  # rounding of the slopes


@pytest.mark.parametrize(("white", "most"), [(True, 2.0), (False, 1.0)])
def test_a_direction_counts_while_its_foreseen_fall_is_significant(white, most):
    for part, number in ((0.95, 1), (1.05, 0)):
        steep = np.where(np.arange(42) == 1, part * most, RESIDUAL)
        steep[2:] *= np.sqrt((40 - (part * most) ** 2) / 40)
        assert left_out(steep, rows(100.0, 1.0), Noise(white=white)) == number


def test_an_error_of_the_residuals_makes_a_direction_unidentifiable():
    error = np.where(np.arange(42) == 1, 30.0, 0.0)
    assert left_out(RESIDUAL, rows(1e4, 100.0), Noise()) == 0
    assert left_out(RESIDUAL, rows(1e4, 100.0), Noise(error)) == 1
    assert left_out(RESIDUAL, rows(1e4, 105.0), Noise(error)) == 0


def test_a_descent_goes_on_while_the_identifiable_directions_have_not_converged():
    far = np.where(np.arange(42) == 0, 3.0, RESIDUAL)
    part = parts(far, rows(100.0, 1e-3), Noise())
    assert (len(part.left_out), part.final) == (1, False)


def test_as_many_values_as_parameters_leave_nothing_out():
    assert left_out(RESIDUAL[:2], rows(100.0, 1e-3)[:2], Noise()) == 0


@pytest.mark.parametrize(
    ("before", "now", "foreseen", "creeping"),
    [(1.0, 0.999, 0.5, True), (1.0, 0.9, 0.5, False), (1.0, 0.96, 0.5, False), (1.0, 1 - 1e-9, 5e-9, False)],
)
def test_a_step_creeps_that_reaches_little_of_what_was_foreseen(before, now, foreseen, creeping):
    assert creeps(before, now, foreseen) is creeping
