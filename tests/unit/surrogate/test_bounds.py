from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dalembert.errors import InputError
from dalembert.kernels.preparation import observed
from dalembert.surrogate import ChebyshevPolynomial, bounds
from dalembert.surrogate.basis import full_tensor, total_degree
from support import says


def interpolated(function, lower, upper, order: int) -> ChebyshevPolynomial:
    from dalembert.surrogate import Tensor, fit

    return fit(function, lower, upper, Tensor(order), held_out=0).polynomial


def test_bounds_of_a_monotone_function_are_at_corners() -> None:
    polynomial = interpolated(lambda p: np.exp(p[:, :1] - p[:, 1:]), [0.0, 0.0], [1.0, 1.0], 12)
    found = bounds(polynomial, [0.25, 0.25], [0.5, 0.75])
    np.testing.assert_allclose([found.lower[0], found.upper[0]], np.exp([-0.5, 0.25]), rtol=1e-12)
    assert found.at_lower.tolist() == [[0.25, 0.75]]
    assert found.at_upper.tolist() == [[0.5, 0.25]]


def test_the_search_alone_is_compiled_and_reported(nothing_compiled: Path) -> None:
    parabola = ChebyshevPolynomial([-1.0], [1.0], [[0], [2]], [[0.5], [0.5]])
    seen: list[tuple[int, int, str]] = []
    with observed(lambda *progress: seen.append(progress)):
        for method in ("scan", "bernstein"):
            bounds(parabola, [-1.0], [0.4], method)
        assert seen == []
        for _ in range(2):
            bounds(parabola, [-1.0], [0.4])
    assert seen == [(1, 1, "dal_surrogate_extremes_extremes")]


def test_bounds_of_an_interior_extreme_and_of_a_product() -> None:
    def function(points: np.ndarray) -> np.ndarray:
        x, y = points.T
        return np.column_stack([(x - 0.3) ** 2 + (y + 0.2) ** 2, x * y, -((x - 0.3) ** 2)])

    polynomial = interpolated(function, [-1.0, -1.0], [1.0, 1.0], 2)
    found = bounds(polynomial, [[-1, -1], [-0.5, 0.1]], [[1, 1], [0.4, 0.7]])
    np.testing.assert_allclose(found.lower, [[0, -1, -1.69], [0.09, -0.35, -0.64]], atol=1e-14)
    np.testing.assert_allclose(found.upper, [[3.13, 1, 0], [1.45, 0.28, 0]], atol=1e-14)
    np.testing.assert_allclose(found.at_lower[0, 0], [0.3, -0.2], atol=1e-7)
    assert found.at_lower[1, 1].tolist() == [-0.5, 0.7]


def test_bounds_of_oscillations_with_growing_phase() -> None:
    """cos(ωt), ω from 4 to 6, by formula: 1 where a multiple of 2π is passed, −1 where an odd multiple of π is."""
    times = np.linspace(0, 6, 61)
    polynomial = interpolated(lambda p: np.cos(p * times), [4.0], [6.0], 24)
    found = bounds(polynomial, [4.0], [6.0])
    low, high = 4 * times, 6 * times
    ends = np.cos([low, high])
    upper = np.where(np.floor(high / (2 * np.pi)) * 2 * np.pi >= low, 1, ends.max(axis=0))
    lower = np.where(np.floor((high - np.pi) / (2 * np.pi)) * 2 * np.pi + np.pi >= low, -1, ends.min(axis=0))
    np.testing.assert_allclose(found.upper, upper, atol=1e-11)
    np.testing.assert_allclose(found.lower, lower, atol=1e-11)


@pytest.fixture(scope="module")
def decaying() -> ChebyshevPolynomial:
    rng = np.random.default_rng(0)
    exponents = full_tensor((8, 6))
    size = 0.4 ** exponents.sum(axis=1)
    return ChebyshevPolynomial(
        [-1.0, 3.0], [2.0, 3.5], exponents, rng.normal(size=(len(exponents), 20)) * size[:, None]
    )


@pytest.fixture(scope="module")
def boxes(decaying: ChebyshevPolynomial) -> tuple[np.ndarray, np.ndarray]:
    ends = np.random.default_rng(1).uniform(size=(2, 40, 2))
    ends[:, :5, 0] = 0.4  # no width
    ends[0, 5:8], ends[1, 5:8] = 0, 1
    width = decaying.upper - decaying.lower
    return decaying.lower + ends.min(axis=0) * width, decaying.lower + ends.max(axis=0) * width


