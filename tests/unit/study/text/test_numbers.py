"""Keys that take numbers, and those that take many."""

import numpy as np
import pytest
from pydantic import TypeAdapter, ValidationError

from dalembert.errors import InputError
from dalembert.study.text.expressions import Expression
from dalembert.study.text.numbers import read_number, samples


@pytest.mark.parametrize(
    ("given", "unit", "value"),
    [(1, "m", 1.0), ("400 mm", "m", 0.4), ("pi/2", "rad", np.pi / 2), ("2*3", "", 6.0), ("-5 deg", "rad", -np.pi / 36)],
)
def test_numbers(given, unit, value):
    assert read_number(given, unit) == pytest.approx(value, rel=1e-15)


def test_an_expression_keeps_its_names():
    assert read_number("0.5*L + a", "m", ["L", "a"]) == Expression.of("0.5*L + a")


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (
            "0.5*l",
            "'0.5*l' was given, but unknown name 'l'; known: L, width; expected a length such as '400 mm' or 0.4 in m, "
            "or an expression of parameters and constants",
        ),
        (
            "widht",
            "'widht' was given, but unknown name 'widht'; did you mean 'width'?; expected a length such as '400 mm' or "
            "0.4 in m, or an expression of parameters and constants",
        ),
        ("3 kg", "'3 kg' was given; expected a length such as '400 mm' or 0.4 in m"),
        (None, "None was given; expected a length such as '400 mm' or 0.4 in m"),
    ],
)
def test_what_is_no_number_is_told(given, message):
    with pytest.raises(InputError) as caught:
        read_number(given, "m", ["L", "width"])
    assert str(caught.value) == message


@pytest.mark.parametrize(
    ("given", "values"),
    [
        ([0.0, "500 ms", 1], [0.0, 0.5, 1.0]),
        ({"end": 2, "count": 5}, [0.0, 0.5, 1.0, 1.5, 2.0]),
        ({"start": "1 s", "end": "2 s", "every": "500 ms"}, [1.0, 1.5, 2.0]),
        ({"end": 0.3, "every": 0.1}, [0.0, 0.1, 0.2, 0.3]),
    ],
)
def test_samples(given, values):
    assert TypeAdapter(samples("s")).validate_python(given) == pytest.approx(values, rel=1e-15)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"end": 2}, "expected either count or every beside start and end"),
        ({"end": 2, "count": 3, "every": 1}, "expected either count or every beside start and end"),
        ({"end": 0, "count": 3}, "start is 0 and end 0; expected an end after the start"),
        ({"end": 1, "count": 1}, "count is 1; expected at least 2"),
        (
            {"end": 1, "every": 0.3},
            "every is 0.3, which does not divide the 1 from start to end; "
            "expected a distance that does, or count instead",
        ),
        ({"end": 1, "count": 10**12}, "there would be 1e+12 numbers; expected at most 1000000"),
        ({"end": 1, "every": 1e-300}, "there would be 1e+300 numbers; expected at most 1000000"),
        ([0, 1, 1], "1 follows 1; expected numbers that increase"),
        ([], "an empty list was given; expected at least one number"),
        (["1 m"], "'1 m' was given; expected a time such as '20 ms' or 0.02 in s"),
    ],
)
def test_samples_that_cannot_be_meant(given, message):
    with pytest.raises(ValidationError) as caught:
        TypeAdapter(samples("s")).validate_python(given)
    assert [error["msg"] for error in caught.value.errors()] == [message]
