import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from inline_snapshot import snapshot

from dalembert.errors import InputError
from dalembert.intervals import Box, Interval
from refusals import refused
from support import says


@pytest.mark.parametrize("bounds", [(2.0, 1.0), (float("nan"), 1.0), (0.0, float("inf"))])
def test_an_interval_that_is_none_is_refused(bounds: tuple[float, float]) -> None:
    sentence = f"an interval of {bounds} was given; expected two finite numbers, the lower one first"
    with pytest.raises(InputError, match=says(sentence)):
        Interval(*bounds)


def test_an_interval_about_its_middle() -> None:
    assert Interval.about(-2.0, relative=0.05) == Interval(-2.1, -1.9)
    assert Interval.about(2.0, radius=0.5) == Interval(1.5, 2.5)
    exact = Interval(1.0, 1.0)
    assert (exact.middle, exact.radius, exact.width) == (1.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({}, "an interval about 1.0: expected either its radius or its relative radius, not both"),
        (
            {"radius": 1.0, "relative": 0.1},
            "an interval about 1.0: expected either its radius or its relative radius, not both",
        ),
        ({"radius": -1.0}, "an interval about 1.0: its radius is -1.0; expected zero or more"),
    ],
)
def test_an_interval_about_nothing_is_refused(options: dict[str, float], sentence: str) -> None:
    with pytest.raises(InputError, match=says(sentence)):
        Interval.about(1.0, **options)


def test_membership() -> None:
    assert 1.0 in Interval(1.0, 2.0)
    assert 2.1 not in Interval(1.0, 2.0)
    assert Interval(0.5, 1.5) not in Interval(1.0, 2.0)


@pytest.fixture
def box() -> Box:
    return Box.of({"a": (1.0, 3.0), "b": Interval(-1.0, 0.5), "c": 7})


def test_points_of_a_box_are_exact_at_its_ends(box: Box) -> None:
    assert box.points([[-1, -1, -1], [1, 1, 1], [0, 0, 0]]).tolist() == [[1, -1, 7], [3, 0.5, 7], [2, -0.25, 7]]
    odd = Box.of({"a": (0.1, 0.3), "b": (1e-9, 1.0 / 3)})
    assert odd.points([[-1, -1], [1, 1]]).tolist() == [odd.lower.tolist(), odd.upper.tolist()]


def test_corners_count_each_side_once(box: Box) -> None:
    assert box.corners().tolist() == [[1, -1, 7], [1, 0.5, 7], [3, -1, 7], [3, 0.5, 7]]


def test_what_a_box_holds(box: Box) -> None:
    assert dict(box.items()) == {"a": Interval(1, 3), "b": Interval(-1, 0.5), "c": Interval(7, 7)}
    assert (list(box), len(box), Box.of(box) is box) == (["a", "b", "c"], 3, True)
    assert box.contains([[1, 0, 7], [1, 0, 7.1], [0.9, 0, 7]]).tolist() == [True, False, False]
    np.testing.assert_array_equal(box.middle, [2, -0.25, 7])
    np.testing.assert_array_equal(box.radius, [1, 0.75, 0])


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ({"a": (2, 1)}, "interval of 'a': (2.0, 1.0) was given; expected two finite numbers, the lower one first"),
        (
            {"a": "wide"},
            "interval of 'a': 'wide' was given; expected two numbers (lower, upper), an Interval, or one number",
        ),
        (
            {"a": (1, 2, 3)},
            "interval of 'a': (1, 2, 3) was given; expected two numbers (lower, upper), an Interval, or one number",
        ),
    ],
)
def test_a_box_that_is_none_is_refused(given: dict, sentence: str) -> None:
    with pytest.raises(InputError, match=says(sentence)):
        Box.of(given)


def test_names_and_shapes_of_a_box_are_checked(box: Box) -> None:
    with refused(InputError, snapshot("unknown interval 'd'; known: a, b, c")):
        box["d"]
    with refused(InputError, snapshot("a box has one interval for each name; given more than once: a")):
        Box(("a", "a"), np.zeros(2), np.ones(2))
    sentence = "a box of 1 names has bounds of shapes (2,) and (1,); expected (1,) twice"
    with pytest.raises(InputError, match=says(sentence)):
        Box(("a",), np.zeros(2), np.ones(1))


finite = st.floats(-1e6, 1e6, allow_subnormal=False)


@given(st.lists(st.tuples(finite, finite), min_size=1, max_size=5), st.data())
def test_points_of_a_box_lie_in_it_and_its_corners_are_points(ends: list[tuple[float, float]], data) -> None:
    box = Box.of({f"p{place}": (min(pair), max(pair)) for place, pair in enumerate(ends)})
    eta = np.array(data.draw(st.lists(st.floats(-1, 1), min_size=len(ends), max_size=len(ends))))
    points = box.points(np.stack([eta, np.zeros_like(eta), np.sign(eta)]))
    slack = 1e-15 * np.maximum(np.abs(box.lower), np.abs(box.upper))
    assert np.all((points >= box.lower - slack) & (points <= box.upper + slack))
    assert np.all(box.contains(box.corners()))
    assert len(np.unique(box.corners(), axis=0)) == 2 ** np.count_nonzero(box.radius)
    np.testing.assert_allclose(points[1], box.middle, atol=2 * slack.max())
