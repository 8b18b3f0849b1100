"""Regularised least squares against closed forms, and the weights chosen on an ill-posed problem."""

import numpy as np
import pytest

from dalembert.optimize import Regularised

RANDOM = np.random.default_rng(5)
MATRIX = RANDOM.standard_normal((30, 4)) * [1.0, 0.3, 0.01, 1e-4]
RIGHT = MATRIX @ np.ones(4) + 1e-3 * RANDOM.standard_normal(30)
WEIGHTS = np.array([1e-5, 1e-3, 0.1, 10.0])


def smooth(noise, seed=0):
    """An ill-posed problem, the moments of Hilbert's matrix at 100 values for 12 unknowns, all of them 1, and noise."""
    matrix = 1 / (np.linspace(0, 20, 100)[:, None] + np.arange(1, 13))
    return matrix, matrix @ np.ones(12) + noise * np.random.default_rng(seed).standard_normal(100)


def test_steps_and_norms_are_those_of_the_ridge_closed_form_for_all_weights_at_once():
    problem = Regularised.of(MATRIX, RIGHT)
    closed = [np.linalg.solve(MATRIX.T @ MATRIX + mu**2 * np.eye(4), MATRIX.T @ RIGHT) for mu in WEIGHTS]
    np.testing.assert_allclose(problem.steps(WEIGHTS), closed, rtol=1e-8)
    np.testing.assert_allclose(problem.step_norms(WEIGHTS), np.linalg.norm(closed, axis=1), rtol=1e-8)
    residuals = np.linalg.norm(closed @ MATRIX.T - RIGHT, axis=1)
    np.testing.assert_allclose(problem.residual_norms(WEIGHTS), residuals, rtol=1e-10)


def test_without_weight_the_step_is_the_least_squares_solution_and_the_shortest_where_there_are_many():
    np.testing.assert_allclose(Regularised.of(MATRIX, RIGHT).steps(0.0), np.linalg.lstsq(MATRIX, RIGHT)[0], rtol=1e-7)
    twins = np.ones((5, 2))
    np.testing.assert_allclose(Regularised.of(twins, np.full(5, 3.0)).steps(0.0), [1.5, 1.5])


def test_a_direction_that_only_rounding_sees_is_left_out_whatever_the_weight():
    rounding = 1e-12 * np.random.default_rng(3).standard_normal(30)
    matrix = np.stack([MATRIX[:, 0] + rounding, MATRIX[:, 0] - rounding, MATRIX[:, 1]], axis=1)
    problem = Regularised.of(matrix, RIGHT)
    assert np.max(np.abs(problem.steps([0.0, problem.least, problem.corner()]) @ [1, -1, 0])) < 1e-9
    plain = np.linalg.lstsq(matrix[:, [0, 2]], RIGHT)[0]
    np.testing.assert_allclose(problem.steps(0.0), [plain[0] / 2, plain[0] / 2, plain[1]], rtol=1e-9)
    assert problem.outside == pytest.approx(np.linalg.norm(matrix[:, [0, 2]] @ plain - RIGHT))


def test_the_curvature_is_that_of_the_curve_by_differences():
    problem, h = Regularised.of(MATRIX, RIGHT), 1e-3
    for mu in (3e-5, 2e-3, 0.4):
        near = mu * np.exp([-h, 0.0, h])
        x, y = np.log(problem.residual_norms(near)), np.log(problem.step_norms(near))
        (x1, y1), (x2, y2) = ((c[2] - c[0]) / 2 / h for c in (x, y)), ((c[2] - 2 * c[1] + c[0]) / h**2 for c in (x, y))
        assert problem.curvature(mu) == pytest.approx((x1 * y2 - y1 * x2) / np.hypot(x1, y1) ** 3, rel=1e-3)


