"""identify: closed forms, weights, methods, events, seeds, failed samples."""

import numpy as np
import pytest

import dalembert
from conclusions import codes, only
from dalembert.data import Measurements
from dalembert.errors import InputError, SolveError
from dalembert.forward import PythonModel
from dalembert.inverse import as_record, identify
from dalembert.optimize import (
    Firefly,
    ImprovedParticleSwarm,
    LeastSquares,
    Minimiser,
    ParticleSwarm,
    ResponseSensitivity,
)
from dalembert.parameter import Parameter
from small_models import DECAY, LINE, TIMES, line, measured

DESIGN = np.stack([line(1.0, 0.0), line(0.0, 1.0)], axis=-1).reshape(-1, 2)


def test_a_linear_problem_has_the_values_deviations_and_correlation_of_the_closed_form():
    data = measured(LINE, [1.0, 2.0], noise=0.1)
    fit = identify(LINE, data)
    values, squares, *_ = np.linalg.lstsq(DESIGN, data.values.ravel(), rcond=None)
    covariance = squares[0] / (82 - 2) * np.linalg.inv(DESIGN.T @ DESIGN)
    np.testing.assert_allclose(fit.values, values, rtol=1e-7)
    np.testing.assert_allclose(fit.misfit, squares[0], rtol=1e-12)
    np.testing.assert_allclose(fit.deviations, np.sqrt(np.diag(covariance)), rtol=1e-9)
    np.testing.assert_allclose(
        fit.correlation[0, 1], covariance[0, 1] / np.sqrt(covariance[0, 0] * covariance[1, 1]), rtol=1e-9
    )
    np.testing.assert_allclose(fit.residuals, line(*values) - data.values, atol=1e-7)


def test_given_deviations_weigh_the_channels_and_are_the_noise():
    data = measured(LINE, [1.0, 2.0], noise=0.1, deviations={"x": 0.1, "y": 0.4})
    fit = identify(LINE, data)
    root = 1 / np.tile([0.1, 0.4], 41)
    values, *_ = np.linalg.lstsq(DESIGN * root[:, None], data.values.ravel() * root, rcond=None)
    covariance = np.linalg.inv((DESIGN * root[:, None] ** 2).T @ DESIGN)
    np.testing.assert_allclose(fit.values, values, rtol=1e-7)
    np.testing.assert_allclose(fit.deviations, np.sqrt(np.diag(covariance)), rtol=1e-9)


@pytest.mark.parametrize("shape", ["channels", "samples and channels"])
def test_weights_multiply_the_squares_and_a_zero_leaves_a_value_out(shape):
    data = measured(LINE, [1.0, 2.0], noise=0.1)
    weights = np.array([0.0, 3.0]) if shape == "channels" else np.tile([0.0, 3.0], (41, 1))
    fit = identify(LINE, data, weights=weights)
    only = DESIGN.reshape(41, 2, 2)[:, 1]
    values, squares, *_ = np.linalg.lstsq(only, data.values[:, 1], rcond=None)
    np.testing.assert_allclose(fit.values, values, rtol=1e-7)
    np.testing.assert_allclose(fit.misfit, 3 * squares[0], rtol=1e-10)
    variance = np.linalg.inv(only.T @ only) * squares[0] / (41 - 2)
    np.testing.assert_allclose(fit.deviations, np.sqrt(np.diag(variance)), rtol=1e-9)


def test_deviations_say_how_far_estimates_scatter():
    """Over 200 noisy data sets, the scatter of the estimates is the mean of their deviations within 15 %."""
    fits = [identify(DECAY, measured(DECAY, [2.0, 0.8], 0.02, seed), starts=1) for seed in range(200)]
    scatter = np.std([fit.values for fit in fits], axis=0)
    np.testing.assert_allclose(np.mean([fit.deviations for fit in fits], axis=0), scatter, rtol=0.15)


