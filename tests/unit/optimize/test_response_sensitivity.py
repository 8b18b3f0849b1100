"""Response sensitivity: ridge steps, agreement, bounds, failed samples, and cases where Gauss and Newton diverge."""

from itertools import pairwise

import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.optimize import Regularised, ResponseSensitivity
from dalembert.optimize.linear_model import LinearModel

TIMES = np.linspace(0, 1, 20)


def decay(x):
    return x[0] * np.exp(-x[1] * TIMES)


def slope(x):
    return np.stack([np.exp(-x[1] * TIMES), -x[0] * TIMES * np.exp(-x[1] * TIMES)], axis=1)


def told(residual, jacobian, lower, upper, start, **settings):
    """Minimum and the progress of each iteration."""
    seen = []
    found = ResponseSensitivity(**settings).minimise(residual, jacobian, lower, upper, start, on_iteration=seen.append)
    return found, seen


def gauss_newton(residual, jacobian, start, steps=30):
    x = np.array(start, dtype=float)
    for _ in range(steps):
        with np.errstate(all="ignore"):
            r, s = residual(x), jacobian(x)
            if not (np.all(np.isfinite(r)) and np.all(np.isfinite(s))):
                break
            x = x - np.linalg.lstsq(s, r)[0]
    return x


def test_parameters_come_back_from_exact_data_and_convergence_is_quadratic():
    data = decay([2.0, 3.0])
    found, seen = told(lambda x: decay(x) - data, slope, [0, 0], [10, 10], [8, 0.5])
    np.testing.assert_allclose(found.x, [2, 3], rtol=1e-9)
    assert found.success
    assert found.stationary
    errors = np.array([np.linalg.norm(one.x - [2, 3]) for one in seen])
    last = errors[(errors < 0.1) & (errors > 1e-12)]
    assert len(last) >= 3
    assert np.all(last[1:] < 3 * last[:-1] ** 2 + 1e-13)
    weights = np.array([one.regularised.mu for one in seen[-3:]])
    assert weights[-1] < 1e-3 * weights[0] or weights[-1] < 1e-6


def test_steps_of_a_linear_problem_are_those_of_the_ridge_closed_form():
    matrix = np.array([[1.0, 1.0], [1.0, 1.001], [1.0, 0.999]])
    data = matrix @ [0.4, 0.5] + [0.01, -0.01, 0.02]
    _, seen = told(lambda x: matrix @ x - data, lambda x: matrix, [-9, -9], [9, 9], [0, 0])
    account = seen[1].regularised
    closed = np.linalg.solve(matrix.T @ matrix + account.mu**2 * np.eye(2), matrix.T @ data)
    np.testing.assert_allclose(seen[1].x, closed, rtol=1e-6)
    assert account.chosen == account.mu == pytest.approx(Regularised.of(matrix, data).corner())
    assert account.mu > 1e-3
    assert account.agreement == pytest.approx(1)
    assert account.residual == pytest.approx(np.linalg.norm(data))
    place = np.argmin(np.abs(account.weights - account.mu))
    assert account.step_norms[place] == pytest.approx(account.length, rel=0.1)


def test_the_account_tells_agreement_trials_and_the_raised_weight():
    data = decay([2.0, 9.0])
    found, seen = told(lambda x: decay(x) - data, slope, [0, 0], [10, 10], [8, 0.1])
    assert seen[0].regularised is None
    accounts = [one.regularised for one in seen[1:]]
    assert 1 + sum(one.trials for one in accounts) <= found.evaluations
    assert all(one.agreement >= 0.5 for one in accounts)
    assert all(one.mu >= one.chosen for one in accounts)
    assert any(one.mu > one.chosen for one in accounts)
    for before, after in pairwise(seen):
        assert after.regularised.residual == pytest.approx(np.sqrt(before.best))
        assert after.regularised.length == pytest.approx(np.linalg.norm(after.x - before.x))


