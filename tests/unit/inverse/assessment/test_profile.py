"""Profile likelihood against closed forms, on open sides, at failures, from no minimum, and in a file."""

from dataclasses import replace

import numpy as np
import pytest
from inline_snapshot import snapshot
from scipy.optimize import brentq
from scipy.stats import chi2, f

from conclusions import codes, only
from dalembert.data import Measurements
from dalembert.errors import InputError
from dalembert.forward import PythonModel
from dalembert.inverse import Experiment, Profiles, identify, profile
from dalembert.parameter import Parameter
from small_models import DECAY, LINE, TIMES, measured
from support import says


@pytest.mark.parametrize("known", [True, False])
@pytest.mark.parametrize("level", [0.68, 0.95])
def test_a_linear_case_has_the_closed_form(known, level):
    """value ∓ √(quantile s² (JᵀWJ)⁻¹), and the others along the regression line."""
    data = measured(LINE, [1.0, -0.5], noise=0.3, deviations=0.3 if known else None)
    fit = identify(LINE, data)
    told = profile(LINE, data, fit, level=level)
    jacobian = LINE.jacobian(fit.values).reshape(-1, 2)
    freedom = jacobian.shape[0] - 2
    variance = 0.09 if known else fit.misfit / freedom
    covariance = variance * np.linalg.inv(jacobian.T @ jacobian)
    quantile = chi2.ppf(level, 1) if known else f.ppf(level, 1, freedom)
    radius = np.sqrt(quantile * np.diag(covariance))
    for k, name in enumerate(LINE.parameters.names):
        np.testing.assert_allclose(told.intervals[name], fit.values[k] + radius[k] * np.array([-1, 1]), rtol=1e-6)
        curve = told[name]
        np.testing.assert_allclose(curve.excess, (curve.values - fit.values[k]) ** 2 / covariance[k, k], atol=2e-6)
        line = fit.values[1 - k] + covariance[0, 1] / covariance[k, k] * (curve.values - fit.values[k])
        np.testing.assert_allclose(curve.points[:, 1 - k], line, atol=1e-6)
    assert told.success
    assert codes(told) == ["profile-level"]


def test_one_parameter_alone_crosses_where_its_misfit_does():
    model = PythonModel(lambda rate: np.exp(-rate * TIMES), {"rate": (0.1, 9.0)}, ["x"], TIMES)
    data = measured(model, [2.0], noise=0.1, seed=3, deviations=0.1)
    fit = identify(model, data)
    told = profile(model, data, fit)

    def excess(rate):
        return np.sum((np.exp(-rate * TIMES) - data.values[:, 0]) ** 2) / 0.01 - fit.misfit - chi2.ppf(0.95, 1)

    expected = brentq(excess, 0.1, fit.values[0]), brentq(excess, fit.values[0], 9.0)
    np.testing.assert_allclose(told.intervals["rate"], expected, rtol=1e-5)
    assert told["rate"].values[0] < expected[0] < expected[1] < told["rate"].values[-1]


def test_a_nonlinear_case_is_that_of_a_scan():
    """The other parameter enters linearly, so that the profile is known for every rate."""
    data = measured(DECAY, [1.0, 0.8], noise=0.15, seed=1, deviations=0.15)
    fit = identify(DECAY, data)
    told = profile(DECAY, data, fit)

    def excess(rate):
        shape, x = np.exp(-rate * TIMES), data.values[:, 0]
        return (x @ x - (shape @ x) ** 2 / (shape @ shape)) / 0.15**2 - fit.misfit

    curve = told["rate"]
    np.testing.assert_allclose(curve.excess, [excess(rate) for rate in curve.values], atol=1e-5)
    threshold = chi2.ppf(0.95, 1)
    ends = [brentq(lambda rate: excess(rate) - threshold, *side) for side in ((0.1, fit.values[1]), (fit.values[1], 3))]
    np.testing.assert_allclose(told.intervals["rate"], ends, rtol=1e-5)


