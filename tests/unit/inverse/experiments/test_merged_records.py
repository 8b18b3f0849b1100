"""Fits to channels of different rates, of which one is missing where only another has a sample."""

import numpy as np
import pytest

from correlated_noise import autoregressive
from dalembert.data import Measurements, merged
from dalembert.forward import PythonModel
from dalembert.inverse import Experiment, Fit, identify
from dalembert.report import charts

FAST = np.arange(600) * 0.01
SLOW = 0.0037 + np.arange(120) * 0.05
TRUE = {"size": 1.3, "rate": 2.2}


def motion(along):
    return TRUE["size"] * np.cos(TRUE["rate"] * along), TRUE["size"] * np.sin(TRUE["rate"] * along)


def record(seed, correlated=0.0):
    draw = np.random.default_rng(seed)
    angle = motion(FAST)[0] + 0.01 * draw.standard_normal(len(FAST))
    force = motion(SLOW)[1] + 0.01 * autoregressive(seed, len(SLOW), correlated)
    return merged([Measurements.of(FAST, {"angle": angle}, 0.01), Measurements.of(SLOW, {"force": force}, 0.01)])


def model(data):
    along = data.coordinate.values
    return PythonModel(
        lambda size, rate: np.column_stack([size * np.cos(rate * along), size * np.sin(rate * along)]),
        {"size": (1.0, 2.0), "rate": (2.0, 2.5)},
        ["angle", "force"],
        along,
    )


def test_alternating_samples_of_white_noise_are_not_correlated():
    """At most one false alarm in twenty; the level is one in a hundred."""
    found = []
    for seed in range(20):
        data = record(seed)
        fit = identify(model(data), data)
        np.testing.assert_array_less(np.abs(fit.values - list(TRUE.values())), 5 * fit.deviations)
        found.append(fit.correlated is not None)
    assert sum(found) <= 1


def test_correlation_is_seen_in_the_channel_that_has_it():
    for seed in range(5):
        data = record(seed, correlated=0.8)
        fit = identify(model(data), data)
        assert fit.correlated is not None
        (process,) = fit.correlated.processes
        assert (process.channel, process.even) == ("force", True)
        assert process.first == pytest.approx(0.8, abs=0.2)


def test_figures_show_every_sample_and_no_other_gap():
    data = record(0)
    fit = identify(model(data), data)
    for kept in (fit, Fit.from_xarray(fit.to_xarray())):
        traces = {trace.name: trace for trace in charts.responses(kept).data}
        for name, along in (("angle", FAST), ("force", SLOW)):
            assert len(traces[f"{name} computed"].x) == len(data.values)
            for word in ("measured", "residual"):
                np.testing.assert_allclose(traces[f"{name} {word}"].x, along)
                assert np.isfinite(traces[f"{name} {word}"].y).all()
    drawn = {trace.name: trace for trace in charts.measured(data).data}
    assert np.isfinite(drawn["force"].y).all()
    np.testing.assert_allclose(drawn["force"].x, SLOW)


def test_experiments_keep_the_samples_of_their_channels():
    parts = {"first": record(1), "second": record(2)}
    fit = identify([Experiment(name, model(data), data) for name, data in parts.items()])
    for part in fit.experiments:
        np.testing.assert_array_equal(part.data.taken, parts[part.name].taken)