def test_a_model_may_have_more_channels_than_the_data_in_another_order():
    data = measured(LINE, [1.0, 2.0])
    swapped = Measurements.of(TIMES, {"y": data.values[:, 1]})
    fit = identify(LINE, swapped)
    np.testing.assert_allclose(fit.values, [1, 2], rtol=1e-9)
    assert fit.response.shape == (41, 1)


METHODS = [
    LeastSquares(),
    ResponseSensitivity(),
    ParticleSwarm(particles=20, iterations=40),
    ImprovedParticleSwarm(),
    Firefly(generations=30),
    Minimiser("Nelder-Mead"),
    "L-BFGS-B",
    Minimiser("differential_evolution", {"maxiter": 15, "popsize": 8}),
]


@pytest.mark.parametrize("method", METHODS)
def test_every_method_goes_through_the_same_call_and_ends_with_the_same_bits(method):
    data = measured(DECAY, [2.0, 0.8])
    one, same = (identify(DECAY, data, method=method, seed=4) for _ in range(2))
    np.testing.assert_allclose(one.values, [2.0, 0.8], rtol=0.05)
    assert np.isfinite(one.deviations).all()
    assert one.history[-1].best == pytest.approx(one.misfit, abs=1e-20)
    for name in ("values", "deviations", "correlation", "response"):
        assert getattr(one, name).tobytes() == getattr(same, name).tobytes()
    assert [step.best for step in one.history] == [step.best for step in same.history]
    assert (one.simulations, one.status, one.provenance) == (same.simulations, same.status, same.provenance)


def test_another_seed_takes_another_way():
    data = measured(DECAY, [2.0, 0.8], noise=0.1)
    one, other = (identify(DECAY, data, method=ParticleSwarm(5, 5), seed=seed) for seed in (0, 1))
    assert one.values.tobytes() != other.values.tobytes()


@pytest.mark.parametrize("method", METHODS[2:])
def test_polish_ends_where_least_squares_ends(method):
    data = measured(DECAY, [2.0, 0.8], noise=0.05)
    fit = identify(DECAY, data, method=method, polish=True)
    np.testing.assert_allclose(fit.values, identify(DECAY, data).values, rtol=1e-5)
    assert len(fit.starts) == 2
    assert fit.starts[-1].message.startswith("polished: converged")
    assert fit.starts[-1].misfit <= fit.starts[0].misfit


def test_several_starts_of_a_local_minimiser_find_the_deeper_of_two_minima():
    double = PythonModel(
        lambda x: (x**2 - 1) * np.array([1.0, 0.0]) + x * np.array([0, 0.3]), {"x": (-2, 2)}, ["y"], [0, 1]
    )
    data = Measurements.of([0.0, 1.0], {"y": [0.0, 0.3]})
    lone = identify(double, data, method="Nelder-Mead", start=[-1.1])
    several = identify(double, data, method="Nelder-Mead", start=[-1.1], starts=4)
    assert lone.values[0] < 0
    assert several.values[0] == pytest.approx(1, abs=1e-4)


def test_swarm_settings_count_as_published():
    data = measured(DECAY, [2.0, 0.8])
    fit = identify(DECAY, data, method=ParticleSwarm(particles=8, iterations=6))
    assert fit.simulations == 8 * 6 + 3 + 1  # response and sensitivities of two parameters, then the response again
    assert [step.simulations for step in fit.history] == [8, 16, 24, 32, 40, 48]
    assert fit.method == "ParticleSwarm"
    assert np.isnan(fit.starts[0].start).all()


def test_an_easy_problem_costs_few_simulations():
    fit = identify(DECAY, measured(DECAY, [2.0, 0.8]), start=[4.0, 2.9])
    assert fit.misfit < 1e-24
    assert len(fit.starts) == 1
    assert fit.simulations <= 60
    assert fit.success


def test_on_rounded_data_the_first_start_settles_it_and_the_end_is_polished():
    data = measured(DECAY, [2.0, 0.8])
    rounded = Measurements.of(TIMES, {"x": np.round(data.values[:, 0], 4)})
    fit = identify(DECAY, rounded)
    assert len(fit.starts) <= 2
    assert only(fit, "misfit-at-noise").values == {"source": "rounded"}
    alone = identify(DECAY, rounded, starts=1, horizon=None, start=fit.values)
    np.testing.assert_allclose(fit.values, alone.values, rtol=1e-7)


