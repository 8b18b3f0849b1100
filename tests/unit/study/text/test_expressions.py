"""Arithmetic in study files: right, exact in complex numbers, and nothing else than arithmetic."""

import math

import pytest

from dalembert.errors import InputError
from dalembert.study.text.expressions import Expression

VALUES = {"L": 2.0, "theta1": 0.7}


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("0.5*L", 1.0),
        ("-theta1", -0.7),
        ("+L", 2.0),
        ("pi/4", math.pi / 4),
        ("L**2 - 1", 3.0),
        ("-2**2", -4.0),
        ("(L + 1) * 2", 6.0),
        (" sqrt(L) ", math.sqrt(2)),
        ("L*cos(theta1) + sin(theta1)/tan(theta1)", 2 * math.cos(0.7) + math.cos(0.7)),
        ("7/2", 3.5),
        ("atan2(L, -2)", 3 * math.pi / 4),
        ("asin(-theta1)", -math.asin(0.7)),
        ("acos(theta1)", math.acos(0.7)),
        ("hypot(L, 1.5)", 2.5),
        ("abs(-L) + abs(theta1)", 2.7),
        ("exp(-theta1)", math.exp(-0.7)),
        ("log(L)", math.log(2)),
    ],
)
def test_value(text, value):
    expression = Expression.of(text)
    assert expression(VALUES) == pytest.approx(value, rel=1e-15)
    assert type(expression(VALUES)) is float


@pytest.mark.parametrize(
    "text",
    [
        *("L**2", "L**-1.5", "sqrt(L)/L", "sin(L)*cos(theta1)", "-L + 3", "tan(L*theta1)", "2**L"),
        *("atan2(L, -3)", "atan2(-1, -L)", "asin(L/3)", "acos(-L/3)", "hypot(-L, theta1)", "abs(theta1 - L)", "abs(L)"),
        *("exp(-L*theta1)", "log(L/3)"),
    ],
)
def test_complex_step_is_the_derivative(text):
    expression = Expression.of(text)
    exact = expression(VALUES | {"L": 2.0 + 1e-30j}).imag / 1e-30
    step = 1e-6
    difference = (expression(VALUES | {"L": 2 + step}) - expression(VALUES | {"L": 2 - step})) / (2 * step)
    assert exact == pytest.approx(difference, rel=1e-8)
    assert expression(VALUES | {"L": 2.0 + 1e-30j}).real == pytest.approx(expression(VALUES), rel=1e-15)


@pytest.mark.parametrize(
    "text",
    [
        "__import__('os').system('true')",
        "L.real",
        "[L]",
        "L if L else 1",
        "lambda: 1",
        "'text'",
        "1j",
        "True",
        "L @ L",
        "L % 2",
        "L // 2",
        "L < 1",
        "sin(L, L)",
        "atan2(L)",
        "hypot(L, L, L)",
        "log",
        "hypot",
        "sin(x=L)",
        "(L := 3)",
        "f'{L}'",
        "sin",
    ],
)
def test_what_is_no_arithmetic_is_refused(text):
    with pytest.raises(
        InputError, match=r"is not offered in an expression; expected names and numbers with|is no arithm"
    ):
        Expression.of(text)


@pytest.mark.parametrize("text", ["", "1 +", "L L", "(" * 200 + "1", "\0", "1" * 501])
def test_malformed_text_is_refused(text):
    with pytest.raises(InputError):
        Expression.of(text)({})


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("1/(L - 2)", "'1/(L - 2)' has no value: float division by zero"),
        ("(-8)**(1/3)", "'(-8)**(1/3)' is not a finite real number"),
        ("sqrt(-L)", "'sqrt(-L)' is not a finite real number for L = 2.0"),
        (
            "log(L - 3)",
            "'log(L - 3)' has no value for L = 2.0: a logarithm takes positive numbers, and got -1",
        ),
        ("log(0)", "'log(0)' has no value: a logarithm takes positive numbers, and got 0"),
        ("asin(L)", "'asin(L)' has no value for L = 2.0: an arc sine or cosine takes numbers from -1 to 1, and got 2"),
        (
            "acos(-L)",
            "'acos(-L)' has no value for L = 2.0: an arc sine or cosine takes numbers from -1 to 1, and got -2",
        ),
        ("exp(999*L)", "'exp(999*L)' is not a finite real number for L = 2.0"),
        ("1e308*10", "'1e308*10' is not a finite real number"),
        ("10.0**400", "'10.0**400' has no value: (34, 'Numerical result out of range')"),
        ("9**9**9**9", "'9**9**9**9' has no value: (34, 'Numerical result out of range')"),
    ],
)
def test_no_value(text, message):
    with pytest.raises(InputError) as caught:
        Expression.of(text)(VALUES)
    assert str(caught.value) == message


def test_an_unknown_function_names_the_near_one():
    with pytest.raises(InputError) as caught:
        Expression.of("sine(L)")
    assert str(caught.value) == "unknown function 'sine'; did you mean 'sin' or 'asin'?"
