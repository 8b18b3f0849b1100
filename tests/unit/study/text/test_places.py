"""Points of a mechanism as study files write them."""

import pytest

from dalembert.errors import InputError
from dalembert.study.text.expressions import Expression
from dalembert.study.text.places import Place, read_place


@pytest.mark.parametrize(
    ("given", "place"),
    [
        ("OA.end", Place("OA", "end")),
        ("bar-2.node3", Place("bar-2", "node3")),
        ("ground", Place()),
        ("ground(0.3, -100 mm)", Place(position=(0.3, -0.1))),
        ("ground(0, L/2, 90 deg)", Place(position=(0.0, Expression.of("L/2"), 1.5707963267948966))),
        ([1, "2 m"], Place(position=(1.0, 2.0))),
        ({"x": 1, "y": "L"}, Place(position=(1.0, Expression.of("L")))),
    ],
)
def test_places(given, place):
    assert str(read_place(given, ["L"])) == str(place)
    assert read_place(given, ["L"]) == place


@pytest.mark.parametrize("given", ["OA", "OA.", ".end", "OA.end.x", "", 3, None, {"x": 1}, {"x": 1, "y": 2, "z": 3}])
def test_what_is_no_place(given):
    with pytest.raises(InputError) as caught:
        read_place(given)
    assert str(caught.value) == (
        f"{given!r} was given; expected a point such as 'ground', 'OA.end', 'ground(0.3, 0)' or [0.3, 0.0]"
    )


def test_a_start_on_the_ground_needs_a_position():
    with pytest.raises(InputError, match=r"^'ground' was given; expected a point such as 'OA\.end',"):
        read_place("ground", bare=False)


@pytest.mark.parametrize("given", ["ground(1)", "ground()", [1], [1, 2, 3, 4], []])
def test_too_few_or_too_many_numbers(given):
    with pytest.raises(InputError, match=r"expected x and y|was given; expected a length"):
        read_place(given)


def test_a_comma_inside_brackets_belongs_to_the_expression() -> None:
    place = read_place("ground(hypot(3, 4), 2*(1 + hypot(0.3, (0.4))), atan2(1, -1))")
    assert place.position == pytest.approx((5.0, 3.0, 0.75 * 3.141592653589793))


@pytest.mark.parametrize(
    ("given", "place"),
    [
        ("OA.end", Place("OA", "end")),
        ("ground", Place()),
        ("ground(0.3, -100 mm, L)", Place(position=(0.3, -0.1, Expression.of("L")))),
        ([1, "2 m", 0], Place(position=(1.0, 2.0, 0.0))),
    ],
)
def test_places_in_space(given, place):
    assert read_place(given, ["L"], space=True) == place


@pytest.mark.parametrize("given", [[1, 2], "ground(1, 2)", [1, 2, 3, 4]])
def test_a_position_in_space_has_three_numbers(given):
    with pytest.raises(InputError) as caught:
        read_place(given, space=True)
    assert str(caught.value) == f"{given!r} was given; expected x, y and z in m, such as 'ground(0.3, 0, 1)'"


def test_the_keys_x_and_y_are_of_the_plane():
    with pytest.raises(InputError, match=r"expected a point such as 'ground', 'OA\.end', 'ground\(0\.3, 0, 1\)'"):
        read_place({"x": 1, "y": 2}, space=True)