def test_where_gauss_and_newton_overshoot_ever_farther_this_converges():
    """The arctangent from beyond 1.39, the textbook case."""
    residual, jacobian = np.arctan, (lambda x: np.diag(1 / (1 + x**2)))
    assert np.abs(gauss_newton(residual, jacobian, [1.5]))[0] > 1e6
    found, _ = told(residual, jacobian, [-1e9], [1e9], [1.5])
    assert abs(found.x[0]) < 1e-9
    assert found.success


def two_decays(x):
    times = 4 * TIMES
    return x[0] * np.exp(-x[1] * times) + x[2] * np.exp(-x[3] * times)


def two_slopes(x):
    times = 4 * TIMES
    one, other = np.exp(-x[1] * times), np.exp(-x[3] * times)
    return np.stack([one, -x[0] * times * one, other, -x[2] * times * other], axis=1)


@pytest.mark.parametrize("rates", [(1.0, 1.02), (1.0, 1.1), (0.2, 0.3)])
def test_decays_that_start_nearly_alike_and_throw_gauss_and_newton_far_away_are_told_apart(rates):
    data, start = two_decays([1.0, 0.5, 1.5, 2.0]), [1.0, rates[0], 1.0, rates[1]]

    def residual(x):
        return two_decays(x) - data

    assert np.max(np.abs(gauss_newton(residual, two_slopes, start))) > 50
    found, seen = told(residual, two_slopes, [-20] * 4, [20] * 4, start)
    np.testing.assert_allclose(found.x, [1.0, 0.5, 1.5, 2.0], rtol=1e-8)
    assert np.linalg.svd(two_slopes(np.array(start)))[1][-1] < 1e-2
    assert found.evaluations < 20
    assert np.max(np.abs([one.x for one in seen])) < 5


@pytest.mark.parametrize("regularisation", ["l-curve", "gcv", "discrepancy"])
def test_a_pair_that_only_noise_tells_apart_does_not_run_away(regularisation):
    """The response sees a + b, and a − b a millionth as well: one full step goes 200 000 away."""
    data = np.exp(-0.9 * TIMES) + 1e-4 * np.random.default_rng(1).standard_normal(20)

    def residual(x):
        return np.exp(-(x[0] + x[1]) * TIMES + 1e-6 * (x[0] - x[1]) * TIMES**2) - data

    def jacobian(x):
        return (residual(x) + data)[:, None] * np.stack([-TIMES + 1e-6 * TIMES**2, -TIMES - 1e-6 * TIMES**2], axis=1)

    start = np.array([1.5, 0.2])
    assert np.max(np.abs(gauss_newton(residual, jacobian, start, steps=1))) > 2e5
    found, seen = told(residual, jacobian, [-1e6] * 2, [1e6] * 2, start, regularisation=regularisation, noise=1e-4)
    assert found.success
    assert found.x.sum() == pytest.approx(0.9, abs=2e-3)
    farthest = 200 if regularisation == "l-curve" else 10  # the minimum itself lies 130 away, within the noise
    assert np.max(np.abs([one.x for one in seen])) < farthest


@pytest.mark.parametrize("regularisation", ["l-curve", "gcv", "discrepancy"])
def test_what_the_response_does_not_see_stays_at_its_start(regularisation):
    """The response sees a + b alone, its jacobian a − b by rounding: once its step went to a bound."""
    rng = np.random.default_rng(1)
    data = np.exp(-0.9 * TIMES) + 1e-2 * rng.standard_normal(20)

    def residual(x):
        return np.exp(-(x[0] + x[1]) * TIMES) - data

    def jacobian(x):
        slope = -TIMES * (residual(x) + data)
        return np.stack([slope, slope], axis=1) + 1e-12 * rng.standard_normal((20, 2))

    found, seen = told(residual, jacobian, [-5, -5], [5, 5], [1.5, 0.2], regularisation=regularisation, noise=1e-2)
    assert found.success
    assert found.x[0] + found.x[1] == pytest.approx(0.9, abs=0.05)
    np.testing.assert_allclose([one.x[0] - one.x[1] for one in seen], 1.3, atol=1e-6)


