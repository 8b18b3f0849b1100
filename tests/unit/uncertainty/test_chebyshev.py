"""Bounds of Chebyshev surrogates: right, told with their error, refused where they cannot be trusted."""

import numpy as np
import pytest

from dalembert.errors import InputError, SolveError
from dalembert.forward import PythonModel
from dalembert.surrogate import Adaptive, Tensor, TotalDegree
from dalembert.uncertainty import Chebyshev, propagate
from small_models import DECAY, TIMES
from support import says

BOX = {"size": (1.0, 2.0), "rate": (0.5, 1.0)}


@pytest.mark.parametrize("bounds", ["optimise", "scan", "bernstein"])
def test_the_bounds_are_right_within_their_own_error(bounds):
    bands = propagate(DECAY, BOX, Chebyshev(Tensor(6), bounds=bounds))
    apart = np.abs([bands.lower[:, 0] - np.exp(-TIMES), bands.upper[:, 0] - 2 * np.exp(-TIMES / 2)])
    gap = 1e-5 if bounds == "bernstein" else 1e-12
    assert np.all(apart <= bands.error[:, 0] + gap)
    assert np.max(bands.error) < 1e-4
    assert bands.runs == 49 + 10
    assert bands.kind == ("enclosure of the surrogate" if bounds == "bernstein" else "estimate")


def test_an_enclosure_holds_the_true_bounds():
    bands = propagate(DECAY, BOX, Chebyshev(Tensor(4), bounds="bernstein", tolerance=1e-2))
    assert np.all(bands.lower[:, 0] <= np.exp(-TIMES))
    assert np.all(bands.upper[:, 0] >= 2 * np.exp(-TIMES / 2))
    assert bands.at_lower is None
    assert bands.at_upper is None


def test_bounds_are_taken_where_the_polynomial_says():
    bands = propagate(DECAY, BOX, Chebyshev(Tensor(6)))
    assert bands.at_lower[10, 0].tolist() == [1.0, 1.0]
    assert bands.at_upper[10, 0].tolist() == [2.0, 0.5]


def test_each_channel_has_the_scale_of_its_own():
    """An error that is small beside the large channel is refused in the small one."""

    def both(rate):
        return np.stack([1e6 * rate + 0 * TIMES, np.cos(3 * rate * TIMES)], axis=1)

    model = PythonModel(both, {"rate": (0.0, 2.0)}, ["large", "small"], TIMES)
    with pytest.raises(SolveError, match=r"at channel 'small', time \d"):
        propagate(model, {"rate": (0.5, 1.5)}, Chebyshev(Tensor(4)))


def test_a_low_order_is_refused_with_the_order_that_would_do():
    model = PythonModel(lambda w: np.cos(w * TIMES), {"w": (1.0, 9.0)}, ["x"], TIMES)
    box = {"w": (3.0, 7.0)}
    with pytest.raises(SolveError) as error:
        propagate(model, box, Chebyshev(TotalDegree(4)))
    told = str(error.value)
    order = int(told.split("about order ")[1].split()[0])
    assert told.startswith("the surrogate of order 4 is wrong by about ")
    assert f"take TotalDegree(order={order}), raise the tolerance, or make the box smaller" in told
    bands = propagate(model, box, Chebyshev(TotalDegree(order)))
    phase = np.linspace(3 * TIMES, 7 * TIMES, 20001)
    np.testing.assert_allclose(bands.upper[:, 0], np.cos(phase).max(axis=0), atol=3e-4)
    np.testing.assert_allclose(bands.lower[:, 0], np.cos(phase).min(axis=0), atol=3e-4)


def test_a_small_tolerance_is_met_without_further_settings():
    bands = propagate(DECAY, BOX, Chebyshev(tolerance=1e-10))
    assert bands.error.max() < 1e-10 * 2
    np.testing.assert_allclose(bands.upper[:, 0], 2 * np.exp(-TIMES / 2), atol=2e-10)


def test_a_scheme_that_ended_at_its_tolerance_is_advised_to_lower_it():
    with pytest.raises(SolveError, match=r"allow less error by Adaptive\(tolerance=\.\.\.\), now 0\.01, raise"):
        propagate(DECAY, BOX, Chebyshev(Adaptive(1e-2), tolerance=1e-8))


def test_the_tolerance_is_relative_to_the_variation_of_the_channel():
    model = PythonModel(lambda w: 1e-3 * np.cos(w * TIMES), {"w": (1.0, 9.0)}, ["x"], TIMES)
    with pytest.raises(SolveError, match="more than the tolerance of 2e-07"):
        propagate(model, {"w": (3.0, 7.0)}, Chebyshev(TotalDegree(4)))


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        (
            lambda: Chebyshev(bounds="optimize"),
            "Chebyshev, bounds: unknown way to bound a polynomial 'optimize'; did you mean 'optimise'?",
        ),
        (lambda: Chebyshev(tolerance=0.0), "Chebyshev: tolerance is 0; expected a positive number"),
        (lambda: Chebyshev(held_out=-1), "Chebyshev: held_out is -1; expected zero or a positive whole number"),
    ],
)
def test_settings_that_cannot_be_meant_are_answered_in_a_sentence(wrong, sentence):
    with pytest.raises(InputError, match=says(sentence)):
        wrong()