def test_enclosed_optimised_and_scanned_bounds_stand_in_order(decaying, boxes) -> None:
    optimised, scanned, enclosed = (bounds(decaying, *boxes, method) for method in ("optimise", "scan", "bernstein"))
    fine = bounds(decaying, *boxes, "scan", points=201)
    rounding = 1e-13
    assert np.all(enclosed.lower <= optimised.lower)
    assert np.all(enclosed.upper >= optimised.upper)
    assert enclosed.at_lower is None
    for inner in (scanned, fine):
        assert np.all(optimised.lower <= inner.lower + rounding)
        assert np.all(optimised.upper >= inner.upper - rounding)
    np.testing.assert_allclose(optimised.lower, fine.lower, atol=2e-3)
    size = np.abs(decaying.coefficients[1:]).sum(axis=0)
    assert np.all(optimised.lower - enclosed.lower <= 1.01e-6 * size + 1e-10)
    assert np.all(enclosed.upper - optimised.upper <= 1.01e-6 * size + 1e-10)


@pytest.mark.parametrize("method", ["optimise", "scan"])
def test_bounds_are_attained_where_they_are_said_to_be(decaying, boxes, method: str) -> None:
    found = bounds(decaying, *boxes, method)
    for values, places in ((found.lower, found.at_lower), (found.upper, found.at_upper)):
        assert np.all((places >= boxes[0][:, None]) & (places <= boxes[1][:, None]))
        everywhere = decaying(places.reshape(-1, 2)).reshape(*values.shape, -1)
        np.testing.assert_allclose(np.einsum("boo->bo", everywhere), values, atol=1e-13)


def test_at_an_optimum_no_free_slope_is_left(decaying, boxes) -> None:
    found = bounds(decaying, *boxes)
    places = found.at_lower
    slopes = np.einsum("bood->bod", decaying.gradient(places.reshape(-1, 2)).reshape(*places.shape[:2], -1, 2))
    inside = (places > boxes[0][:, None]) & (places < boxes[1][:, None])
    assert inside.any()
    np.testing.assert_allclose(slopes[inside], 0, atol=1e-5)


def test_a_box_is_bounded_alone_as_in_a_batch(decaying, boxes) -> None:
    for method in ("optimise", "scan", "bernstein"):
        batch = bounds(decaying, *boxes, method)
        alone = bounds(decaying, boxes[0][7], boxes[1][7], method)
        assert alone.lower.shape == (20,)
        np.testing.assert_allclose(alone.lower, batch.lower[7], atol=1e-14)
        np.testing.assert_allclose(alone.upper, batch.upper[7], atol=1e-14)


def test_a_gap_is_kept_and_a_loose_one_costs_sharpness_alone(decaying, boxes) -> None:
    hull, loose, tight = (bounds(decaying, *boxes, "bernstein", gap=gap) for gap in (np.inf, 1e-2, 1e-8))
    assert np.all(hull.lower <= loose.lower)
    assert np.all(loose.lower <= tight.lower)
    assert np.max(tight.lower - hull.lower) > 1e-2


def test_an_infinite_gap_is_the_hull_of_the_bernstein_coefficients_also_of_a_constant() -> None:
    flat = ChebyshevPolynomial([-1.0], [1.0], [[0], [2]], [[0.5, 3.0], [0.5, 0.0]])
    found = bounds(flat, [[-1.0]], [[1.0]], "bernstein", gap=np.inf)
    np.testing.assert_allclose(found.lower, [[-1.0, 3.0]], atol=1e-12)
    np.testing.assert_allclose(found.upper, [[1.0, 3.0]], atol=1e-12)


