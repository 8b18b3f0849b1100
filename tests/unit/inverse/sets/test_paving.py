"""Pavings and inner boxes against closed forms."""

from itertools import combinations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dalembert.inverse.sets.inner_box import inner_box
from dalembert.inverse.sets.paving import Limits, pave
from dalembert.surrogate import ChebyshevPolynomial, Tensor, fit


def squares(d):
    """Σ x² over [−2, 2]^d, as a polynomial."""
    return fit(lambda x: np.sum(x**2, axis=1, keepdims=True), [-2.0] * d, [2.0] * d, Tensor(2), held_out=0).polynomial


def limits(lower, upper, error=0.0):
    return Limits(np.array([(lower + upper) / 2]), np.array([(upper - lower) / 2]), np.array([error]))


def volume(boxes):
    return np.prod(boxes[:, 1] - boxes[:, 0], axis=1).sum()


SHAPES = [
    ("interval", 1, -1.0, 1.0, 2.0, 2.0),
    ("disc", 2, -1.0, 1.0, np.pi, 2 * np.pi),
    ("ring", 2, 0.5, 1.0, np.pi / 2, 2 * np.pi * (1 + 0.5**0.5)),
    ("ball", 3, -1.0, 1.0, 4 * np.pi / 3, 4 * np.pi),
    ("shell", 3, 0.5, 1.0, 4 * np.pi / 3 * (1 - 0.5**1.5), 4 * np.pi * 1.5),
]


@pytest.mark.parametrize(
    ("name", "d", "lower", "upper", "exact", "surface"), SHAPES, ids=[shape[0] for shape in SHAPES]
)
def test_the_volume_of_a_closed_form_lies_between_those_of_the_inside_and_of_all_boxes(
    name, d, lower, upper, exact, surface
):
    """And the boundary is no more than two boxes thick."""
    resolution = 1 / 32 if d == 3 else 1 / 128
    paving = pave(squares(d), limits(lower, upper), resolution, 10**6)
    assert paving.finished
    assert volume(paving.inside) < exact < volume(paving.inside) + volume(paving.boundary)
    assert volume(paving.boundary) <= 2 * (4 * resolution) * surface
    assert 1 <= np.abs(np.array(paving.hull)).max() <= 1 + 4 * resolution


@pytest.mark.parametrize("d", [1, 2, 3])
def test_a_point_lies_in_the_boxes_that_it_must(d):
    paving = pave(squares(d), limits(0.5, 1.0), 1 / 16, 10**6)
    points = np.random.default_rng(d).uniform(-2, 2, (2000, d))
    size = np.sum(points**2, axis=1)

    def within(boxes):
        return np.any(np.all((boxes[:, 0] <= points[:, None]) & (points[:, None] <= boxes[:, 1]), axis=2), axis=1)

    inside, boundary = within(paving.inside), within(paving.boundary)
    consistent = (size >= 0.5) & (size <= 1)
    assert np.all(consistent[inside])
    assert np.all((inside | boundary)[consistent])


def test_boxes_meet_only_in_their_faces():
    paving = pave(squares(2), limits(0.5, 1.0), 1 / 16, 10**5)
    for one, other in combinations(np.concatenate([paving.inside, paving.boundary]), 2):
        overlap = np.minimum(one[1], other[1]) - np.maximum(one[0], other[0])
        assert np.any(overlap <= 0)


def test_the_error_of_the_surrogate_makes_the_inside_smaller_and_the_whole_larger():
    exact, wider = (pave(squares(2), limits(-1.0, 1.0, error), 1 / 64, 10**5) for error in (0.0, 0.2))
    assert volume(wider.inside) < np.pi * 0.8 < volume(exact.inside)
    assert volume(wider.inside) + volume(wider.boundary) > np.pi * 1.2 > volume(exact.inside) + volume(exact.boundary)


def test_every_output_counts():
    """A strip along each axis: their intersection is a square."""
    polynomial = ChebyshevPolynomial([-2.0, -2.0], [2.0, 2.0], [[1, 0], [0, 1]], [[2.0, 0.0], [0.0, 2.0]])
    paving = pave(polynomial, Limits(np.array([-0.25, 0.75]), np.array([0.75, 0.75]), np.zeros(2)), 1 / 64, 10**5)
    np.testing.assert_allclose(paving.hull, [[-1.0, 0.0], [0.5, 1.5]], atol=4 / 64)
    assert volume(paving.inside) <= 1.5**2 <= volume(paving.inside) + volume(paving.boundary)
    inner = inner_box(paving.inside)
    np.testing.assert_allclose(inner, [[-1.0, 0.0], [0.5, 1.5]], atol=2 * 4 / 64)


def test_an_empty_set_has_no_boxes():
    paving = pave(squares(2), limits(9.0, 10.0), 1 / 16, 10**5)
    assert len(paving.inside) == len(paving.boundary) == 0
    assert paving.hull is None


def test_too_few_boxes_end_the_paving_early_and_it_still_holds_the_set():
    paving = pave(squares(2), limits(-1.0, 1.0), 1 / 256, 100)
    assert not paving.finished
    assert volume(paving.inside) < np.pi < volume(paving.inside) + volume(paving.boundary)


def test_it_tells_of_its_boxes():
    told = []
    paving = pave(squares(2), limits(-1.0, 1.0), 1 / 16, 10**5, lambda *numbers: told.append(numbers))
    assert told[-1] == (len(paving.inside), len(paving.boundary), 0)
    assert max(waiting for _, _, waiting in told) > 0


def test_the_inner_box_of_a_disc_is_nearly_the_largest_square_in_it():
    inner = inner_box(pave(squares(2), limits(-1.0, 1.0), 1 / 128, 10**5).inside)
    sides = inner[1] - inner[0]
    assert np.all(np.sum(np.maximum(np.abs(inner[0]), np.abs(inner[1])) ** 2) <= 1)
    assert np.prod(sides) > 0.93 * 2


def test_no_boxes_have_no_inner_box():
    assert inner_box(np.empty((0, 2, 2))) is None


@settings(max_examples=30, deadline=None)
@given(st.sets(st.tuples(st.integers(0, 4), st.integers(0, 4)), min_size=1, max_size=15))
def test_an_inner_box_is_covered_and_no_smaller_than_any_of_the_boxes(cells):
    boxes = np.array([[cell, (cell[0] + 1, cell[1] + 1)] for cell in sorted(cells)], dtype=float)
    inner = inner_box(boxes)
    assert np.prod(inner[1] - inner[0]) >= 1
    corner, end = inner.astype(int)
    assert {(i, j) for i in range(corner[0], end[0]) for j in range(corner[1], end[1])} <= cells
