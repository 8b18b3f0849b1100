"""Functions that carry a complex step, against central differences and NumPy."""

from collections.abc import Callable

import numpy as np
import pytest

from dalembert import absolute, atan2, hypot, norm

STEP = 1e-30
FUNCTIONS: dict[str, Callable] = {
    "absolute": lambda x: absolute(np.sin(3 * x)),
    "absolute of an array": lambda x: absolute(np.array([x - 1, 1 - x, 2.0 * x])) @ np.array([1.0, 2.0, 3.0]),
    "hypot": lambda x: hypot(x, 2 - x),
    "hypot of arrays": lambda x: np.sum(hypot(np.array([x, 1.0]), np.array([3.0, x * x]))),
    "norm": lambda x: norm([x, x**2, 1.0]),
    "atan2": lambda x: atan2(x - 2, 0.3 - x),
    "atan2 of arrays": lambda x: np.sum(atan2(np.array([x, 1.0]), np.array([-1.0, x]))),
}


@pytest.mark.parametrize("name", FUNCTIONS)
@pytest.mark.parametrize("x", [0.37, 1.21, -0.8])
def test_the_complex_step_is_the_slope(name: str, x: float) -> None:
    function = FUNCTIONS[name]
    slope = (function(x + 1e-6) - function(x - 1e-6)) / 2e-6
    lifted = function(x + 1j * STEP)
    assert lifted.imag / STEP == pytest.approx(slope, rel=1e-8, abs=1e-9)
    assert lifted.real == pytest.approx(function(x), rel=1e-15)


@pytest.mark.parametrize("x", [-2.5, 0.0, 3.0])
@pytest.mark.parametrize("y", [-1.5, 0.0, 4.0])
def test_real_numbers_give_numpys_values(x: float, y: float) -> None:
    assert absolute(x) == abs(x)
    assert hypot(x, y) == np.hypot(x, y)
    assert norm([x, y]) == pytest.approx(np.hypot(x, y), rel=1e-15)
    assert atan2(y, x) == np.arctan2(y, x)
    assert all(np.isrealobj(value) for value in (absolute(x), hypot(x, y), norm([x, y]), atan2(y, x)))


def test_the_length_of_a_zero_vector_is_zero() -> None:
    assert hypot(0j, 0j) == norm([0j, 0j]) == 0
