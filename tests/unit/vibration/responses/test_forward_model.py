"""The response over frequency as a forward model: exact derivatives, batches, failures."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

import dalembert as da
from dalembert.errors import InputError
from dalembert.structure import lumped
from dalembert.vibration import (
    CubicSpring,
    ElasticSlider,
    FrequencyResponse,
    FrictionContact,
    Gap,
    HarmonicBalance,
    HarmonicForce,
    Iwan,
    Rigid,
    UserElement,
    VibrationSystem,
)
from support import says

NOMINAL = dict(
    friction=0.3, preload=2.0, contact=1.5, mass=1.0, force=1.0, phase=0.3, spring=1.0, damper=0.02, cubic=0.1, gap=0.2
)
FREQUENCIES = np.array([0.6, 0.75]) / (2 * np.pi)
CHANNELS = ["m1 peak", "m2 rms", "m3 harmonic 2"]


def builder(law: Callable[[complex], ElasticSlider | Iwan | Rigid]) -> Callable[..., VibrationSystem]:
    def build(friction, preload, contact, mass, force, phase, spring, damper, cubic, gap) -> VibrationSystem:
        springs = [("m1", None, 1, 0.02), ("m1", "m2", spring, damper), ("m2", None, 0.5, 0.01), ("m2", "m3", 0.7, 0.0)]
        system = VibrationSystem(lumped({"m1": 1.0, "m2": mass, "m3": 1.0}, springs))
        system.add(HarmonicForce("m1", force, phase))
        system.add(HarmonicForce("m3", 0.3 * force))
        system.add(FrictionContact("foot", "m2", friction=friction, preload=preload, law=law(contact)))
        system.add(CubicSpring("cubic", "m1", "m3", stiffness=cubic))
        system.add(Gap("gap", "m3", stiffness=contact, gap=gap))
        system.add(UserElement("user", ["m1"], lambda u: 0.01 * cubic * u**5))
        return system

    return build


def model(law: Callable[[complex], ElasticSlider | Iwan | Rigid], **options: object) -> FrequencyResponse:
    bounds = {name: (0.5 * value, 1.5 * value) for name, value in NOMINAL.items()}
    method = HarmonicBalance(harmonics=5, samples=256)
    return FrequencyResponse(builder(law), bounds, CHANNELS, FREQUENCIES, method, **options)  # type: ignore[arg-type]


LAWS = {
    "elastic": ElasticSlider,
    "iwan": lambda k: Iwan((k, 2 * k), (0.4, 0.6)),
    "rigid": lambda k: Rigid(),
    "rigid-given-penalty": lambda k: Rigid(penalty=k),
    "rigid-velocity": lambda k: Rigid(prediction="velocity"),
}


@pytest.mark.parametrize("name", LAWS)
def test_the_jacobian_is_that_of_differences_for_every_number(name: str) -> None:
    own, vector = model(LAWS[name]), np.array(list(NOMINAL.values()))
    values, jacobian = own.linearise(vector)
    np.testing.assert_array_equal(values, own.evaluate(vector[None]).values[0])
    steps = 1e-6 * np.eye(len(vector))  # two maxima of the period are almost equal: larger ones change the peak
    moved = own.evaluate(np.concatenate([vector + steps, vector - steps])).values
    differences = np.moveaxis(moved[: len(vector)] - moved[len(vector) :], 0, -1) / 2e-6
    np.testing.assert_allclose(jacobian, differences, atol=2e-6 * np.abs(jacobian).max())


def test_a_batch_gives_the_bits_of_its_samples_and_marks_those_that_fail() -> None:
    own, vector = model(ElasticSlider, workers=3), np.array(list(NOMINAL.values()))
    batch = np.stack([vector, 1.1 * vector, vector])
    batch[1, 1] = -1.0
    responses = own.evaluate(batch)
    assert responses.failures[0] is None
    assert responses.failures[1] == "FrictionContact 'foot': preload is -1 N; expected zero or a positive number"
    np.testing.assert_array_equal(responses.values[0], own.evaluate(vector[None]).values[0])
    np.testing.assert_array_equal(responses.values[0], responses.values[2])


def test_a_point_that_is_not_found_says_where() -> None:
    own = replaced(model(ElasticSlider), HarmonicBalance(harmonics=5, samples=256, iterations=1, halvings=0))
    (failure,) = own.evaluate(np.array([list(NOMINAL.values())])).failures
    assert failure is not None
    assert failure.startswith("at 0.095493 Hz the harmonics were not found: after ")
    assert "iterations the relative residual is" in failure
    assert failure.endswith("; give more frequencies on the way there, or fewer harmonics")


def replaced(own: FrequencyResponse, method: HarmonicBalance) -> FrequencyResponse:
    return FrequencyResponse(own.builder, own.parameters, own.channel_names, own.frequencies, method)


def test_the_first_samples_are_those_of_the_whole() -> None:
    own, vectors = model(ElasticSlider), np.array([list(NOMINAL.values())])
    np.testing.assert_array_equal(own.first(1).evaluate(vectors).values, own.evaluate(vectors).values[:, :1])


def test_the_fingerprint_knows_the_law_and_not_the_workers() -> None:
    own = model(ElasticSlider)
    assert own.fingerprint == model(ElasticSlider, workers=2).fingerprint
    assert own.fingerprint != model(LAWS["rigid"]).fingerprint
    assert own.fingerprint != replaced(own, replace(own.method, harmonics=3)).fingerprint


def test_a_builder_that_cannot_run_in_complex_numbers_is_told() -> None:
    def build(stiffness: float) -> VibrationSystem:
        system = VibrationSystem(lumped({"m": 1.0}, [("m", None, float(stiffness), 0.04)]))
        system.add(HarmonicForce("m", 1.0))
        return system

    own = FrequencyResponse(build, {"stiffness": (0.5, 2.0)}, ["m rms"], np.array([0.1]))
    with pytest.raises(InputError, match=r"^the model's function cannot run in complex numbers, .* 'stiffness' need"):
        own.jacobian(np.array([1.0]))


def test_an_unknown_kind_of_amplitude_is_told() -> None:
    sentence = (
        "the kind of amplitude is 'size'; expected 'peak', 'rms', or 'harmonic K' with K among the harmonics kept: "
        "0, 1, 2, 3, 4, 5"
    )
    own = FrequencyResponse(
        builder(ElasticSlider), model(ElasticSlider).parameters, ["m1 size"], FREQUENCIES, model(ElasticSlider).method
    )
    assert own.evaluate(np.array([list(NOMINAL.values())])).failures == (sentence,)


@pytest.mark.parametrize(
    ("channels", "frequencies", "sentence"),
    [
        ([], [0.1], "FrequencyResponse: no channels were given; name at least one, such as 'm2 peak'"),
        (["m rms"], [0.0], "FrequencyResponse: the frequencies are [0.]; expected positive numbers in Hz"),
    ],
)
def test_what_makes_no_response_is_told(channels: list[str], frequencies: list[float], sentence: str) -> None:
    with pytest.raises(InputError, match=says(sentence)):
        FrequencyResponse(builder(ElasticSlider), {"a": (0.0, 1.0)}, channels, np.array(frequencies))


@pytest.mark.slow
def test_friction_is_identified_from_a_response_curve() -> None:
    """The waist: what identifies mechanisms identifies friction."""

    def build(friction, contact) -> VibrationSystem:
        return builder(ElasticSlider)(**{**NOMINAL, "friction": friction, "contact": contact})

    frequencies = np.linspace(0.6, 1.0, 9) / (2 * np.pi)
    bounds = {"friction": (0.1, 0.6), "contact": (0.5, 3.0)}
    own = FrequencyResponse(build, bounds, ["m2 harmonic 1"], frequencies, HarmonicBalance(3, samples=64))
    truth = np.array([0.3, 1.5])
    data = da.Measurements(own.coordinate, ("m2 harmonic 1",), own.evaluate(truth[None]).values[0])
    fit = da.identify(own, data, seed=1)
    np.testing.assert_allclose(fit.values, truth, rtol=1e-6)
