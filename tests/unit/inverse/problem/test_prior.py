"""Priors in a fit by least squares: the maximum of the posterior density."""

import numpy as np
import pytest
from inline_snapshot import snapshot

import dalembert as da
from dalembert.data import Measurements
from dalembert.errors import InputError
from dalembert.forward import PythonModel
from dalembert.inverse import identify
from dalembert.inverse.problem.prior import prior_residual, prior_slopes
from dalembert.parameter import Parameter
from dalembert.parameters import Parameters
from dalembert.priors import AnyPrior, CorrelatedNormal, HalfNormal, LogNormal, Normal, Uniform

TIMES = np.linspace(0.0, 1.0, 6)
DESIGN = np.stack([TIMES, 1 - TIMES], axis=1)
SIGMA = 0.1
JOINT = CorrelatedNormal(("a", "b"), (1.2, 0.8), ((0.04, -0.015), (-0.015, 0.01)))


def line(**priors: AnyPrior | None) -> PythonModel:
    box = {name: Parameter(name, 0.01, 3.0, prior=priors.get(name)) for name in ("a", "b")}
    return PythonModel(lambda a, b: a * TIMES + b * (1 - TIMES), box, ["x"], TIMES)


def data() -> Measurements:
    return Measurements.of(TIMES, {"x": DESIGN @ [1.5, 0.6]}, deviations=SIGMA)


@pytest.mark.parametrize(
    ("priors", "mean", "covariance"),
    [
        ({"a": JOINT, "b": JOINT}, JOINT.mean, JOINT.covariance),
        ({"a": Normal(1.0, 0.05), "b": Normal(0.5, 0.2)}, (1.0, 0.5), ((0.0025, 0.0), (0.0, 0.04))),
        ({"a": HalfNormal(0.3), "b": HalfNormal(0.2)}, (0.0, 0.0), ((0.09, 0.0), (0.0, 0.04))),
    ],
)
def test_a_fit_with_normal_priors_is_the_closed_form(priors: dict, mean: tuple, covariance: tuple) -> None:
    fit = identify(line(**priors), data())
    information = DESIGN.T @ DESIGN / SIGMA**2 + np.linalg.inv(covariance)
    expected = np.linalg.solve(
        information, DESIGN.T @ data().values[:, 0] / SIGMA**2 + np.linalg.solve(covariance, mean)
    )
    np.testing.assert_allclose(fit.values, expected, rtol=1e-6)  # the search ends there
    np.testing.assert_allclose(fit.deviations, np.sqrt(np.diag(np.linalg.inv(information))), rtol=1e-6)


def test_a_log_normal_prior_gives_the_mode_of_the_logarithm() -> None:
    model = PythonModel(lambda a: a * TIMES, {"a": Parameter("a", 0.01, 3.0, prior=LogNormal(1.0, 0.02))}, ["x"], TIMES)
    fit = identify(model, Measurements.of(TIMES, {"x": 1.5 * TIMES}, deviations=SIGMA))
    a = np.linspace(1.0, 1.5, 500_001)
    misfit = np.sum(TIMES**2) * (a - 1.5) ** 2 / SIGMA**2 + (np.log(a) / 0.02) ** 2
    np.testing.assert_allclose(fit.values, [a[np.argmin(misfit)]], atol=2e-6)


def test_a_uniform_prior_changes_nothing() -> None:
    plain, uniform = identify(line(), data()), identify(line(a=Uniform(0.0, 4.0)), data())
    assert plain.values.tolist() == uniform.values.tolist()
    assert plain.degrees_of_freedom == uniform.degrees_of_freedom


def test_slopes_of_prior_residuals_are_those_of_differences() -> None:
    joint = CorrelatedNormal(("d", "a"), (1.2, 0.8), ((0.04, -0.015), (-0.015, 0.01)))
    known = {"a": joint, "b": LogNormal(1.0, 0.2), "c": None, "d": joint, "e": Normal(1.0, 0.1)}
    parameters = Parameters(tuple(Parameter(name, 0.01, 3.0, prior=prior) for name, prior in known.items()))
    vector, unit, step = np.array([0.9, 1.1, 1.3, 0.7, 1.0]), np.array([1.0, 2.0, 3.0, 4.0, 5.0]), 1e-6
    moved = vector + step * np.eye(5), vector - step * np.eye(5)
    differences = (prior_residual(parameters, moved[0]) - prior_residual(parameters, moved[1])).T / (2 * step)
    np.testing.assert_allclose(prior_slopes(parameters, vector, unit), differences * unit, atol=1e-7)


def test_priors_need_known_noise() -> None:
    with pytest.raises(InputError) as error:
        identify(line(a=LogNormal(1.0, 0.1)), Measurements.of(TIMES, {"x": TIMES}))
    assert str(error.value) == snapshot(
        "parameter 'a' has a prior (log-normal), but the noise level of the data is not known; give the data's deviations, or weights that are 1/variance"
    )


def test_a_narrow_prior_that_contradicts_the_data_is_named_by_a_fit():
    """10 ± 0.01 against data of 2: the residuals that it leaves are correlated, which must not hide it."""
    times = np.linspace(0.0, 1.0, 50)
    parameter = da.Parameter("slope", 0.1, 20.0, start=10.0, prior=da.Normal(10.0, 0.01))
    model = da.PythonModel(lambda slope: slope * times, [parameter], ["x"], times)
    noise = 0.05 * np.random.default_rng(0).standard_normal(50)
    fit = da.identify(model, da.Measurements.of(times, {"x": 2 * times + noise}, 0.05))
    (found,) = (item for item in fit.conclusions if item.code == "prior-conflict")
    assert found.values["parameter"] == "slope"
    estimate, deviation = 2 + times @ noise / (times @ times), 0.05 / np.linalg.norm(times)
    assert found.values["deviations"] == pytest.approx((10 - estimate) / np.hypot(0.01, deviation), rel=1e-3)


@pytest.mark.parametrize(
    ("number", "apart", "conflict"), [(1, 3.1, True), (1, 2.9, False), (10, 3.1, False), (10, 4.0, True)]
)
def test_priors_share_the_probability_of_a_false_alarm(number: int, apart: float, conflict: bool) -> None:
    """Priors and data of equal deviation: a single prior conflicts from 3 deviations on, one of ten from 3.64 on."""
    times = np.arange(float(number))
    priors = {f"p{k}": Parameter(f"p{k}", -9.0, 9.0, start=0.0, prior=Normal(0.0, 0.1)) for k in range(number)}
    model = PythonModel(lambda **values: np.array(list(values.values())), priors, ["x"], times)
    data = np.where(times == 0, apart * np.hypot(0.1, 0.1), 0.0)
    fit = identify(model, Measurements.of(times, {"x": data}, 0.1), starts=1)
    found = [item.values for item in fit.conclusions if item.code == "prior-conflict"]
    assert found == ([{"parameter": "p0", "deviations": pytest.approx(apart, rel=1e-6)}] if conflict else [])


def test_the_misfit_of_a_summary_counts_the_values_that_were_fitted():
    times = np.linspace(0.0, 1.0, 50)
    model = da.PythonModel(lambda slope: slope * times, {"slope": (0.1, 20.0)}, ["x"], times)
    noise = 0.05 * np.random.default_rng(0).standard_normal(50)
    fit = da.identify(model, da.Measurements.of(times, {"x": 2 * times + noise}), validation=0.2)
    assert fit.facts()["fitted values"] == "40"