def test_two_parameters_that_make_up_for_each_other_have_open_sides():
    model = PythonModel(lambda a, b: (a + b) * TIMES, {"a": (0.0, 1.0), "b": (0.5, 3.0)}, ["x"], TIMES)
    data = measured(model, [0.5, 1.5], noise=0.01, deviations=0.01)
    told = profile(model, data, identify(model, data))
    assert told.intervals["a"] == (0.0, 1.0)
    assert told["a"].open == (True, True)
    assert told.success
    assert str(told.outcome[1]) == snapshot(
        "'a' is not identifiable: all values between its bounds explain the data within their noise. Fix it, or measure a quantity that depends on it."
    )
    lower, upper = told.intervals["b"]  # between 2 − 1 and 2 − 0, and what noise allows
    assert (lower, upper) == pytest.approx((1.0, 2.0), abs=0.01)


def test_a_side_without_a_limit_is_told():
    """Only large rates are told apart from zero: beyond some rate the decay is over before the second sample."""
    times = np.linspace(0, 4, 5)
    model = PythonModel(lambda rate: np.exp(-rate * times), {"rate": (0.1, 50.0)}, ["x"], times)
    data = Measurements.of(times, {"x": [1.0, 0.001, 0.0, 0.0, 0.0]}, deviations=0.05)
    told = profile(model, data, identify(model, data))
    assert told["rate"].open == (False, True)
    assert str(told.outcome[1]) == snapshot(
        "The data give no upper limit of 'rate': all values up to its bound 50 explain them within their noise. Measure a quantity that depends on it."
    )
    assert codes(told) == ["profile-level", "open-interval"]
    assert "open: upper bound" in told.summary()


def test_further_intervals_are_told_and_mirror_the_first():
    square = PythonModel(lambda a, b: b + a**2 * TIMES, {"a": (-3.0, 2.0), "b": (-1.0, 1.0)}, ["x"], TIMES)
    data = measured(square, [1.5, 0.2], noise=0.1, deviations=0.1)
    told = profile(square, data, identify(square, data))
    ((lower, upper),) = told["a"].elsewhere
    np.testing.assert_allclose((-upper, -lower), told.intervals["a"], rtol=1e-5)
    assert told["b"].elsewhere == ()
    assert only(told, "further-intervals").values == {"parameter": "a", "intervals": 1}
    assert told.success
    names = [trace.name for trace in told.figures()["profile-1"].data]
    assert "not contradicted either" in names


def test_further_intervals_come_back_from_a_file(tmp_path):
    square = PythonModel(lambda a: a**2 * TIMES, {"a": (-3.0, 2.0)}, ["x"], TIMES)
    data = measured(square, [1.5], noise=0.1, deviations=0.1)
    told = profile(square, data, identify(square, data))
    told.save(tmp_path / "profiles.nc")
    back = Profiles.load(tmp_path / "profiles.nc")
    assert back["a"].elsewhere == told["a"].elsewhere != ()
    assert back.status == told.status


def test_a_lopsided_interval_is_told():
    times = np.linspace(0, 4, 9)
    model = PythonModel(lambda rate: np.exp(-rate * times), {"rate": (0.1, 50.0)}, ["x"], times)
    data = measured(model, [3.0], deviations=0.06)
    told = profile(model, data, identify(model, data))
    assert codes(told) == ["profile-level", "asymmetric-interval"]
    assert str(told.outcome[1]) == snapshot(
        "The interval of 'rate' is asymmetric, 0.746 below and 1.38 above its value: the standard deviation 0.486 does not describe it."
    )


def test_a_fit_that_is_no_minimum_is_told():
    data = measured(LINE, [1.0, -0.5], noise=0.1, deviations=0.1)
    fit = identify(LINE, data)
    off = replace(fit, values=fit.values + 3 * fit.deviations)
    told = profile(LINE, data, off)
    assert not told.success
    assert told.better is not None
    assert only(told, "better-minimum").values == told.better


def test_a_side_that_ends_where_the_model_fails_says_why():
    def response(rate):
        if np.real(rate) > 1.02:
            raise ValueError("too fast")
        return np.exp(-rate * TIMES)

    model = PythonModel(response, {"rate": (0.5, 2.0)}, ["x"], TIMES)
    data = Measurements.of(TIMES, {"x": np.exp(-TIMES)}, deviations=0.1)
    told = profile(model, data, identify(model, data, start=[1.0], starts=1))
    assert not told.success
    lower, upper = told["rate"].broken
    assert lower == ""
    assert upper.startswith("ValueError: too fast")
    incomplete = only(told, "incomplete-profile").values
    assert (incomplete["parameter"], incomplete["side"], incomplete["reason"]) == ("rate", "upper", upper)


