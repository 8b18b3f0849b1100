import pytest

from dalembert import errors


@pytest.mark.parametrize("name", ["InputError", "ModelError", "SolveError", "DataError"])
def test_every_error_is_caught_by_the_base(name: str) -> None:
    with pytest.raises(errors.DalembertError, match=r"^the sentence$"):
        raise getattr(errors, name)("the sentence")


def test_an_unknown_name_is_answered_with_the_closest_one_and_the_place() -> None:
    sentence = errors.unknown("key", "densty", ["density", "length"], where="study.toml: bodies.OA")
    assert sentence == "study.toml: bodies.OA: unknown key 'densty'; did you mean 'density'?"


def test_a_name_close_to_none_is_answered_with_all_of_them_in_order() -> None:
    assert errors.unknown("method", "xyz", ["swarm", "gauss"]) == "unknown method 'xyz'; known: gauss, swarm"


def test_an_unknown_name_where_nothing_is_known_says_so() -> None:
    assert errors.unknown("channel", "x", []) == "unknown channel 'x'; known: none"