def test_a_model_that_cannot_explain_the_data_is_told_by_its_residuals():
    bent = Measurements.of(TIMES, {"x": 1 + TIMES + 0.5 * np.sin(3 * TIMES), "y": TIMES**2 - 1})
    fit = identify(LINE, bent)
    left = {"correlated-residuals", "systematic-residuals", "model-misfit", "parameters-drift", "periodic-residuals"}
    assert {finding.code for finding in fit.findings} == left


def test_events_tell_the_run_in_order():
    events = []
    fit = identify(DECAY, measured(DECAY, [2.0, 0.8], noise=0.1), on_event=events.append)
    kinds = [event.kind for event in events]
    assert kinds[0] == "start-began"
    assert kinds[-1] == "finished"
    assert kinds.count("start-began") == kinds.count("start-ended") == len(fit.starts)
    assert kinds.count("screened") == 1
    counts = [event.simulations for event in events if event.kind in ("iteration", "start-began", "screened")]
    assert counts == sorted(counts)
    whole = [event for event in events if event.kind == "iteration" and event.samples == 41]
    assert [id(event) for event in whole] == [id(step) for step in fit.history]
    assert any(event.samples < 41 for event in events if event.kind == "iteration")
    records = [as_record(event) for event in events]
    assert records[0] == {"event": "start-began", "start": 0, "simulations": 0, "values": pytest.approx([2.25, 1.55])}
    assert records[-1]["misfit"] == fit.misfit


def test_simulations_are_those_that_the_model_was_asked_for():
    asked = []

    class Counting(PythonModel):
        def evaluate(self, vectors):
            asked.append(len(vectors))
            return super().evaluate(vectors)

        def linearise(self, vector):
            asked.append(1 + len(vector))
            return super().linearise(vector)

    def decay(size, rate):
        return size * np.exp(-rate * TIMES)

    model = Counting(decay, {"size": (0.5, 4.0), "rate": (0.1, 3.0)}, ["x"], TIMES)
    fit = identify(model, measured(model, [2.0, 0.8], noise=0.1), horizon=None)
    asked.pop(0)  # the measurement
    assert fit.simulations == sum(asked)


def fragile(size, rate):
    if np.real(rate) > 1.5 or np.real(size) < 1:
        raise ArithmeticError("the motion runs away")
    return size * np.exp(-rate * TIMES)


FRAGILE = PythonModel(fragile, {"size": (0.5, 4.0), "rate": (0.1, 3.0)}, ["x"], TIMES)


@pytest.mark.parametrize("method", METHODS)
def test_failed_samples_take_no_run_down(method):
    fit = identify(FRAGILE, measured(FRAGILE, [2.0, 0.8], noise=0.01), method=method, start=[3.9, 0.3])
    np.testing.assert_allclose(fit.values, [2.0, 0.8], rtol=0.1)


def test_a_start_that_fails_is_followed_by_others_and_told():
    fit = identify(FRAGILE, measured(FRAGILE, [2.0, 0.8]), start=[3.9, 2.9])
    np.testing.assert_allclose(fit.values, [2.0, 0.8], rtol=1e-9)
    assert not fit.starts[0].success
    assert fit.starts[0].misfit == np.inf
    assert fit.starts[0].message == (
        "the first point could not be simulated: ArithmeticError: the motion runs away (test_identify.py, line 205) "
        "(at size = 3.9, rate = 2.9)"
    )
    assert only(fit, "failed-simulations").values["first"].startswith("ArithmeticError: the motion runs away")


@pytest.mark.parametrize("method", [LeastSquares(), ParticleSwarm(4, 3), "Nelder-Mead"])
def test_when_nothing_can_be_simulated_the_first_reason_is_told(method):
    def never(size):
        raise ArithmeticError("the motion runs away")

    model = PythonModel(never, {"size": Parameter("size", 1.0, 2.0, start=1.5)}, ["x"], TIMES)
    with pytest.raises(SolveError, match=r"starts could be simulated; the first failure: .*the motion runs away"):
        identify(model, Measurements.of(TIMES, {"x": TIMES}), method=method)


