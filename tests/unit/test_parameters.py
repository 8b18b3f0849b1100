import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from dalembert.errors import InputError
from dalembert.parameter import Parameter
from dalembert.parameters import Parameters
from support import says


@pytest.fixture
def box() -> Parameters:
    return Parameters.of({"k": Parameter("k", -4.0, 2.0, unit="N/m"), "c": Parameter("c", 0, 1, scale=0.1, start=0.2)})


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        (
            {"lower": 2.0, "upper": 1.0},
            "parameter 'k': bounds are (2.0, 1.0); expected two finite numbers, the lower one first",
        ),
        ({"lower": 0.0, "upper": 1.0, "scale": "big"}, "parameter 'k': scale is 'big'; expected a number"),
        ({"lower": 0.0, "upper": 1.0, "start": [0.5]}, "parameter 'k': start is [0.5]; expected a number"),
        ({"lower": 0.0, "upper": 1.0, "deviation": True}, "parameter 'k': deviation is True; expected a number"),
        ({"lower": None, "upper": 1.0}, "parameter 'k': lower is None; expected a number"),
        ({"lower": 0.0, "upper": 1.0, "unit": 3}, "parameter 'k': unit is 3; expected a text such as 'Pa'"),
        ({"lower": 0.0, "upper": 1.0, "log": "yes"}, "parameter 'k': log is 'yes'; expected True, False or None"),
        (
            {"lower": 0.0, "upper": float("inf")},
            "parameter 'k': bounds are (0.0, inf); expected two finite numbers, the lower one first",
        ),
        (
            {"lower": float("nan"), "upper": 1.0},
            "parameter 'k': bounds are (nan, 1.0); expected two finite numbers, the lower one first",
        ),
        (
            {"lower": 0.0, "upper": 1.0, "scale": -2.0},
            "parameter 'k': scale is -2.0; expected a positive number",
        ),
        (
            {"lower": 0.0, "upper": 1.0, "start": 3.0},
            "parameter 'k': start 3.0 lies outside its bounds (0.0, 1.0); widen the bounds or move the start",
        ),
        (
            {"lower": 0.0, "upper": 1.0, "log": True},
            "parameter 'k': its logarithm is to be searched, but its lower bound is 0.0; "
            "expected a positive one; raise the bound or leave log out",
        ),
    ],
)
def test_a_parameter_that_cannot_be_meant_is_refused(options: dict[str, float], sentence: str) -> None:
    with pytest.raises(InputError, match=says(sentence)):
        Parameter("k", **options)


@pytest.mark.parametrize("bounds", [(1.0, 2.0, 3.0), 4.0, ("low", "high")])
def test_bounds_that_are_not_two_numbers_are_refused(bounds: object) -> None:
    with pytest.raises(
        InputError, match=says(f"parameter 'k': bounds are {bounds!r}; expected two numbers, (lower, upper)")
    ):
        Parameters.of({"k": bounds})  # type: ignore[dict-item]


def test_a_key_and_another_name_are_refused() -> None:
    sentence = "parameters: the key 'a' has the Parameter 'b'; expected the same name twice, or a list of Parameter"
    with pytest.raises(InputError, match=says(sentence)):
        Parameters.of({"a": Parameter("b", 0.0, 1.0)})


@pytest.mark.parametrize("given", [None, 3.5, "k", Parameter("k", 0.0, 1.0), object()])
def test_what_are_no_parameters_is_refused(given: object) -> None:
    with pytest.raises(InputError, match=r"^parameters are .*; expected a mapping from names to bounds, such as"):
        Parameters.of(given)  # type: ignore[arg-type]
    with pytest.raises(InputError, match=r"^parameters: .* was given; expected a Parameter, or a mapping to bounds"):
        Parameters.of([given] if not isinstance(given, Parameter) else [given, None])  # type: ignore[list-item]


def test_repeated_names_are_refused() -> None:
    with pytest.raises(InputError, match=says("parameter names must differ; repeated: k")):
        Parameters.of([Parameter("k", 0, 1), Parameter("k", 0, 2)])


def test_an_unknown_name_in_a_mapping_is_refused(box: Parameters) -> None:
    with pytest.raises(InputError, match=says("unknown parameter 'kk'; did you mean 'k'?")):
        box.vector({"kk": 1.0, "c": 0.0})


def test_a_missing_name_in_a_mapping_is_refused(box: Parameters) -> None:
    with pytest.raises(InputError, match=says("no value given for parameter 'c'; expected all of k, c")):
        box.vector({"k": 1.0})


def test_a_vector_of_another_length_is_refused(box: Parameters) -> None:
    sentence = "a parameter vector of shape (3,) was given; expected (2,) for k, c"
    with pytest.raises(InputError, match=says(sentence)):
        box.vector([1.0, 2.0, 3.0])


def test_scale_and_start_are_taken_from_the_bounds_unless_given(box: Parameters) -> None:
    assert box.scale.tolist() == [4.0, 0.1]
    assert box.start.tolist() == [-1.0, 0.2]


@pytest.mark.parametrize(
    ("bounds", "log", "logarithmic"),
    [
        ((1.0, 11.0), None, True),
        ((1.0, 10.0), None, False),
        ((-1.0, 100.0), None, False),
        ((1.0, 100.0), False, False),
        ((1.0, 2.0), True, True),
    ],
)
def test_the_logarithm_is_searched_where_bounds_span_more_than_a_decade(
    bounds: tuple[float, float], log: bool | None, logarithmic: bool
) -> None:
    assert Parameter("k", *bounds, log=log).logarithmic is logarithmic


def test_parameters_of_parameters_and_of_a_list_are_the_same(box: Parameters) -> None:
    assert Parameters.of(box) is box
    assert Parameters.of(list(box)) == box
    assert len(box) == 2


def test_clipping_moves_onto_the_nearest_bound(box: Parameters) -> None:
    assert box.clip(np.array([[-9.0, 0.5], [3.0, -1.0]])).tolist() == [[-4.0, 0.5], [2.0, 0.0]]


@given(st.lists(st.floats(allow_nan=False), min_size=2, max_size=2))
def test_mapping_and_vector_undo_each_other(values: list[float]) -> None:
    pair = Parameters.of({"a": (0, 1), "b": (0, 1)})
    assert pair.vector(pair.mapping(values)).tolist() == values


def test_a_vector_keeps_complex_numbers(box: Parameters) -> None:
    assert box.vector({"k": 1.0, "c": 1e-30j}).tolist() == [1.0, 1e-30j]
