"""Times in another unit: the response swings or comes to rest between samples of smooth data."""

import numpy as np
import pytest

from dalembert.data import Measurements
from dalembert.inverse.experiments.suspect_times import first_times, time_unit_findings


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


def test_data_that_change_from_sample_to_sample_are_not_judged():
    noise = np.random.default_rng(1).normal(size=200)
    assert findings(1000 * STAMPS, noise, 5.0, 0.05) == ()
