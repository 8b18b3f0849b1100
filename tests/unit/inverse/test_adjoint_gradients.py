"""Gradients of the misfit and of the likelihood by the adjoint, against those by all sensitivities."""

from dataclasses import replace

import numpy as np
import pytest
from inline_snapshot import snapshot

import dalembert as da
from dalembert.errors import InputError
from dalembert.forward import Checkpoint, Recorded, Sensor, Sensors, prefers_adjoint, pullback
from dalembert.inverse import AutoregressiveNoise, Experiment, ProportionalNoise, likelihood
from dalembert.inverse.noise.models.noise_model import NoiseModel
from dalembert.inverse.problem.journal import Journal
from dalembert.inverse.problem.problem import MisfitProblem, pose
from refusals import refused
from unknown_loads import pushed_model

TIMES = np.linspace(0.002, 0.07, 20)
MODEL = pushed_model("spline", 12, times=TIMES)
WITH_PRIORS = pushed_model("spline", 12, times=TIMES, deviation=3.0)
VECTOR = MODEL.parameters.start


def measured() -> da.Measurements:
    """Its response to other coefficients, with noise."""
    random = np.random.default_rng(1)
    values = MODEL.evaluate((VECTOR + 5 * random.normal(size=12))[None]).values[0]
    noise = 0.01 * np.abs(values).max(axis=0)
    values = values + noise * random.normal(size=values.shape)
    names = [channel.name for channel in MODEL.channels]
    return da.Measurements.of(
        TIMES, dict(zip(names, values.T, strict=True)), deviations=dict(zip(names, noise, strict=True))
    )


def agree(given: np.ndarray, expected: np.ndarray) -> None:
    np.testing.assert_allclose(given, expected, rtol=0, atol=1e-10 * np.abs(expected).max())


def posed(model: da.ForwardModel = MODEL) -> MisfitProblem:
    return pose(model, measured(), None, Journal(len(TIMES)))


@pytest.mark.parametrize("model", [MODEL, WITH_PRIORS], ids=["data", "data and priors"])
def test_the_gradient_of_the_misfit(model: da.TimeResponse) -> None:
    problem = posed(model)
    assert problem.by_adjoint
    point = problem.search.points(VECTOR + 1.0)
    agree(problem.gradient(point), replace(problem, derivative="direct").gradient(point))


@pytest.mark.parametrize("noise", [None, ProportionalNoise(), AutoregressiveNoise(order=1)], ids=str)
def test_the_gradient_of_the_likelihood(noise: NoiseModel | None) -> None:
    found = likelihood(MODEL, measured(), noise=noise)
    vector = np.concatenate([VECTOR, np.full(len(found.parameters) - 12, 0.1)])
    value, gradient = found.linearise(vector)
    direct, slopes = replace(found, problem=replace(found.problem, derivative="direct")).linearise(vector)
    assert value == pytest.approx(direct, rel=1e-13)
    agree(gradient, slopes)


def test_sensors_and_records_pass_it_on(tmp_path) -> None:
    seen = Sensors(MODEL, {"rope.end.y": Sensor(delay=(0.0, 1e-3), gain=(0.5, 2.0))}, TIMES[3:])
    vector = np.array([*VECTOR, 5e-4, 1.3])
    assert prefers_adjoint(seen)
    cotangent = np.random.default_rng(0).normal(size=(17, 3))
    expected = pullback(seen, vector, "direct")[1](cotangent)
    agree(pullback(seen, vector)[1](cotangent), expected)
    with Checkpoint(tmp_path / "checkpoint") as checkpoint:
        for _ in range(2):
            agree(pullback(Recorded(seen, checkpoint), vector)[1](cotangent), expected)


def test_experiments_are_added_up() -> None:
    data = measured()
    found = [
        likelihood([Experiment("one", MODEL, data), Experiment("two", MODEL, data)]),
        likelihood(MODEL, data),
    ]
    (both, slopes), (one, slope) = (own.linearise(VECTOR) for own in found)
    assert both == pytest.approx(2 * one)
    agree(slopes, 2 * slope)


def test_a_minimiser_takes_it() -> None:
    data, gradients = measured(), {}
    for derivative in ("auto", "direct"):
        fit = da.identify(
            MODEL, data, method=da.Minimiser("L-BFGS-B", {"maxiter": 3}), start=VECTOR, derivative=derivative
        )
        gradients[derivative] = fit
    assert gradients["auto"].simulations < gradients["direct"].simulations
    np.testing.assert_allclose(gradients["auto"].values, gradients["direct"].values, rtol=1e-9)


def test_a_model_without_an_adjoint_is_refused() -> None:
    model = da.PythonModel(lambda rate: rate * TIMES, {"rate": (0.0, 1.0)}, ["x"], TIMES)
    with refused(InputError, snapshot("PythonModel has no adjoint. Take derivative='direct', or a TimeResponse")):
        pullback(model, np.array([0.5]), "adjoint")
