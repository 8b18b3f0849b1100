"""A function that drops the imaginary part of a parameter is found by differences."""

from collections.abc import Callable

import numpy as np
import pytest

from dalembert import InputError, PythonModel
from dalembert.forward.complex_steps import lost_step

LOSING: dict[str, Callable] = {
    "abs": abs,
    "a part": lambda x: x**2 + np.abs(x),
    "real": np.real,
    "norm": lambda x: np.linalg.norm([x, 1.0]),
    "six decimals": lambda x: np.round(x, 6),
    "beside large numbers": lambda x: 1e9 + abs(x) * 1e3,
}
CARRYING: dict[str, Callable] = {
    "power": lambda x: x**3,
    "exponential": lambda x: np.exp(3 * x),
    "fast": lambda x: np.sin(400 * x),
    "steep": lambda x: np.tanh(1e3 * (x - 1.2)),
    "root": lambda x: np.sqrt(x - 1.2 + 1e-4),
    "large": lambda x: 2e11 * x**3 / 12,
    "tiny": lambda x: 1e-12 * x**2,
    "constant": lambda x: 0.0 * x + 1e6,
    "kink": lambda x: np.where(np.real(x) < 1.2, 1.2 - x, x - 1.2),
    "jump": lambda x: x + (np.real(x) > 1.2),
}


def numbers(function: Callable) -> Callable[[complex], np.ndarray]:
    return lambda shift: np.array([1.0, function(1.2 + shift)])


@pytest.mark.parametrize("name", LOSING)
def test_a_lost_step_is_found(name: str) -> None:
    lost = lost_step(numbers(LOSING[name]), 1.0)
    assert lost is not None
    assert lost.entry == 1
    assert lost.by_step != pytest.approx(lost.by_differences)


@pytest.mark.parametrize("name", CARRYING)
@pytest.mark.parametrize("scale", [0.1, 1.0, 10.0])
@pytest.mark.filterwarnings("ignore:invalid value encountered in sqrt:RuntimeWarning")
def test_a_function_that_carries_the_step_is_accepted(name: str, scale: float) -> None:
    assert lost_step(numbers(CARRYING[name]), scale) is None


def test_a_python_model_names_parameter_channel_and_sample() -> None:
    times = np.linspace(0.0, 1.0, 3)
    model = PythonModel(
        lambda rate, size: np.array([size + 0j * times, abs(rate) * times]).T,
        {"rate": (0.1, 2.0), "size": (1.0, 2.0)}, ["a", "b"], times,
    )  # fmt: skip
    with pytest.raises(InputError, match=r"channel 'b' \(sample \d\).* by 'rate' is 0 by the complex step, but"):
        model.jacobian(np.array([1.0, 1.5]))


def test_a_python_model_is_compared_once() -> None:
    calls = []

    def response(rate: complex) -> np.ndarray:
        calls.append(rate)
        return np.exp(-rate * np.linspace(0.0, 1.0, 3))

    model = PythonModel(response, {"rate": (0.1, 2.0)}, ["x"], np.linspace(0.0, 1.0, 3))
    model.jacobian(np.array([2.0]))
    assert len(calls) == 6  # four for the differences, two in complex numbers
    assert all(0.1 <= np.real(rate) <= 2.0 for rate in calls)
    model.jacobian(np.array([1.0]))
    model.first(2).jacobian(np.array([1.0]))
    assert len(calls) == 8
