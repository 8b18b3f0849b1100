import numpy as np
import pytest

from conclusions import codes
from dalembert.data import Measurements
from dalembert.forward import PythonModel
from dalembert.inverse import Experiment, identify
from dalembert.inverse.misfit.residuals import local_deviation
from free_oscillations import NOISE, TIMES, TRUTH, oscillation, oscillator, recorded, rubbing

RUBBING = rubbing(TIMES, 30.0, 0.1, 0.3, 0.3)
LINE = PythonModel(lambda slope: slope * np.sin(TIMES), {"slope": (0.0, 2.0)}, ["x"], TIMES)


def misfits(fit):
    return [finding for finding in fit.findings if finding.code == "model-misfit"]


@pytest.mark.parametrize("correlation", [0.0, 0.7])
@pytest.mark.parametrize("deviations", [None, NOISE], ids=["unknown-noise", "known-noise"])
def test_a_model_without_friction_is_said_to_be_wrong(correlation, deviations):
    (finding,) = misfits(identify(oscillator(), recorded(RUBBING, 1, correlation, deviations)))
    assert finding.severity == "warning"
    assert finding.values["ratio"] > 2
    assert finding.values["at"] < 1
    assert 2 < finding.values["followed"] < 6
    assert ("given deviation" in finding.message) == (deviations is not None)


def test_the_part_that_can_be_followed_alone_is_fitted_to_its_noise():
    data = recorded(RUBBING, 1, 0.0, NOISE)
    (finding,) = misfits(identify(oscillator(), data))
    samples = int(np.sum(finding.values["followed"] >= TIMES))
    assert misfits(identify(oscillator(TIMES[:samples]), data.first(samples))) == []
    assert misfits(identify(oscillator(TIMES[: samples + 80]), data.first(samples + 80))) != []


@pytest.mark.parametrize("deviations", [None, NOISE], ids=["unknown-noise", "known-noise"])
def test_the_misfit_begins_where_something_else_moves(deviations):
    """Something that the model lacks begins at 5 s; the amplitude is known from all of the record."""
    other = np.where(TIMES > 5, 0.02 * np.sin(4 * (TIMES - 5)), 0.0)
    (finding,) = misfits(identify(LINE, recorded(np.sin(TIMES) + other, 0, 0.0, deviations)))
    assert 5 < finding.values["at"] < 5.8
    assert 4.5 < finding.values["followed"] < 5.8
    assert f"from {finding.values['at']:.4g} s on, first in 'x'" in finding.message


@pytest.mark.parametrize("correlation", [0.0, 0.7, 0.85])
@pytest.mark.parametrize("deviations", [None, NOISE], ids=["unknown-noise", "known-noise"])
def test_a_right_model_is_not_said_to_be_wrong(correlation, deviations):
    exact = oscillation(TIMES, *TRUTH)
    codes = {
        finding.code
        for seed in range(10)
        for finding in identify(oscillator(), recorded(exact, seed, correlation, deviations), start=TRUTH).findings
    }
    assert codes <= {"correlated-residuals"}


def test_noise_that_is_larger_than_its_given_deviation_is_no_misfit_of_the_model():
    fit = identify(oscillator(), recorded(oscillation(TIMES, *TRUTH), 0, 0.0, NOISE / 5))
    assert "misfit-above-noise" in codes(fit)
    assert misfits(fit) == []


def test_each_experiment_has_its_own_misfit():
    right, wrong = recorded(oscillation(TIMES, *TRUTH), 0), recorded(RUBBING, 1)
    experiments = [Experiment(name, oscillator(), data) for name, data in {"free": right, "rubbing": wrong}.items()]
    fit = identify([experiments[0], Experiment("rubbing", oscillator(), wrong, local=("damping", "start"))])
    (finding,) = misfits(fit)
    assert finding.values["experiment"] == "rubbing"
    assert "of experiment 'rubbing'" in finding.message


def test_local_deviation_of_uneven_samples():
    rng = np.random.default_rng(0)
    times = np.sort(rng.uniform(0, 10, 4000))
    values = np.sin(3 * times) + 0.05 * rng.standard_normal(4000)
    assert local_deviation(times, values) == pytest.approx(0.05, rel=0.05)


def test_a_channel_that_follows_is_not_named():
    noise = NOISE * np.random.default_rng(0).standard_normal((len(TIMES), 2))
    model = PythonModel(
        lambda slope, height: np.stack([slope * np.sin(TIMES), height * np.cos(2 * TIMES)], axis=1),
        {"slope": (0.0, 2.0), "height": (0.0, 2.0)},
        ["x", "y"],
        TIMES,
    )
    values = {"x": np.sin(TIMES) + noise[:, 0], "y": np.cos(2 * TIMES) + 0.05 * np.cos(5 * TIMES) + noise[:, 1]}
    (finding,) = misfits(identify(model, Measurements.of(TIMES, values)))
    assert finding.values["channel"] == "y"