def test_a_model_without_derivatives_gets_no_deviations_from_a_swarm_and_a_sentence_from_least_squares():
    def real_only(size):
        return float(np.real(size)) * TIMES

    model = PythonModel(real_only, {"size": (0.0, 3.0)}, ["x"], TIMES)
    data = Measurements.of(TIMES, {"x": 2 * TIMES})
    fit = identify(model, data, method=ParticleSwarm(10, 20))
    assert np.isnan(fit.deviations).all()
    assert codes(fit.identifiability()) == ["no-sensitivities"]
    with pytest.raises(InputError, match="derivative='central-differences'"):
        identify(model, data)


def test_provenance_tells_versions_seed_hashes_and_settings():
    data = measured(DECAY, [2.0, 0.8])
    method = ImprovedParticleSwarm(particles=8, iterations=3)
    told = identify(DECAY, data, method=method, seed=7).provenance
    assert told["version"] == dalembert.__version__
    assert (told["seed"], told["model"], told["data"]) == (7, DECAY.fingerprint, data.fingerprint)
    assert told["method"]["name"] == "ImprovedParticleSwarm"
    assert told["method"]["settings"]["quality_size"] == 500


def test_the_summary_is_a_table_with_status():
    fit = identify(DECAY, measured(DECAY, [2.0, 0.8], noise=0.01, deviations=0.01))
    lines = fit.summary().splitlines()
    assert lines[0] == "Identified values"
    assert lines[3].split()[0] == "size"
    assert float(lines[3].split()[1]) == pytest.approx(fit.values[0], rel=1e-4)
    assert ["simulations", str(fit.simulations)] in [line.split() for line in lines]
    assert fit.status in lines


def test_parameters_that_cannot_be_told_apart_are_named():
    model = PythonModel(lambda a, b: (a + b) * TIMES, {"a": (0.0, 3.0), "b": (0.0, 3.0)}, ["x"], TIMES)
    fit = identify(model, Measurements.of(TIMES, {"x": 2 * TIMES}))
    assert only(fit, "unidentifiable-combination").values == {"parameters": "a, b", "unseen": True, "below": "rounding"}
    assert np.isinf(fit.deviations).all()


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"starts": 0}, "identify: starts is 0; expected a whole number, at least 1"),
        ({"horizon": "grow"}, "unknown horizon 'grow'; did you mean 'growing'?"),
        ({"spread": "sobel"}, "unknown spread 'sobel'; did you mean 'sobol'?"),
        ({"method": "Powel"}, "unknown minimiser 'Powel'; did you mean 'Powell'?"),
        (
            {"method": 3},
            "method is 3; expected LeastSquares(), ResponseSensitivity(), ParticleSwarm(), ImprovedParticleSwarm(), "
            "Firefly(), or a Minimiser or its name",
        ),
        (
            {"start": {"size": 9.0, "rate": 1.0}},
            "start: 'size' is 9.0, outside its bounds (0.5, 4.0); widen the bounds or move the start",
        ),
        ({"start": {"sizes": 9.0, "rate": 1.0}}, "unknown parameter 'sizes'; did you mean 'size'?"),
        (
            {"weights": [1.0, 1.0]},
            "weights of shape (2,) were given; expected (channels,) = (1,) or (samples, channels) = (41, 1)",
        ),
        ({"weights": [-1.0]}, "weights have the value -1; expected finite numbers that are not negative"),
        ({"weights": [0.0]}, "all weights are 0, so that nothing is fitted; expected at least one positive weight"),
    ],
)
def test_what_cannot_be_meant_is_answered_in_a_sentence(options, sentence):
    with pytest.raises(InputError) as error:
        identify(DECAY, measured(DECAY, [2.0, 0.8]), **options)
    assert str(error.value) == sentence