def test_the_solution_of_a_linear_problem_at_a_bound_is_the_constrained_one():
    """Least (x + y − 3)² + (x − y)² with y ≤ 1: x = (3 − y + y)/2 at y = 1."""
    matrix, right = np.array([[1.0, 1.0], [1.0, -1.0]]), np.array([3.0, 0.0])
    found, seen = told(lambda x: matrix @ x - right, lambda x: matrix, [-5, -5], [5, 1], [0, 0])
    np.testing.assert_allclose(found.x, [1.5, 1.0], atol=1e-9)
    assert found.success
    assert len(seen) <= 5


def test_a_bound_that_is_met_does_not_stall_the_others():
    """From the bound of one parameter along a curved valley that leaves it again; clipped steps creep here."""

    def residual(x):
        return np.array([1 - x[0], 10 * (x[1] - x[0] ** 2)])

    def jacobian(x):
        return np.array([[-1.0, 0.0], [-20 * x[0], 10.0]])

    found, _ = told(residual, jacobian, [-2, 0], [2, 2], [-1.5, 0.0])
    np.testing.assert_allclose(found.x, [1, 1], atol=1e-9)
    held, _ = told(residual, jacobian, [-2, -2], [0.5, 2], [-1.5, 0.0])
    np.testing.assert_allclose(held.x, [0.5, 0.25], atol=1e-9)
    assert held.success


def test_the_step_between_bounds_is_the_minimum_there():
    random = np.random.default_rng(2)
    for _ in range(20):
        slopes, residual = random.standard_normal((9, 3)), 3 * random.standard_normal(9)
        down, up, mu = -random.uniform(0, 1, 3), random.uniform(0, 1, 3), 0.3
        step = LinearModel(residual, slopes, down, up).step(mu)
        downhill = -slopes.T @ (residual + slopes @ step) - mu**2 * step
        assert np.all((step >= down) & (step <= up))
        np.testing.assert_allclose(downhill[(step > down) & (step < up)], 0, atol=1e-9)
        assert np.all(downhill[step == down] <= 1e-9)
        assert np.all(downhill[step == up] >= -1e-9)


def test_held_by_its_bounds_it_ends_at_once():
    found = ResponseSensitivity().minimise(
        lambda x: np.append(x + 1, 2.0), lambda x: np.eye(3)[:, :2], [0, 0], [1, 1], [0, 0]
    )
    assert (found.success, found.evaluations, found.x.tolist()) == (True, 1, [0, 0])
    assert found.message == "converged: bounds hold all parameters that the residual changes with"


def test_a_failed_trial_shortens_the_step():
    """The first step from 3 overshoots to where the square root does not exist."""
    seen = []

    def residual(x):
        seen.append(x[0])
        with np.errstate(invalid="ignore"):
            return np.sqrt(x) - 0.1

    found = ResponseSensitivity().minimise(
        residual, lambda x: 0.5 / np.sqrt(x)[:, None], [-100], [100], [3.0], scale=10
    )
    assert min(seen) < 0
    np.testing.assert_allclose(found.x, 0.01, rtol=1e-8)


@pytest.mark.parametrize("regularisation", ["gcv", "discrepancy"])
def test_other_choices_end_within_the_noise_of_the_minimum(regularisation):
    noise = 0.01 * np.random.default_rng(3).standard_normal(20)
    data = decay([2.0, 3.0]) + noise
    found, _ = told(
        lambda x: (decay(x) - data) / 0.01, lambda x: slope(x) / 0.01, [0, 0], [10, 10], [3, 2],
        regularisation=regularisation, noise=1.0,
    )  # fmt: skip
    best, _ = told(lambda x: (decay(x) - data) / 0.01, lambda x: slope(x) / 0.01, [0, 0], [10, 10], [3, 2])
    assert found.success
    assert best.misfit <= found.misfit < 1.3 * best.misfit + 1
    np.testing.assert_allclose(found.x, [2, 3], atol=0.15)