@pytest.mark.parametrize("noise", [1e-3, 1e-5, 1e-7])
@pytest.mark.parametrize("choice", ["corner", "gcv", "discrepancy"])
def test_each_choice_tames_an_ill_posed_problem(choice, noise):
    """Unknowns of norm 3.5: least squares alone are wrong by 4e3 and more."""
    wrong = []
    for seed in range(6):
        matrix, right = smooth(noise, seed)
        problem = Regularised.of(matrix, right)
        known = (noise * np.sqrt(100 + 2 * np.sqrt(200)),) if choice == "discrepancy" else ()
        wrong.append(np.linalg.norm(problem.steps(getattr(problem, choice)(*known)) - 1))
        assert np.linalg.norm(np.linalg.lstsq(matrix, right)[0] - 1) > 1e3 * wrong[-1]
    assert np.median(wrong) < 0.2


def test_the_corner_lies_where_the_residual_begins_to_rise_and_the_step_has_fallen():
    problem = Regularised.of(*smooth(1e-5))
    corner = problem.corner()
    assert problem.curvature(corner) == pytest.approx(np.max(problem.curvature(problem.weights)), rel=0.1)
    assert problem.residual_norms(corner) < 1.5 * problem.outside
    assert problem.step_norms(corner) < 1.2 * np.sqrt(12)
    assert problem.step_norms(corner / 100) > 2 * problem.step_norms(corner)


def test_where_the_data_tell_all_there_is_no_corner_and_no_regularisation():
    matrix = np.linalg.qr(RANDOM.standard_normal((20, 3)))[0]
    problem = Regularised.of(matrix, matrix @ np.ones(3) + RANDOM.standard_normal(20))
    assert problem.corner() == problem.least
    assert problem.least < 1e-9


def test_noise_alone_asks_for_no_step():
    matrix = np.linalg.qr(RANDOM.standard_normal((50, 3)))[0]
    noise = RANDOM.standard_normal(50)
    noise -= 0.99 * matrix @ (matrix.T @ noise)
    problem = Regularised.of(matrix, noise)
    assert problem.gcv() == np.inf
    assert problem.discrepancy(1.01 * float(np.linalg.norm(noise))) == np.inf
    assert problem.steps(np.inf).tolist() == [0, 0, 0]


def test_the_discrepancy_leaves_a_residual_of_the_noise():
    problem = Regularised.of(MATRIX, RIGHT)
    for noise in (0.01, 0.5, 3.0):
        assert problem.residual_norms(problem.discrepancy(noise)) == pytest.approx(noise, rel=1e-9)
    assert problem.discrepancy(problem.outside / 2) == problem.least


def test_the_weight_of_a_length_takes_a_step_of_that_length():
    problem = Regularised.of(MATRIX, RIGHT)
    for length in (1e-6, 0.1, 1.0):
        assert problem.step_norms(problem.weight_of(length)) == pytest.approx(length, rel=1e-9)
    assert problem.weight_of(1e9) == problem.least


@pytest.mark.parametrize("values", [8, 12, 25])
def test_cross_validation_holds_with_few_values(values):
    """Errors of steps over that of the best weight, of 100 draws; plain cross-validation is far off in many of them."""
    matrix, off, plain = 1 / (np.linspace(0, 20, values)[:, None] + np.arange(1, 7)), [], []
    for seed in range(100):
        noise = 1e-3 * np.random.default_rng(seed).standard_normal(values)
        problem = Regularised.of(matrix, matrix @ np.ones(6) + noise)
        error = np.linalg.norm(problem.steps(problem.weights) - 1, axis=1)
        squares, kept = problem.singular**2, problem.weights[:, None] ** 2
        left = values - np.sum(squares / (squares + kept), axis=1)
        plain.append(error[np.argmin(problem.residual_norms(problem.weights) / left)] / error.min())
        off.append(np.linalg.norm(problem.steps(problem.gcv()) - 1) / error.min())
    assert np.median(off) < min(1.8, np.median(plain))
    assert np.quantile(off, 0.9) < 60
    assert np.quantile(plain, 0.9) > 300


def test_with_as_many_unknowns_as_values_nothing_is_left_to_validate_by():
    problem = Regularised.of(RANDOM.standard_normal((4, 4)), np.ones(4))
    assert problem.gcv() == problem.least
