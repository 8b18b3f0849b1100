"""A function that drops the imaginary part of a parameter is found by differences."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from dalembert import InputError, Measurements, PythonModel, identify, predict
from dalembert.forward import Checkpoint, Recorded
from dalembert.forward.complex_steps import lost_step, stepped
from dalembert.forward.wrapped import Wrapped

LOSING: dict[str, Callable] = {
    "abs": abs,
    "a part": lambda x: x**2 + np.abs(x),
    "real": np.real,
    "norm": lambda x: np.linalg.norm([x, 1.0]),
    "six decimals": lambda x: np.round(x, 6),
    "logarithm": lambda x: -1j * np.log(np.cos(x) + 1j * np.sin(x)),
    "a small part from a logarithm": lambda x: x + 1e-3j * np.log(np.cos(x) + 1j * np.sin(x)),
    "beside large numbers": lambda x: 1e9 + abs(x) * 1e3,
}


def logistic(x: complex) -> np.ndarray:
    """A map that doubles small changes in each of its 80 steps."""
    values = [0.25 * x]
    for _ in range(80):
        values.append(3.9 * values[-1] * (1 - values[-1]))
    return np.array(values)


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
ROUNDING: dict[str, Callable] = {
    "three decimals": lambda x: np.round(x, 3),
    "two decimals": lambda x: np.round(x, 2),
    "quarters": lambda x: np.floor(4 * np.real(x)) / 4,
    "inside": lambda x: np.sin(3 * np.round(x, 3)),
    "a part": lambda x: x**2 + np.round(x, 3),
    "a factor": lambda x: (x * np.round(x, 3)) ** -3,
}
SMOOTH_OR_KINKED: dict[str, Callable] = {
    "very fast": lambda x: np.sin(4e5 * x),
    "very steep": lambda x: np.tanh(1e6 * (x - 1.2)),
    "several steep": lambda x: sum(np.tanh(1e4 * (x - c)) for c in np.linspace(0.6, 1.9, 9)),
    "dead zone": lambda x: np.where(np.real(x) < 1.3, 0 * x, x - 1.3),
    "saturated": lambda x: np.where(np.real(x) > 1.5, 1.5 + 0 * x, x),
    "one choice": lambda x: np.where(np.real(x) > 1.25, 2.0, 1.0) + 0 * x,
    "high power": lambda x: x**-12,
    "pulse": lambda x: np.exp(-1e6 * (x - 1.2) ** 2),
    "cancelled": lambda x: (3 * x - x) - 2 * x + (np.sin(x) ** 2 + np.cos(x) ** 2 - 1),
    "nearly cancelled": lambda x: 1e-9 * x + (np.exp(x) * np.exp(-x) - 1),
    "zigzag": lambda x: np.where(np.real(x) * 50 % 2 < 1, 1.0, -1.0) * (50 * x - np.round(50 * np.real(x))),
}


def numbers(function: Callable) -> Callable[[complex], np.ndarray]:
    return lambda shift: np.array([1.0, function(1.2 + shift)])


@pytest.mark.parametrize("name", LOSING)
def test_a_lost_step_is_found(name: str) -> None:
    lost = lost_step(numbers(LOSING[name]), 1.0)
    assert lost is not None
    assert lost.entry == 1
    assert lost.by_step != pytest.approx(lost.by_differences)


@pytest.mark.parametrize("name", [*CARRYING, "cancelled", "nearly cancelled"])
@pytest.mark.parametrize("scale", [0.1, 1.0, 10.0])
@pytest.mark.filterwarnings("ignore:invalid value encountered in sqrt:RuntimeWarning")
def test_a_function_that_carries_the_step_is_accepted(name: str, scale: float) -> None:
    assert lost_step(numbers({**CARRYING, **SMOOTH_OR_KINKED}[name]), scale) is None


def test_a_steep_function_whose_slope_is_wrong_is_found() -> None:
    """Its increment over the step of the differences is saturated, so only smaller steps have its slope."""
    steep = numbers(lambda x: np.tanh(1e6 * (np.real(x) - 1.2)) + 3e6j * np.imag(x))
    assert lost_step(numbers(lambda x: np.tanh(1e6 * (x - 1.2))), 1.0) is None
    assert lost_step(steep, 1.0) is not None


def test_a_chaotic_function_carries_the_step_though_differences_cannot_follow_it() -> None:
    for at in (1.2, 1.2345, 0.77):
        assert lost_step(lambda shift, at=at: logistic(at + shift), 1.0) is None


def test_a_python_model_names_parameter_channel_and_sample() -> None:
    times = np.linspace(0.0, 1.0, 3)
    model = PythonModel(
        lambda rate, size: np.array([size + 0j * times, abs(rate) * times]).T,
        {"rate": (0.1, 2.0), "size": (1.0, 2.0)}, ["a", "b"], times,
    )  # fmt: skip
    with pytest.raises(InputError, match=r"channel 'b' \(sample \d\).* by 'rate' is 0 by the complex step, but"):
        model.jacobian(np.array([1.0, 1.5]))


def test_a_python_model_in_complex_numbers_has_no_derivative() -> None:
    """The imaginary part of the logarithm is rounding, far above that of the complex step."""
    times = np.linspace(0.1, 1.0, 3)
    model = PythonModel(lambda rate: np.log(np.exp(1j * rate * times)) / 1j, {"rate": (0.1, 2.0)}, ["a"], times)
    with pytest.raises(InputError, match="returned complex numbers for real parameters"):
        model.jacobian(np.array([0.8]))


@pytest.mark.parametrize("name", ROUNDING)
@pytest.mark.parametrize("at", [0.77, 1.2, 1.23456])
def test_rounding_to_few_decimals_is_found(name: str, at: float) -> None:
    lost = stepped(lambda shift: np.array([1.0, ROUNDING[name](at + shift)]), 1.0, (0.5 - at, 2.0 - at))
    assert lost is not None
    assert lost.entry == 1
    assert lost.by_step != pytest.approx(lost.by_differences, rel=0.1)


@pytest.mark.parametrize("name", [*CARRYING, *SMOOTH_OR_KINKED])
@pytest.mark.parametrize("scale", [0.1, 1.0, 10.0])
@pytest.mark.parametrize(("at", "scratch"), [(1.2, (-0.7, 0.8)), (1.2345, (-0.05, 0.1)), (0.77, (-0.27, 1.23))])
def test_smooth_steep_and_kinked_functions_do_not_follow_steps(
    name: str, scale: float, at: float, scratch: tuple[float, float]
) -> None:
    function = {**CARRYING, **SMOOTH_OR_KINKED}[name]
    assert stepped(lambda shift: np.array([1.0, function(at + shift)]), scale, scratch) is None


def test_a_python_model_that_rounds_a_parameter_is_refused() -> None:
    times = np.linspace(0.0, 1.0, 5)
    model = PythonModel(lambda rate: np.exp(-np.round(rate, 3) * times), {"rate": (0.1, 2.0)}, ["x"], times)
    with pytest.raises(InputError, match=r"channel 'x' .* follows 'rate' in steps, as after rounding: .* is -?0 by"):
        model.jacobian(np.array([1.0]))


def counted() -> tuple[PythonModel, list]:
    calls = []

    def response(rate: complex) -> np.ndarray:
        calls.append(rate)
        return np.exp(-rate * np.linspace(0.0, 1.0, 3))

    return PythonModel(response, {"rate": (0.1, 2.0)}, ["x"], np.linspace(0.0, 1.0, 3)), calls


def test_a_python_model_is_compared_once() -> None:
    model, calls = counted()
    model.jacobian(np.array([2.0]))
    assert len(calls) == 12  # the response, four for the differences, five for wide ones, two in complex numbers
    assert all(0.1 <= np.real(rate) <= 2.0 for rate in calls)
    model.jacobian(np.array([1.0]))
    model.first(2).jacobian(np.array([1.0]))
    assert len(calls) == 14


def test_a_model_is_compared_at_each_vector_once() -> None:
    model, calls = counted()
    wrapped = Wrapped(model.first(2))
    wrapped.check_derivatives(np.array([1.0]))
    assert len(calls) == 11
    model.check_derivatives(np.array([1.0]))
    assert len(calls) == 11
    model.check_derivatives(np.array([1.5]))
    assert len(calls) == 17


def test_a_checkpoint_knows_that_a_model_was_compared(tmp_path: Path) -> None:
    at = np.array([1.0])
    for calls in (11, 0):
        model, made = counted()
        with Checkpoint(tmp_path / "checkpoint") as checkpoint:
            Recorded(model, checkpoint).check_derivatives(at)
        assert len(made) == calls


def test_comparisons_do_not_change_the_count_of_simulations_nor_the_fit() -> None:
    times = np.linspace(0.0, 1.0, 5)
    data = Measurements.of(times, {"x": np.exp(-0.7 * times)})
    model = PythonModel(lambda rate: np.exp(-rate * times), {"rate": (0.1, 2.0)}, ["x"], times)
    first, second = (identify(model, data, starts=2, seed=1) for _ in range(2))
    assert first.simulations == second.simulations
    np.testing.assert_array_equal(first.values, second.values)


def bent(rate: float) -> np.ndarray:
    """A response that loses the derivative by the rate above 1 only."""
    return (rate if np.real(rate) < 1.0 else np.abs(rate) + 0j) * np.linspace(0.0, 1.0, 5)


def test_every_identification_compares_at_its_start() -> None:
    times = np.linspace(0.0, 1.0, 5)
    model = PythonModel(bent, {"rate": (0.1, 2.0)}, ["x"], times)
    data = Measurements.of(times, {"x": 0.5 * times})
    fit = identify(model, data, start={"rate": 0.7}, starts=1)
    assert fit.values[0] == pytest.approx(0.5)
    with pytest.raises(InputError, match="by 'rate' is 0 by the complex step"):
        identify(model, data, start={"rate": 1.5}, starts=1)


def test_a_prediction_compares_at_the_identified_values() -> None:
    times = np.linspace(0.0, 1.0, 5)
    data = Measurements.of(times, {"x": 1.5 * times})
    fit = identify(PythonModel(lambda rate: rate * times, {"rate": (0.1, 2.0)}, ["x"], times), data, starts=1)
    model = PythonModel(bent, {"rate": (0.1, 2.0)}, ["x"], times)
    model.jacobian(np.array([0.5]))
    with pytest.raises(InputError, match="by 'rate' is 0 by the complex step"):
        predict(model, fit)
