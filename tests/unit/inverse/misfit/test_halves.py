import numpy as np
import pytest

from dalembert.data import Measurements
from dalembert.forward import PythonModel
from dalembert.inverse import Fit, identify
from dalembert.optimize import LeastSquares
from free_oscillations import NOISE, TIMES, TRUTH, oscillation, oscillator, recorded, rubbing

LINE = PythonModel(lambda slope: slope * np.sin(3 * TIMES), {"slope": (0.5, 2.0)}, ["x"], TIMES)


def drifts(fit):
    return [finding for finding in fit.findings if finding.code == "parameters-drift"]


@pytest.mark.parametrize("deviations", [None, NOISE], ids=["unknown-noise", "known-noise"])
def test_a_damping_that_grows_as_the_motion_dies_differs_between_the_halves(deviations):
    fit = identify(oscillator(), recorded(rubbing(TIMES, 30.0, 0.1, 0.3, 0.1), 1, 0.0, deviations))
    (finding,) = drifts(fit)
    assert finding.values["parameter"] == "damping"
    assert finding.values["second"] > 1.1 * finding.values["first"]
    assert fit.halves.refitted
    assert "second half" in fit.summary()


def test_halves_are_those_of_two_fits():
    strength = np.where(TIMES <= 4, 1.0, 1.1)
    data = recorded(strength * np.sin(3 * TIMES))
    fit = identify(LINE, data)
    for half, kept in enumerate((TIMES <= 4, TIMES > 4)):
        alone = identify(LINE, data, weights=kept[:, None].astype(float), start=fit.values)
        np.testing.assert_allclose(fit.halves.values[half], alone.values, rtol=1e-5)
    np.testing.assert_allclose(fit.halves.values, [[1.0], [1.1]], rtol=2e-3)


@pytest.mark.parametrize("trials", [30, 1], ids=["refitted", "not-refitted"])
def test_values_of_the_halves_are_within_the_bounds(trials, monkeypatch):
    """A half whose fit stops early has the value of one linear step, here 1.1 with the upper bound 1.08."""
    monkeypatch.setattr("dalembert.inverse.misfit.halves.REFITTED", LeastSquares(trials=trials))
    model = PythonModel(lambda slope: slope * np.sin(3 * TIMES), {"slope": (0.5, 1.08)}, ["x"], TIMES)
    fit = identify(model, recorded(np.where(TIMES <= 4, 1.0, 1.1) * np.sin(3 * TIMES)), starts=1)
    (finding,) = drifts(fit)
    assert fit.halves.refitted is (trials > 1)
    assert finding.values["first"] == pytest.approx(1.0, rel=2e-3)
    assert 1.08 * (1 - 1e-6) <= finding.values["second"] <= 1.08
    assert "1.08 in the second half" in finding.message
    difference = np.diff(fit.halves.values[:, 0]) / np.hypot(*fit.halves.deviations[:, 0])
    assert finding.values["deviations"] == pytest.approx(difference[0], rel=0.02)


@pytest.mark.parametrize("correlation", [0.0, 0.7])
def test_differences_of_a_right_model_scatter_as_their_deviations_say(correlation):
    exact = oscillation(TIMES, *TRUTH)
    fits = [
        identify(oscillator(), recorded(exact, seed, correlation), start=TRUTH, starts=1) for seed in range(500, 560)
    ]
    differences = np.array([fit.halves.differences for fit in fits])
    assert np.all(np.abs(np.std(differences, axis=0) - 1) < 0.3)
    assert not any(drifts(fit) for fit in fits)
    assert not any(fit.halves.refitted for fit in fits)


def test_halves_that_agree_cost_no_simulation_and_others_few():
    sizes = np.ones(len(TIMES)), 1 + 0.1 * (TIMES > 4)
    agree, differ = (identify(LINE, recorded(size * np.sin(3 * TIMES)), starts=1) for size in sizes)
    assert not agree.halves.refitted
    assert agree.simulations == agree.starts[0].simulations + 1  # the response at the end
    assert differ.halves.refitted
    assert differ.simulations < differ.starts[0].simulations + 60


def test_a_half_that_does_not_determine_a_parameter_has_no_value_of_it():
    def late(slope, height):
        return slope * np.sin(3 * TIMES) + height * np.where(TIMES > 5, TIMES - 5, 0.0)

    model = PythonModel(late, {"slope": (0.5, 2.0), "height": (0.0, 2.0)}, ["x"], TIMES)
    fit = identify(model, recorded(late(1.0, 1.0)))
    assert np.isnan(fit.halves.values[0, 1])
    assert np.isnan(fit.halves.differences[1])
    np.testing.assert_allclose(fit.halves.values[1], 1.0, rtol=1e-2)


def test_a_parameter_on_a_bound_has_no_halves():
    model = PythonModel(
        lambda slope, level: slope * np.sin(3 * TIMES) + level, {"slope": (0.5, 2.0), "level": (0.1, 1.0)}, ["x"], TIMES
    )
    fit = identify(model, recorded(np.sin(3 * TIMES)))
    np.testing.assert_array_equal(np.isnan(fit.halves.values), [[False, True], [False, True]])


def test_a_short_record_has_no_halves():
    times = TIMES[:15]
    model = PythonModel(lambda slope: slope * times, {"slope": (0.5, 2.0)}, ["x"], times)
    assert identify(model, Measurements.of(times, {"x": times + 1e-3 * np.cos(9e3 * times)})).halves is None


def test_halves_are_stored(tmp_path):
    fit = identify(oscillator(), recorded(rubbing(TIMES, 30.0, 0.1, 0.3, 0.1), 1))
    again = Fit.from_xarray(fit.to_xarray())
    for name in ("values", "deviations", "differences"):
        np.testing.assert_array_equal(getattr(again.halves, name), getattr(fit.halves, name))
    assert again.halves.refitted
    assert again.summary() == fit.summary()
