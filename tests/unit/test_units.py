"""Units at the edge: what is converted, and what a user reads when it cannot be."""

import math

import pytest

from dalembert.errors import InputError
from dalembert.units import KNOWN, expected, is_quantity, is_si, si, symbol


@pytest.mark.parametrize(
    ("given", "unit", "value"),
    [
        (0.4, "m", 0.4),
        (2, "m", 2.0),
        ("0.4", "m", 0.4),
        ("400 mm", "m", 0.4),
        ("400mm", "m", 0.4),
        ("-3.5e2 mm", "m", -0.35),
        ("7.85 g/cm^3", "kg/m^3", 7850.0),
        ("45 deg", "rad", math.pi / 4),
        ("60 rpm", "rad/s", 2 * math.pi),
        ("3 1/s", "1/s", 3.0),
        ("5 %", "", 0.05),
        ("200 GPa", None, 2e11),
    ],
)
def test_quantities_become_si_numbers(given, unit, value):
    assert si(given, unit) == pytest.approx(value, rel=1e-15)


@pytest.mark.parametrize(
    ("given", "unit", "message"),
    [
        ("3 kg", "m", "length: '3 kg' was given; expected a length such as '400 mm' or 0.4 in m"),
        (
            "3 mmm",
            "m",
            "length: '3 mmm' was given, but the unit 'mmm' is unknown; expected a length such as '400 mm' or 0.4 in m",
        ),
        (True, "kg", "length: True was given; expected a mass such as '500 g' or 0.5 in kg"),
        (
            math.inf,
            "s",
            "length: inf was given, but it is not a finite number; expected a time such as '20 ms' or 0.02 in s",
        ),
        (
            "5 Hz",
            "rad/s",
            "length: '5 Hz' was given, but a frequency in Hz is no angular velocity: multiply it by 2 pi, or write it "
            "in rpm; expected an angular velocity such as '60 rpm' or 6.28319 in rad/s",
        ),
        ([1.0], "", "length: [1.0] was given; expected a number without a unit such as 0.3"),
    ],
)
def test_a_bad_quantity_is_told_in_a_sentence(given, unit, message):
    with pytest.raises(InputError) as caught:
        si(given, unit, where="length")
    assert str(caught.value) == message


@pytest.mark.parametrize(
    "text",
    ["3 m**9**9**9", "3 m**99999999", "3 m m)", "3 (", "3 m^", "3 __import__", "3 m" * 40, "1e999 m", "", " ", "m"],
)
def test_malformed_text_is_an_input_error_and_nothing_else(text):
    with pytest.raises(InputError):
        si(text, "m")


@pytest.mark.parametrize("unit", KNOWN)
def test_the_example_of_each_unit_is_right(unit):
    assert si(KNOWN[unit][1], unit) > 0
    assert is_si(unit)
    assert KNOWN[unit][1] in expected(unit)


def test_expressions_are_no_quantities():
    assert not any(map(is_quantity, ("2*L", "-theta1", "2 * L", "2", "2 / L", "pi/4", "2**3", "3 - L")))


@pytest.mark.parametrize("unit", ["9**9**9", "m**9**9**9", "(m", "m**99", "potato", "2 m", "m +s"])
def test_a_unit_that_is_none_is_refused_at_once(unit):
    assert not is_si(unit)


def test_the_symbol_of_what_a_text_measures():
    assert [symbol(text) for text in ("3 mm", "2 deg", "3 rpm", "4 MPa", "3 kg", "5")] == [
        *("m", "rad", "rad/s", "Pa", "kg"),
        "",
    ]
