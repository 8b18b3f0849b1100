import sys
from collections.abc import Callable

import numpy as np
import pytest

from dalembert.errors import InputError, SolveError
from dalembert.forward import Channel, ForwardModel, PythonModel, Responses
from support import says

TIMES = np.linspace(0.0, 2.0, 5)
BOUNDS = {"rate": (0.1, 2.0), "height": (1.0, 3.0)}
POINT = np.array([0.5, 2.0])


def decay(rate: float, height: float) -> np.ndarray:
    return np.stack([height * np.exp(-rate * TIMES), height * TIMES], axis=1)


def exact(rate: float, height: float) -> np.ndarray:
    fall = np.exp(-rate * TIMES)
    by_rate = np.stack([-TIMES * height * fall, np.zeros_like(TIMES)], axis=1)
    return np.stack([by_rate, np.stack([fall, TIMES], axis=1)], axis=2)


def model(
    function: Callable[..., np.ndarray] = decay, channels: tuple[str, ...] = ("x", "y"), **options
) -> PythonModel:
    return PythonModel(function, BOUNDS, channels, TIMES, **options)


def test_a_python_model_is_a_forward_model() -> None:
    assert isinstance(model(), ForwardModel)
    assert model().channels == (Channel("x"), Channel("y"))


def test_a_batch_is_the_function_row_by_row() -> None:
    batch = np.array([POINT, [1.0, 1.0], [2.0, 3.0]])
    responses = model().evaluate(batch)
    assert responses.ok.all()
    assert np.array_equal(responses.only(), [decay(*row) for row in batch])


def test_a_failed_sample_is_marked_and_the_others_return() -> None:
    def touchy(rate: float, height: float) -> np.ndarray:
        if rate > 1.5:
            raise ValueError("too fast")
        return decay(rate, height) / (1.0 if height < 3 else np.nan)

    first = touchy.__code__.co_firstlineno
    responses = model(touchy).evaluate(np.array([[2.0, 1.0], POINT, [1.0, 3.0]]))
    assert responses.ok.tolist() == [False, True, False]
    assert responses.failures == (
        f"ValueError: too fast (test_forward.py, line {first + 2})",
        None,
        f"the model's function (test_forward.py, line {first}) returned a value that is not finite",
    )
    assert np.isnan(responses.values[[0, 2]]).all()
    assert np.array_equal(responses.values[1], decay(*POINT))
    with pytest.raises(
        SolveError, match=says(f"sample 0 of 3: ValueError: too fast (test_forward.py, line {first + 2})")
    ):
        responses.only()


def test_the_complex_step_is_exact() -> None:
    np.testing.assert_allclose(model().jacobian(POINT), exact(*POINT), rtol=1e-15, atol=0)


def test_central_differences_agree_to_their_own_error() -> None:
    jacobian = model(derivative="central-differences").jacobian(POINT)
    np.testing.assert_allclose(jacobian, exact(*POINT), rtol=1e-8, atol=1e-9)


def test_linearise_is_the_response_and_its_jacobian() -> None:
    response, jacobian = model().linearise(POINT)
    assert np.array_equal(response, decay(*POINT))
    assert np.array_equal(jacobian, model().jacobian(POINT))


def test_a_function_that_drops_the_imaginary_part_is_refused() -> None:
    def real(rate: complex, height: complex) -> np.ndarray:
        return decay(rate.real, height.real)

    sentence = (
        f"the model's function (test_forward.py, line {real.__code__.co_firstlineno}) drops the imaginary part of its "
        "parameters, so its complex-step derivative would be zero; give derivative='central-differences', or make it "
        "complex-safe"
    )
    with pytest.raises(InputError, match=says(sentence)):
        model(real).jacobian(POINT)


def test_a_function_that_cannot_run_in_complex_numbers_is_refused() -> None:
    def real_only(rate: float, height: float) -> np.ndarray:
        if isinstance(rate, complex):
            raise TypeError("must be real number, not complex")
        return decay(rate, height)

    sentence = (
        f"the model's function (test_forward.py, line {real_only.__code__.co_firstlineno}) cannot run in complex "
        "numbers (must be real number, not complex); give derivative='central-differences', or make it complex-safe"
    )
    with pytest.raises(InputError, match=says(sentence)):
        model(real_only).jacobian(POINT)


def test_a_response_of_another_shape_is_refused() -> None:
    sentence = (
        f"the model's function (test_forward.py, line {decay.__code__.co_firstlineno}) returned an array of shape "
        "(5, 2); expected (samples, channels) = (5, 3)"
    )
    with pytest.raises(InputError, match=says(sentence)):
        model(channels=("x", "y", "z")).linearise(POINT)


@pytest.mark.parametrize(
    ("function", "error", "sentence"),
    [
        (lambda rate, height: None, InputError, "{named} returned a NoneType; expected an array of numbers"),
        (lambda rate, height: ["a"] * 5, InputError, "{named} returned a list; expected an array of numbers"),
        (lambda rate, height: 1.0, InputError,
         "{named} returned an array of shape (); expected (samples, channels) = (5, 2)"),
        (lambda rate, height: np.full((5, 2), 1j), InputError,
         "{named} returned complex numbers for real parameters. Their imaginary parts would be taken for "
         "derivatives: compute in real numbers, with atan2 of dalembert for angles"),
        (lambda rate, height: sys.exit(3), SolveError, "SystemExit: 3 ({place})"),
        (lambda rate, height: {}["stiff"], SolveError, "KeyError: 'stiff' ({place})"),
        (lambda rates: None, SolveError,
         "{named} raised TypeError: {function} got an unexpected keyword argument 'rate'"),
    ],
)  # fmt: skip
def test_whatever_a_function_does_is_told_with_its_place(function, error, sentence) -> None:
    place = f"test_forward.py, line {function.__code__.co_firstlineno}"
    named = f"the model's function ({place})"
    sentence = sentence.format(place=place, named=named, function=f"{function.__qualname__}()")
    with pytest.raises(error, match=says(sentence)):
        model(function).linearise(POINT)
    assert model(function).evaluate(POINT).failures == (sentence,)


def test_an_unknown_derivative_is_refused() -> None:
    with pytest.raises(InputError, match=says("unknown derivative 'complex'; did you mean 'complex-step'?")):
        model(derivative="complex")


def test_one_channel_may_be_returned_as_a_flat_array() -> None:
    flat = model(lambda rate, height: height * np.exp(-rate * TIMES), channels=("x",))
    assert flat.evaluate(POINT).values.shape == (1, 5, 1)


def test_first_cuts_samples_and_responses_alike() -> None:
    cut = model().first(2)
    assert cut.coordinate.values.tolist() == [0.0, 0.5]
    assert np.array_equal(cut.evaluate(POINT).only()[0], decay(*POINT)[:2])
    assert cut.jacobian(POINT).shape == (2, 2, 2)


def test_the_fingerprint_tells_models_apart_but_not_a_model_from_itself() -> None:
    assert model().fingerprint == model().fingerprint
    others = [model(np.hypot), model(channels=("x", "z")), model().first(2)]
    assert len({model().fingerprint, *(other.fingerprint for other in others)}) == 4


def test_responses_without_a_failure_are_returned_whole() -> None:
    values = np.ones((2, 3, 1))
    assert Responses(values, (None, None)).only() is values