def test_a_start_that_fails_is_told_and_not_raised():
    found = ResponseSensitivity().minimise(lambda x: x * np.nan, slope, [0, 0], [1, 1], [0.5, 0.5])
    assert (found.success, found.misfit, found.evaluations) == (False, np.inf, 1)
    assert found.message == "the first point could not be simulated"


def test_starting_at_the_solution_costs_one_residual():
    data = decay([2.0, 3.0])
    found = ResponseSensitivity().minimise(lambda x: decay(x) - data, slope, [0, 0], [10, 10], [2, 3])
    assert (found.evaluations, found.misfit, found.message) == (1, 0, "converged: the fit is perfect")


def test_a_residual_that_sees_nothing_ends_at_once():
    found = ResponseSensitivity().minimise(lambda x: np.ones(3), lambda x: np.zeros((3, 2)), [0, 0], [1, 1], [0.2, 0.3])
    assert (found.success, found.evaluations, found.x.tolist()) == (True, 1, [0.2, 0.3])
    assert found.message == "converged: the residual does not change with the parameters"


@pytest.mark.parametrize(
    ("setting", "what"), [({"trials": 3}, "3 trial points"), ({"iterations": 2}, "2 steps")], ids=["trials", "steps"]
)
def test_too_few_trials_or_steps_are_told(setting, what):
    data = decay([2.0, 3.0])
    found, _ = told(lambda x: decay(x) - data, slope, [0, 0], [10, 10], [8, 0.5], **setting)
    assert not found.success
    advice = f"allow more with ResponseSensitivity({next(iter(setting))}=...)"
    assert found.message == f"stopped after {what}, not converged; {advice}"


def test_the_path_does_not_depend_on_origin_and_unit_of_a_parameter():
    data, unit = decay([2.0, 3.0]), np.array([8.0, 0.25])
    one = ResponseSensitivity().minimise(lambda x: decay(x) - data, slope, [0, 0], [10, 10], [8, 0.5])
    other = ResponseSensitivity().minimise(
        lambda x: decay(x / unit - 64) - data,
        lambda x: slope(x / unit - 64) / unit,
        64 * unit,
        74 * unit,
        [72, 64.5] * unit,
        scale=unit,
    )
    assert one.evaluations == other.evaluations
    np.testing.assert_allclose(one.x, other.x / unit - 64, rtol=1e-9)


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ({"regularisation": "gvc"}, "ResponseSensitivity: unknown regularisation 'gvc'; did you mean 'gcv'?"),
        (
            {"regularisation": "discrepancy"},
            "ResponseSensitivity: regularisation 'discrepancy' needs noise, the standard deviation of a weighted "
            "residual; give noise=1.0 where the data have deviations",
        ),
        ({"noise": -1.0}, "ResponseSensitivity: noise is -1; expected a positive number"),
        ({"agreement": 0.9}, "ResponseSensitivity: agreement is 0.9; expected a number from 0.25 to 0.75"),
        ({"growth": 1.0}, "ResponseSensitivity: growth is 1; expected a number above 1"),
        ({"trials": 0}, "ResponseSensitivity: trials is 0; expected a whole number of at least 1"),
        ({"iterations": 0}, "ResponseSensitivity: iterations is 0; expected a whole number of at least 1"),
        ({"tolerance": 0.0}, "ResponseSensitivity: tolerance is 0; expected a number between 3e-16 and 1"),
        ({"gain": 2.0}, "ResponseSensitivity: gain is 2; expected a number between 3e-16 and 1"),
    ],
)
def test_wrong_settings_are_answered_in_a_sentence(settings, sentence):
    with pytest.raises(InputError) as error:
        ResponseSensitivity(**settings)
    assert str(error.value) == sentence
