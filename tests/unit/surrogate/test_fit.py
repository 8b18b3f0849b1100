import numpy as np
import pytest

from dalembert.errors import InputError, SolveError
from dalembert.surrogate import Surrogate, Tensor, TotalDegree, fit
from support import says


def cubic(points: np.ndarray) -> np.ndarray:
    x, y = points[:, 0], points[:, 1]
    return np.column_stack([1 + x * y**2 - 3 * x**3, x + y])


def smooth(points: np.ndarray) -> np.ndarray:
    return np.column_stack([np.exp(points[:, 0] * points[:, 1]), np.sin(points.sum(axis=1))])


LOWER, UPPER = np.array([-1.0, 2.0]), np.array([0.5, 2.5])


@pytest.mark.parametrize("scheme", [TotalDegree(3), TotalDegree(3, 1.0), Tensor(3), Tensor((3, 2))])
def test_a_polynomial_is_found_again(scheme) -> None:
    found = fit(cubic, LOWER, UPPER, scheme)
    points = np.random.default_rng(0).uniform(LOWER, UPPER, (100, 2))
    np.testing.assert_allclose(found(points), cubic(points), atol=1e-12)
    assert found.held_out.max() < 1e-12
    assert found.runs == scheme.runs(2) + 10
    np.testing.assert_allclose(found.values, cubic(found.points), atol=0)


@pytest.mark.parametrize("scheme", [TotalDegree(4), TotalDegree(9), Tensor(3), Tensor(8)])
def test_the_error_is_that_of_a_scan_within_a_factor(scheme) -> None:
    found = fit(smooth, LOWER, UPPER, scheme)
    points = np.stack(np.meshgrid(*np.linspace(LOWER, UPPER, 41).T), axis=-1).reshape(-1, 2)
    true = np.abs(found(points) - smooth(points)).max(axis=0)
    assert np.all(found.error > true / 2)
    assert np.all(found.error < 10 * true)


def test_a_direction_without_width_costs_nothing() -> None:
    whole = fit(lambda p: cubic(p[:, [0, 2]]), [-1, 7, 2], [0.5, 7, 2.5], Tensor(3))
    assert whole.runs == 26
    np.testing.assert_allclose(whole([[0.3, 7, 2.2]]), cubic(np.array([[0.3, 2.2]])), atol=1e-12)
    point = fit(cubic, [0.3, 2.2], [0.3, 2.2], TotalDegree(2))
    np.testing.assert_allclose(point([[0.3, 2.2]]), cubic(np.array([[0.3, 2.2]])), atol=1e-12)
    assert point.error.tolist() == [0.0, 0.0]


def test_a_failed_run_is_left_out_where_it_can_be() -> None:
    def failing(points: np.ndarray) -> np.ndarray:
        return np.where((points[:, :1] < -0.5) & (points[:, 1:] < 2.2), np.nan, cubic(points))

    found = fit(failing, LOWER, UPPER, TotalDegree(3))
    assert found.failures > 0
    assert found.runs == 30
    assert len(found.points) == 30 - found.failures
    np.testing.assert_allclose(found([[0.3, 2.2]]), cubic(np.array([[0.3, 2.2]])), atol=1e-12)
    with pytest.raises(SolveError, match=r"^\d of 16 runs of a tensor surrogate failed, the first at the point "):
        fit(failing, LOWER, UPPER, Tensor(3))


def test_the_scale_of_an_output_is_the_largest_variation_of_its_group() -> None:
    def three(points: np.ndarray) -> np.ndarray:
        return points @ np.array([[1.0, 4.0, 100.0]])

    box = ([-1.0], [1.0])
    shared = fit(three, *box, TotalDegree(1, 2.0), groups=[0, 0, 1]).scale
    assert shared[0] == shared[1]
    np.testing.assert_allclose(shared / shared[0], [1, 1, 25])


def refused(message: str, function=cubic, lower=LOWER, scheme=None, **options) -> None:
    with pytest.raises(InputError, match=says(message)):
        fit(function, lower, UPPER, scheme or TotalDegree(2), **options)


def test_what_cannot_be_meant_is_refused() -> None:
    refused(
        "bounds are [1.0, 0.0] and [0.5, 2.5]; expected two finite vectors of equal length, lower <= upper",
        lower=[1.0, 0.0],
    )
    refused("held_out is -1; expected zero or more runs", held_out=-1)
    refused("groups of shape (3,) were given; expected (2,), one number an output", groups=[0, 1, 2])
    refused("the function returned an array of shape (10,) for 10 points; expected (10, outputs)", lambda p: p[:, 0])
    refused(
        "Tensor: 3 orders (2, 2, 2) were given for 2 directions with a width; "
        "expected one for each, or one number for all",
        scheme=Tensor((2, 2, 2)),
    )
    for make, sentence in {
        lambda: TotalDegree(0): "TotalDegree: order is 0; expected a whole number of at least 1",
        lambda: TotalDegree(2, 0.5): "TotalDegree: oversampling is 0.5; expected a number of at least 1",
        lambda: Tensor((2, 0)): "Tensor: order is (2, 0); expected at least 1 in each direction",
    }.items():
        with pytest.raises(InputError, match=says(sentence)):
            make()


def test_results_repeat_and_runs_are_told() -> None:
    told: list[int] = []
    first, second = (fit(smooth, LOWER, UPPER, Tensor(4), seed=5, on_runs=told.append) for _ in range(2))
    assert told == [10, 35, 10, 35]
    np.testing.assert_array_equal(first.polynomial.coefficients, second.polynomial.coefficients)
    np.testing.assert_array_equal(first.points, second.points)


def test_a_surrogate_that_is_wrong_is_refused_with_an_order_that_would_do() -> None:
    coarse: Surrogate = fit(smooth, LOWER, UPPER, Tensor(4))
    coarse.demand(1.1 * coarse.error)
    with pytest.raises(SolveError, match=r"^the surrogate of order 4 is wrong by about .* raise the tolerance") as told:
        coarse.demand(1e-9)
    order = coarse.needed_order(1e-9)
    assert f"about order {order} would do: take Tensor({order})," in str(told.value)
    assert order <= 20
    fit(smooth, LOWER, UPPER, Tensor(order)).demand(1e-9)


def test_a_tensor_of_millions_of_runs_is_refused_before_the_first() -> None:
    asked: list[int] = []
    with pytest.raises(SolveError, match="takes 43046721 runs, more than 1000000; lower the order, or use Adaptive"):
        fit(lambda p: np.sin(p.sum(axis=1))[:, None], -np.ones(8), np.ones(8), Tensor(8), on_runs=asked.append)
    assert asked == [16]  # the held-out runs
