"""Times in another unit: the response swings or comes to rest between samples of smooth data."""

import numpy as np
import pytest

import dalembert as da
from dalembert.data import Measurements
from dalembert.inverse.plausibility.suspect_times import (
    first_times,
    short_time_findings,
    time_findings,
    time_unit_findings,
)


def response(times, rate, damping):
    """Free motion of an oscillator from rest at 1 (closed form, with complex roots)."""
    root = np.sqrt(complex(damping**2 - 1))
    slow, fast = -rate * (damping - root), -rate * (damping + root)
    return np.real((fast * np.exp(slow * times) - slow * np.exp(fast * times)) / (fast - slow))


def findings(stamps, values, rate, damping):
    data = Measurements.of(stamps, {"x": values})
    times = first_times(data)
    return time_unit_findings(data, times, response(times, rate, damping)[:, None])


STAMPS = np.arange(200) * 0.02


@pytest.mark.parametrize(("damping", "swings"), [(0.05, 20 * 5 / (2 * np.pi) + 1), (1.4, 0.0)])
def test_milliseconds_read_as_seconds_are_named(damping, swings):
    values = response(STAMPS, 5.0, damping)
    (finding,) = findings(1000 * STAMPS, values, 5.0, damping)
    assert finding.code == "suspect-time-unit"
    assert (finding.values["channel"], finding.values["step"]) == ("x", pytest.approx(20.0))
    if swings:
        assert 2 <= finding.values["swings"] <= swings
    assert findings(STAMPS, values, 5.0, damping) == ()


def test_right_times_have_no_finding_in_400_seeds():
    alarms = 0
    for seed in range(400):
        random = np.random.default_rng(seed)
        rate, damping = np.exp(random.uniform(0, 4.6)), random.uniform(0, 1.5)
        stamps = np.arange(int(random.uniform(40, 400))) * 2 * np.pi / rate / random.uniform(2.2, 60)
        noise = 10 ** random.uniform(-4, -1) * random.normal(size=len(stamps))
        guess = rate * random.uniform(0.5, 2)
        alarms += bool(findings(stamps, response(stamps, rate, damping) + noise, guess, damping))
    assert alarms <= 8


def short_findings(stamps, values, rate, damping):
    data = Measurements.of(stamps, {"x": values})
    return short_time_findings(data, lambda times: response(times, rate, damping)[:, None])


@pytest.mark.parametrize("damping", [0.0, 0.05, 0.2])
def test_seconds_read_as_milliseconds_are_named_in_90_of_100_seeds(damping):
    named = 0
    for seed in range(100):
        random = np.random.default_rng(seed)
        rate = np.exp(random.uniform(0, 4.6))
        stamps = np.arange(300) * 2 * np.pi / rate / random.uniform(15, 60)
        values = response(stamps, rate, damping) + 0.01 * random.normal(size=len(stamps))
        findings = short_findings(1e-3 * stamps, values, rate * random.uniform(0.5, 2), damping)
        named += [finding.values["factor"] for finding in findings] == [1000.0]
    assert named >= 90


def test_right_times_are_not_too_short_in_400_seeds_of_guesses_over_four_decades():
    alarms = 0
    for seed in range(400):
        random = np.random.default_rng(seed)
        rate, damping = np.exp(random.uniform(0, 4.6)), random.uniform(0, 1.5)
        stamps = np.arange(int(random.uniform(40, 400))) * 2 * np.pi / rate / random.uniform(2.2, 60)
        noise = 10 ** random.uniform(-4, -1) * random.normal(size=len(stamps))
        guess = rate * 10 ** random.uniform(-2, 2)
        alarms += bool(short_findings(stamps, response(stamps, rate, damping) + noise, guess, random.uniform(0, 1.5)))
    assert alarms <= 8


TIMES = np.linspace(0.0, 4.0, 161)


def swing(times):
    def pendulum(length):
        system = da.System()
        bob = system.add(da.PointMass("bob", mass=1.0, position=(length, 0.0)))
        system.add(da.DistanceJoint("rod", system.ground.point(0.0, 0.0), bob.centre))
        return system

    solver = da.GeneralizedAlpha(step=0.01)
    return da.TimeResponse(pendulum, {"length": (0.5, 2.0)}, ["bob.centre.x", "bob.centre.y"], times, solver)


def recorded(factor):
    """A model and data whose times are in another unit by a factor."""
    data = Measurements.of(TIMES / factor, {"bob.centre.y": swing(TIMES).evaluate([[1.0]]).values[0, :, 1]})
    return swing(data.coordinate.values), data


def test_a_fit_of_a_mechanism_names_seconds_read_as_milliseconds():
    model, data = recorded(1e3)
    seen = da.Sensors(model, {"bob.centre.y": da.Sensor(offset=(-0.1, 0.1))})
    for arguments in ((model, data), ([da.Experiment("a", model, data)],), (seen, data)):
        fit = da.identify(*arguments, starts=1)
        suspects = [finding for finding in fit.findings if finding.code == "suspect-time-unit"]
        assert [finding.values["factor"] for finding in suspects] == [1e3]


def test_a_mechanism_names_milliseconds_read_as_seconds():
    model, data = recorded(1e-3)
    (finding,) = time_findings(model, data, model.parameters.start)
    assert finding.values["factor"] == 1e-3
    model, data = recorded(1.0)
    assert time_findings(model, data, model.parameters.start) == ()


def test_data_that_change_from_sample_to_sample_are_not_judged():
    noise = np.random.default_rng(1).normal(size=200)
    assert findings(1000 * STAMPS, noise, 5.0, 0.05) == ()
