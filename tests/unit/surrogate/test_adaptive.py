import numpy as np
import pytest

from dalembert.errors import InputError, SolveError
from dalembert.surrogate import Adaptive, Tensor, fit
from support import says

TIMES = np.linspace(0, 10, 51)
ONES = np.ones(10)


def growing(points: np.ndarray) -> np.ndarray:
    """An oscillation whose phase grows in time by ±10 at the end of its horizon, with an uncertain amplitude."""
    return np.cos((4 + points[:, :1]) * TIMES) * (1 + 0.3 * points[:, 1:])


def few_matter(points: np.ndarray) -> np.ndarray:
    """Ten parameters: two act strongly together, one alone, the others hardly."""
    strong = np.exp(0.5 * (points[:, 0] + 0.3) * (points[:, 1] + 0.5)) + np.sin(2 * points[:, 2])
    return (strong + points @ 0.03 ** np.arange(10))[:, None]


def wrong(surrogate, function, lower, upper) -> np.ndarray:
    """Largest error relative to the scale, from many points that lie denser towards the sides."""
    eta = -np.cos(np.pi * np.random.default_rng(11).random((4000, len(lower))))
    points = (np.add(upper, lower) + eta * np.subtract(upper, lower)) / 2
    return np.abs(surrogate(points) - function(points)).max(axis=0) / surrogate.scale


@pytest.mark.parametrize("tolerance", [1e-3, 1e-6, 1e-9])
@pytest.mark.parametrize("basis", ["sparse", "total-degree", "tensor"])
def test_the_tolerance_is_kept(basis: str, tolerance: float) -> None:
    function = lambda p: np.column_stack([np.exp(p[:, 0] * p[:, 1]), np.sin(p.sum(axis=1))])  # noqa: E731
    found = fit(function, [-1, 2], [0.5, 2.5], Adaptive(tolerance, basis=basis))
    assert np.all(wrong(found, function, [-1, 2], [0.5, 2.5]) < tolerance)
    found.demand(tolerance * found.scale)
    assert found.runs <= {1e-3: 50, 1e-6: 100, 1e-9: 140}[tolerance]


def test_directions_get_the_degrees_that_they_need() -> None:
    found = fit(growing, [-1, -1], [1, 1], Adaptive(1e-6))
    assert np.all(wrong(found, growing, [-1, -1], [1, 1]) < 1e-6)
    degrees = found.polynomial.degrees
    assert 18 <= degrees[0] <= 26
    assert degrees[1] <= 3
    assert found.runs < 70  # a tensor of as many as 24 and 2 takes 75, one of equal orders 625


def test_ten_parameters_of_which_few_matter_take_few_runs() -> None:
    found = fit(few_matter, -ONES, ONES, Adaptive(1e-3))
    assert wrong(found, few_matter, -ONES, ONES)[0] < 1e-3
    assert found.runs < 100
    assert np.all(found.polynomial.degrees[3:] <= 3)


def test_the_order_of_a_low_surrogate_is_refused_with_one_that_would_do() -> None:
    low = fit(growing, [-1, -1], [1, 1], Tensor((4, 2)))
    assert low.error.max() > 0.5
    with pytest.raises(
        SolveError, match=r"^the surrogate of order 4 is wrong by about .*; about order 8 is to be tried next"
    ):
        low.demand(1e-6)
    order = fit(growing, [-1, -1], [1, 1], Tensor((20, 2))).needed_order(1e-6)
    assert 21 <= order <= 26
    fit(growing, [-1, -1], [1, 1], Tensor((order, 2))).demand(1e-6)


def test_what_symmetry_hides_is_found_by_the_held_out_runs() -> None:
    """e^{xy} has no terms but (k, k), and neither x nor y does anything alone."""
    function = lambda p: np.exp(p[:, :1] * p[:, 1:])  # noqa: E731
    found = fit(function, [-1, -1], [1, 1], Adaptive(1e-6))
    assert wrong(found, function, [-1, -1], [1, 1])[0] < 1e-6


def test_it_ends_at_its_most_runs_and_says_its_error() -> None:
    found = fit(growing, [-1, -1], [1, 1], Adaptive(1e-6, most_runs=40))
    assert found.runs == 40
    assert wrong(found, growing, [-1, -1], [1, 1]).max() > 1e-3
    with pytest.raises(SolveError, match=r"allow more runs by Adaptive\(most_runs=...\), now 40, raise the tolerance"):
        found.demand(1e-6 * found.scale)


def test_every_run_is_kept_and_counted() -> None:
    told: list[int] = []
    batches: list[int] = []

    def counted(points: np.ndarray) -> np.ndarray:
        batches.append(len(points))
        return growing(points)

    found = fit(counted, [-1, -1], [1, 1], Adaptive(1e-4), on_runs=told.append)
    assert told == np.cumsum(batches).tolist()
    assert found.runs == told[-1] == len(found.points) == len(found.polynomial.exponents) + 10
    np.testing.assert_array_equal(found.values, growing(found.points))
    again = fit(growing, [-1, -1], [1, 1], Adaptive(1e-4))
    np.testing.assert_array_equal(found.polynomial.coefficients, again.polynomial.coefficients)


def test_a_constant_and_a_failed_run() -> None:
    still = fit(lambda p: np.full((len(p), 2), 3.0), [0.0], [1.0], Adaptive())
    assert still.runs == 13
    assert still([[0.3]]).tolist() == [[3.0, 3.0]]
    sentence = (
        "1 of 5 runs of an adaptive surrogate failed, the first at the point [0.0, -1.0]; it needs all of them; "
        "keep the box away from where the model fails, or use TotalDegree, which can do without some"
    )
    with pytest.raises(SolveError, match=says(sentence)):
        fit(lambda p: np.where(p[:, 1:] == -1, np.nan, p), [-1, -1], [1, 1], Adaptive())


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"tolerance": 0.0}, "Adaptive: tolerance is 0; expected a positive number"),
        ({"most_runs": 0}, "Adaptive: most_runs is 0; expected a whole number of at least 1"),
        ({"basis": "sparce"}, "Adaptive: unknown basis 'sparce'; did you mean 'sparse'?"),
    ],
)
def test_settings_that_cannot_be_meant_are_refused(options: dict, sentence: str) -> None:
    with pytest.raises(InputError, match=says(sentence)):
        Adaptive(**options)