def test_many_directions_are_bounded_by_a_spread_of_starts() -> None:
    """Σ (x_k − k/20)², whose bounds are known, in ten directions."""
    places = np.arange(10) / 20
    exponents = np.unique(
        np.concatenate([0 * np.eye(10, dtype=int), np.eye(10, dtype=int), 2 * np.eye(10, dtype=int)]), axis=0
    )
    linear = np.argmax(exponents, axis=1)
    coefficients = np.where(exponents.sum(axis=1) == 1, -2 * places[linear], 0.5)
    coefficients[0] = np.sum(places**2) + 5
    polynomial = ChebyshevPolynomial(-np.ones(10), np.ones(10), exponents, coefficients[:, None])
    found = bounds(polynomial, -np.ones(10), np.ones(10))
    assert abs(found.lower[0]) < 1e-12
    np.testing.assert_allclose(found.upper[0], np.sum((1 + places) ** 2), rtol=1e-13)
    np.testing.assert_allclose(found.at_lower[0], places, atol=1e-7)
    enclosed = bounds(polynomial, -np.ones(10), np.ones(10), "bernstein", gap=np.inf)
    assert -10 < enclosed.lower[0] <= 0
    assert enclosed.upper[0] >= found.upper[0]


def refused(sentence: str, polynomial, lower, upper, *options, **more) -> None:
    with pytest.raises(InputError, match=says(sentence)):
        bounds(polynomial, lower, upper, *options, **more)


def test_what_cannot_be_meant_is_refused(decaying) -> None:
    box = decaying.lower, decaying.upper
    refused(
        "unknown method of bounding a polynomial 'bernstien'; did you mean 'bernstein'?", decaying, *box, "bernstien"
    )
    refused(
        "box 1 from [-1.0, 3.0] to [2.0, 3.6] was given; expected one inside that of the polynomial, "
        "from [-1.0, 3.0] to [2.0, 3.5]",
        decaying,
        [box[0], box[0]],
        [box[1], [2.0, 3.6]],
    )
    refused(
        "boxes with bounds of shapes (1,) and (2,) were given; expected (2,) or (boxes, 2) twice",
        decaying,
        [0.0],
        box[1],
    )
    refused("a gap of 0 was given for Bernstein bounds; expected a positive number", decaying, *box, "bernstein", gap=0)
    large = ChebyshevPolynomial(-np.ones(6), np.ones(6), 8 * np.eye(6, dtype=int), np.ones((6, 1)))
    refused(
        "the Bernstein form of degrees [8, 8, 8, 8, 8, 8] has 5.31e+05 coefficients an output, more than 100000; "
        "use fewer parameters or method 'optimise'",
        large,
        large.lower,
        large.upper,
        "bernstein",
    )


@st.composite
def polynomials(draw) -> ChebyshevPolynomial:
    directions = draw(st.integers(1, 3))
    exponents = total_degree(directions, draw(st.integers(0, 5)))
    numbers = st.floats(-10, 10, allow_subnormal=False)
    coefficients = draw(st.lists(numbers, min_size=len(exponents), max_size=len(exponents)))
    return ChebyshevPolynomial(-np.ones(directions), np.ones(directions), exponents, np.array(coefficients)[:, None])


@settings(max_examples=60, deadline=None)
@given(polynomials(), st.data())
def test_enclosures_hold_what_is_found_and_wider_boxes_have_wider_bounds(polynomial: ChebyshevPolynomial, data) -> None:
    directions = len(polynomial.lower)
    corners = st.lists(st.floats(-1, 1), min_size=directions, max_size=directions)
    ends = np.sort([data.draw(corners) for _ in range(4)], axis=0)
    inner, outer = (ends[1], ends[2]), (ends[0], ends[3])
    rounding = 1e-12 * (1 + np.abs(polynomial.coefficients).sum())
    small, large = (bounds(polynomial, *box, "bernstein", gap=1e-2) for box in (inner, outer))
    assert large.lower[0] <= bounds(polynomial, *inner).lower[0] + rounding
    assert large.upper[0] >= bounds(polynomial, *inner).upper[0] - rounding
    found = bounds(polynomial, *inner)
    assert small.lower[0] <= found.lower[0] + rounding
    assert small.upper[0] >= found.upper[0] - rounding
    samples = polynomial(inner[0] + (inner[1] - inner[0]) * np.random.default_rng(0).random((200, directions)))
    assert small.lower[0] <= samples.min()
    assert samples.max() <= small.upper[0]
    slack = 1e-2 * np.abs(polynomial.coefficients).sum() + rounding  # enclosures are sharp to the gap only
    assert large.lower[0] <= small.lower[0] + slack
    assert large.upper[0] >= small.upper[0] - slack
