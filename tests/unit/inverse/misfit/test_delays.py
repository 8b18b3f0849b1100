import numpy as np
import pytest

from dalembert.data import Measurements
from dalembert.forward import PythonModel
from dalembert.inverse import Experiment, identify
from free_oscillations import NOISE, TIMES, TRUTH, oscillation, oscillator, recorded

LATE = oscillation(np.maximum(TIMES - 0.02, 0.0), *TRUTH)


def suspected(fit):
    return [finding for finding in fit.findings if finding.code == "suspect-delay"]


@pytest.mark.parametrize("correlation", [0.0, 0.7])
@pytest.mark.parametrize("deviations", [None, NOISE], ids=["unknown-noise", "known-noise"])
def test_a_late_sensor_is_named_with_its_delay(correlation, deviations):
    (finding,) = suspected(identify(oscillator(), recorded(LATE, 1, correlation, deviations)))
    assert abs(finding.values["delay"] - 0.02) < max(5e-4, 4 * finding.values["deviation"])
    assert finding.values["explained"] > 0.8
    assert finding.values["channel"] == "x"
    assert "[sensors] 'x' = { delay = [0.0, 0.04] }" in finding.advice


def test_early_data_are_said_to_begin_at_another_time():
    early = oscillation(TIMES + 0.02, *TRUTH)
    (finding,) = suspected(identify(oscillator(), recorded(early)))
    assert finding.values["delay"] == pytest.approx(-0.02, rel=0.1)
    assert "early" in finding.message
    assert "where the time of the data begins" in finding.advice


@pytest.mark.parametrize("correlation", [0.0, 0.7])
def test_no_delay_is_suspected_in_data_that_the_model_explains(correlation):
    for seed in range(10):
        assert suspected(identify(oscillator(), recorded(oscillation(TIMES, *TRUTH), seed, correlation))) == []


def test_no_delay_is_suspected_where_the_initial_state_makes_up_for_it():
    def free(frequency, cosine, sine):
        return cosine * np.cos(frequency * TIMES) + sine * np.sin(frequency * TIMES)

    model = PythonModel(free, {"frequency": (5.0, 6.0), "cosine": (-1.0, 1.0), "sine": (-1.0, 1.0)}, ["x"], TIMES)
    fit = identify(model, recorded(np.cos(5.5 * (TIMES - 0.02))))
    assert fit.findings == ()


def two_channels(late):
    """A fit of two sensors at the same oscillator, late by two delays."""

    def both(stiffness, damping, start):
        x = oscillation(TIMES, stiffness, damping, start)
        return np.stack([x, 0.5 * x**2 + x], axis=1)

    box = {"stiffness": (20.0, 40.0), "damping": (0.01, 1.0), "start": (0.05, 0.5)}
    model = PythonModel(both, box, ["x", "y"], TIMES)
    noise = NOISE * np.random.default_rng(3).standard_normal((len(TIMES), 2))
    shifted = [oscillation(np.maximum(TIMES - delay, 0.0), *TRUTH) for delay in late]
    values = {"x": shifted[0] + noise[:, 0], "y": 0.5 * shifted[1] ** 2 + shifted[1] + noise[:, 1]}
    return suspected(identify(model, Measurements.of(TIMES, values)))


def test_the_late_one_of_two_sensors_is_named():
    (finding,) = two_channels([0.0, 0.01])
    assert finding.values["channel"] == "y"
    assert finding.values["delay"] == pytest.approx(0.01, rel=0.2)


def test_a_delay_of_all_sensors_is_one_finding():
    (finding,) = two_channels([0.01, 0.01])
    assert finding.values["channel"] == ""
    assert finding.values["delay"] == pytest.approx(0.01, rel=0.1)
    assert "all channels" in finding.message


def test_a_sensor_is_late_in_all_experiments():
    experiments = [
        Experiment(name, oscillator(), recorded(LATE, seed), local=("start",)) for seed, name in enumerate("ab")
    ]
    (finding,) = suspected(identify(experiments))
    assert finding.values["channel"] == "x"
    assert finding.values["delay"] == pytest.approx(0.02, rel=0.1)