def test_a_prior_narrows_the_profile_as_it_does_the_deviation():
    box = {"offset": Parameter("offset", -5.0, 5.0, start=1.0, deviation=0.05), "slope": (-5.0, 5.0)}
    model = PythonModel(LINE.function, box, ["x", "y"], TIMES)
    data = measured(model, [1.0, -0.5], noise=0.3, deviations=0.3)
    fit = identify(model, data)
    told = profile(model, data, fit)
    jacobian = LINE.jacobian(fit.values).reshape(-1, 2) / 0.3
    covariance = np.linalg.inv(jacobian.T @ jacobian + np.diag([0.05**-2, 0.0]))
    np.testing.assert_allclose(fit.deviations, np.sqrt(np.diag(covariance)), rtol=1e-9)
    radius = np.sqrt(chi2.ppf(0.95, 1) * np.diag(covariance))
    np.testing.assert_allclose(told.intervals["offset"], fit.values[0] + radius[0] * np.array([-1, 1]), rtol=1e-6)


def test_experiments_are_profiled_together():
    experiments = [
        Experiment(name, DECAY, measured(DECAY, [size, 0.8], 0.05, seed, deviations=0.05), local=("size",))
        for seed, (name, size) in enumerate({"first": 1.0, "second": 2.0}.items())
    ]
    fit = identify(experiments)
    told = profile(experiments, None, fit, names=["rate"])
    assert list(told.intervals) == ["rate"]
    lower, upper = told.intervals["rate"]
    assert lower < 0.8 < upper
    assert (upper - lower) / 2 == pytest.approx(1.96 * fit.deviations[fit.parameters.names.index("rate")], rel=0.05)


def test_a_file_gives_back_the_same_bits(tmp_path):
    data = measured(DECAY, [1.0, 0.8], noise=0.1, deviations=0.1)
    told = profile(DECAY, data, identify(DECAY, data))
    told.save(tmp_path / "a.nc")
    back = Profiles.load(tmp_path / "a.nc")
    assert back.summary() == told.summary()
    for one, other in zip(back.curves, told.curves, strict=True):
        for name in ("values", "excess", "points"):
            assert getattr(one, name).tobytes() == getattr(other, name).tobytes()
        assert (one.lower, one.upper, one.open, one.broken) == (other.lower, other.upper, other.open, other.broken)
    assert back.provenance == told.provenance


def test_events_tell_each_value():
    data = measured(DECAY, [1.0, 0.8], noise=0.1, deviations=0.1)
    fit, events = identify(DECAY, data), []
    told = profile(DECAY, data, fit, names=["rate"], on_event=events.append)
    assert {event.parameter for event in events} == {"rate"}
    assert events[-1].simulations <= told.simulations


def test_what_cannot_be_meant_is_refused():
    data = measured(DECAY, [1.0, 0.8], noise=0.1)
    fit = identify(DECAY, data)
    with pytest.raises(InputError, match=says("profile: level is 95; expected a number between 0 and 1, such as 0.95")):
        profile(DECAY, data, fit, level=95)
    with pytest.raises(InputError, match=says("profile: points is 3; expected a whole number, at least 4")):
        profile(DECAY, data, fit, points=3)
    with pytest.raises(InputError, match=says("profile: names: unknown parameter 'rat'; did you mean 'rate'?")):
        profile(DECAY, data, fit, names=["rat"])
    with pytest.raises(InputError, match="profile: the model has the parameters offset, slope, the fit size, rate"):
        profile(LINE, data, fit)
    with pytest.raises(InputError, match="profile: data is missing"):
        profile(DECAY, None, fit)
    robust = identify(DECAY, data, loss="huber", loss_scale=0.1)
    with pytest.raises(InputError, match="profile: the fit has the loss 'huber', whose minimum is no likelihood"):
        profile(DECAY, data, robust)


def test_experiments_need_no_data_and_a_fit_is_asked_for():
    experiments = [Experiment(name, LINE, measured(LINE, [1.0, -0.5], noise=0.3)) for name in ("one", "two")]
    fit = identify(experiments, starts=1)
    assert profile(experiments, fit=fit).intervals == profile(experiments, None, fit).intervals
    with pytest.raises(
        InputError, match=says("profile: no fit was given; give the one whose parameters are profiled, fit=...")
    ):
        profile(experiments)
