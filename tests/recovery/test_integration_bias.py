"""Steps that are too coarse bias identified values, and one more simulation says by how much."""

import importlib
from pathlib import Path

import numpy as np
import pytest

import dalembert as da

STUDY = Path(__file__).parents[2] / "studies" / "slider-crank-inertias"


@pytest.fixture
def engine(monkeypatch):
    monkeypatch.syspath_prepend(str(STUDY))
    return importlib.import_module("make_data")


def finding(fit):
    return next((item for item in fit.findings if item.code == "integration-bias"), None)


@pytest.mark.slow
def test_inertias_of_a_slider_crank_at_coarse_steps(engine, record_evidence):
    """Motion of a tenth of the step, noise of 0.1 %: the inertias are eight deviations off, and corrected."""
    level, columns = 0.1, engine.COLUMNS
    motion = engine.model(10).evaluate(engine.TRUTH[None]).only()[0]
    deviations = dict(zip(columns, level / 100 * motion.std(axis=0), strict=True))
    channels = dict(zip(columns, engine.noisy(motion, level, 0).T, strict=True))
    data = da.Measurements.of(engine.TIMES, channels, deviations)
    fit = da.identify(engine.model(), data, starts=1, start=np.array([3.5e-4, 0.9e-3]), horizon=None)
    fine = da.identify(engine.model(10), data, starts=1, start=fit.values, horizon=None)
    assert np.all(np.abs(fit.values - engine.TRUTH) > 6 * fit.deviations)
    assert finding(fit).doubtful
    assert finding(fit).values["deviations"] > 6
    assert finding(fine) is None
    record_evidence(
        "inertias of a slider–crank at coarse steps less their estimated bias, in deviations from those at a tenth of "
        "the step", np.zeros(2), (fit.values - fit.integration.bias - fine.values) / fine.deviations, tolerance=0.2,
        topic="Statistics of estimates", kind="other method", source="a second identification at a tenth of the step",
    )  # fmt: skip
    np.testing.assert_allclose(fit.integration.corrected, fine.misfit, rtol=1e-3)


def double_pendulum(mass, length):
    system = da.System(gravity=(0.0, -9.81))
    upper = system.add(da.RigidBar("upper", length=length, mass=1.0, angle=0.6))
    lower = system.add(da.RigidBar("lower", length=0.5, mass=mass, angle=1.2))
    system.add(da.RevoluteJoint("top", system.ground, upper.start, viscous=0.01))
    system.add(da.RevoluteJoint("elbow", upper.end, lower.start, viscous=0.01))
    return system


def pendulum(step, times):
    box = {"mass": (0.5, 1.5), "length": (0.4, 0.6)}
    channels = ["upper.centre.angle", "lower.centre.angle"]
    return da.TimeResponse(double_pendulum, box, channels, times, solver=da.GeneralizedAlpha(step=step))


def test_a_double_pendulum_misses_the_data_at_converged_steps():
    times, truth = np.linspace(0, 2.0, 101), np.array([0.9, 0.52])
    converged = pendulum(5e-4, times)
    noise = np.radians(0.1)
    motion = converged.evaluate(truth[None]).only()[0]
    motion = motion + noise * np.random.default_rng(0).standard_normal(motion.shape)
    data = da.Measurements.of(times, dict(zip(converged.channel_names, motion.T, strict=True)), noise)
    fit = da.identify(pendulum(1e-2, times), data, starts=1, start=truth, horizon=None)
    assert fit.success
    assert finding(fit).doubtful
    off = np.abs(fit.values - truth) / fit.plain_deviations
    corrected = np.abs(fit.values - fit.integration.bias - truth) / fit.plain_deviations
    assert np.all(off > 8)
    assert np.all(corrected < 2)
    there = converged.evaluate(fit.values[None]).only()[0]
    assert fit.integration.misfit == pytest.approx(np.sum(((there - motion) / noise) ** 2), rel=0.1)
    assert fit.integration.corrected < 250 < 5000 < fit.misfit
