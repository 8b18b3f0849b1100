"""Criteria and predictive densities of models against closed forms, exact refits and other code."""

import numpy as np
import pytest
from scipy.stats import multivariate_normal, multivariate_t, norm, t

from correlated_noise import autoregressive
from dalembert.data import Measurements
from dalembert.forward import PythonModel
from dalembert.inverse import (
    AutoregressiveNoise,
    ConstantNoise,
    compare_models,
    cross_validate,
    identify,
    likelihood,
    sample,
)
from dalembert.inverse.comparison.left_out import counted_groups, groups
from dalembert.inverse.comparison.linearisation import linearised
from stack_loss import STACK

TOPIC = "Model comparison"
TIMES = np.linspace(0, 3, 30)
COLUMNS = np.stack([np.ones(30), TIMES, np.sin(4 * TIMES)], axis=1)
BOX = (-9.0, 9.0)


def model(columns, times=TIMES):
    names = [f"p{k}" for k in range(columns.shape[1])]
    return PythonModel(
        lambda **values: columns @ np.array([values[name] for name in names]), dict.fromkeys(names, BOX), ["x"], times
    )


def recorded(deviations=None, seed=2):
    noise = 0.2 * np.random.default_rng(seed).standard_normal(30)
    return Measurements.of(TIMES, {"x": COLUMNS @ [1.0, 0.5, 0.3] + noise}, deviations)


def fitted(columns, data):
    return identify(model(columns), data, starts=1, horizon=None)


@pytest.mark.parametrize("deviations", [None, 0.2], ids=["unknown noise", "known noise"])
def test_values_left_out_are_predicted_as_by_exact_refits(deviations, record_evidence, request):
    data = recorded(deviations)
    y, expected = data.values[:, 0], []
    for k in range(30):
        kept = np.arange(30) != k
        own, x = COLUMNS[kept], COLUMNS[k]
        found, squares, *_ = np.linalg.lstsq(own, y[kept], rcond=None)
        width = 1 + x @ np.linalg.solve(own.T @ own, x)
        if deviations is None:
            expected.append(t(26).logpdf((y[k] - x @ found) / np.sqrt(width * squares[0] / 26))
                            - 0.5 * np.log(width * squares[0] / 26))  # fmt: skip
        else:
            expected.append(norm(x @ found, deviations * np.sqrt(width)).logpdf(y[k]))
    at = linearised("x", fitted(COLUMNS, data))
    ours = [at.without(np.array([k])) for k in range(30)]
    record_evidence(
        f"linear model, {request.node.callspec.id}: log predictive densities of single values", expected, ours,
        tolerance=1e-7, topic=TOPIC, kind="closed form", source="refit without each value by NumPy", noisy=True,
    )  # fmt: skip


def test_blocks_left_out_have_the_multivariate_density_of_refits(record_evidence):
    data = recorded()
    fit = fitted(COLUMNS, data)
    places = counted_groups(groups(fit, "blocks", 5))
    y, expected = data.values[:, 0], []
    for rows in places:
        kept = np.setdiff1d(np.arange(30), rows)
        own, x = COLUMNS[kept], COLUMNS[rows]
        found, squares, *_ = np.linalg.lstsq(own, y[kept], rcond=None)
        width = np.eye(len(rows)) + x @ np.linalg.solve(own.T @ own, x.T)
        freedom = len(kept) - 3
        expected.append(multivariate_t(x @ found, width * squares[0] / freedom, freedom).logpdf(y[rows]))
    at = linearised("x", fit)
    record_evidence(
        "linear model: log predictive densities of five blocks", expected, [at.without(rows) for rows in places],
        tolerance=1e-7, topic=TOPIC, kind="closed form", source="refit without each block, Student's t of SciPy",
        noisy=True,
    )  # fmt: skip
    again = cross_validate(model(COLUMNS), data, fit=fit, blocks=5)
    record_evidence(
        "linear model: log predictive densities by cross-validation", expected, again.log_densities, tolerance=1e-6,
        topic=TOPIC, kind="closed form", source="refit without each block, Student's t of SciPy", noisy=True,
    )  # fmt: skip
    hat = COLUMNS @ np.linalg.solve(COLUMNS.T @ COLUMNS, COLUMNS.T)
    press = np.concatenate(
        [np.linalg.solve(np.eye(len(rows)) - hat[np.ix_(rows, rows)], (y - hat @ y)[rows]) for rows in places]
    )
    record_evidence(
        "linear model: prediction errors of blocks, PRESS formula", press, -again.errors[:, 0], tolerance=1e-7,
        topic=TOPIC, kind="closed form", source="(I − H)⁻¹ e (Allen 1974)", noisy=True,
    )  # fmt: skip


def covariance(times, coefficient, sigma):
    """Of an autoregressive process of order 1 on an even grid."""
    lags = np.abs(times[:, None] - times) / (times[1] - times[0])
    return sigma**2 * coefficient**lags


@pytest.mark.parametrize("size", [1, 5])
def test_values_are_predicted_from_correlated_neighbours_as_by_exact_refits(size, record_evidence):
    """Known AR(1) noise: generalised least squares without a group, and the conditional density of the group."""
    data, coefficient, sigma = recorded(), 0.6, 0.2
    fit = identify(
        model(COLUMNS), data, noise=AutoregressiveNoise(deviation=ConstantNoise(deviation=sigma), order=1, partial=[coefficient]),
        starts=1, horizon=None,
    )  # fmt: skip
    y, whole = data.values[:, 0], covariance(TIMES, coefficient, sigma)
    places, expected = np.split(np.arange(30), 30 // size), []
    for rows in places:
        kept = np.setdiff1d(np.arange(30), rows)
        precision = np.linalg.inv(whole[np.ix_(kept, kept)])
        spread = np.linalg.inv(COLUMNS[kept].T @ precision @ COLUMNS[kept])
        found = spread @ COLUMNS[kept].T @ precision @ y[kept]
        pull = whole[np.ix_(rows, kept)] @ precision
        mean = COLUMNS[rows] @ found + pull @ (y[kept] - COLUMNS[kept] @ found)
        lever = COLUMNS[rows] - pull @ COLUMNS[kept]
        width = whole[np.ix_(rows, rows)] - pull @ whole[np.ix_(kept, rows)] + lever @ spread @ lever.T
        expected.append(multivariate_normal(mean, width).logpdf(y[rows]))
    at = linearised("x", fit)
    record_evidence(
        f"linear model, known AR(1) noise: log predictive densities of groups of {size}", expected,
        [at.without(rows) for rows in places], tolerance=1e-7, topic=TOPIC, kind="closed form",
        source="generalised least squares and the normal density given the other values, by NumPy and SciPy", noisy=True,
    )  # fmt: skip


KNOWN_AR1 = AutoregressiveNoise(deviation=ConstantNoise(deviation=0.2), order=1, partial=[0.6])


def test_likelihoods_of_blocks_are_normal_densities_given_all_other_values(record_evidence):
    """Two channels with gaps and a block that is torn by one, at two vectors."""
    values = np.stack([recorded().values[:, 0], recorded(seed=3).values[:, 0]], axis=1)
    values[[4, 5, 17], 0] = np.nan
    both = PythonModel(lambda a, b: (COLUMNS @ [a, b, 0.3])[:, None] * [1, 2], {"a": BOX, "b": BOX}, ["x", "y"], TIMES)
    data = Measurements(recorded().coordinate, ("x", "y"), values, missing="leave-out")
    likely = likelihood(both, data, noise=KNOWN_AR1)
    rows, names = likely.places.row, likely.places.channel
    blocks, expected = rows // 7, []
    for a, b in ((1.0, 0.5), (0.8, 0.7)):
        residual = values - (COLUMNS @ [a, b, 0.3])[:, None] * [1, 2]
        for block in range(5):
            total = 0.0
            for column, name in enumerate("xy"):
                there = rows[names == name]
                whole = covariance(TIMES, 0.6, 0.2)[np.ix_(there, there)]
                own, error = there // 7 == block, residual[there, column]
                pull = whole[np.ix_(own, ~own)] @ np.linalg.inv(whole[np.ix_(~own, ~own)])
                width = whole[np.ix_(own, own)] - pull @ whole[np.ix_(~own, own)]
                total += multivariate_normal(pull @ error[~own], width).logpdf(error[own])
            expected.append(total)
    (ours,) = likely.left_out([[1.0, 0.5], [0.8, 0.7]], blocks)
    record_evidence(
        "AR(1) noise with gaps, two channels: log-likelihood of each block given all other values", expected,
        ours.ravel(), tolerance=1e-9, topic=TOPIC, kind="closed form",
        source="conditional normal densities by NumPy and SciPy", noisy=True,
    )  # fmt: skip


@pytest.mark.slow
def test_draws_predict_groups_of_correlated_values_as_exact_refits_do(record_evidence):
    """Known noise and flat priors: the linearised fit is exact, and the draws have its predictive densities.

    Tolerances are four standard deviations of importance sampling: 0.013 and 0.126 over twelve seeds of 4,000
    independent draws. A block of three values out of 30 moves the posterior more than a single value does.
    """
    data = recorded()
    fits = {
        name: identify(model(columns), data, noise=KNOWN_AR1, starts=1, horizon=None)
        for name, columns in (("three", COLUMNS), ("two", COLUMNS[:, :2]))
    }
    posteriors = {
        name: sample(model(COLUMNS[:, : len(fit.values)]), data, noise=KNOWN_AR1, start=fit, warmup=300, seed=4)
        for name, fit in fits.items()
    }
    for left_out, blocks, tolerance in (("values", None, 0.05), ("blocks", 10, 0.5)):
        found = compare_models(posteriors, leave_out=left_out)
        exact = compare_models(fits, leave_out=left_out, blocks=blocks)
        assert found.models == exact.models
        record_evidence(
            f"linear models, known AR(1) noise: elpd of posterior draws, {left_out} left out", exact.elpd, found.elpd,
            tolerance=tolerance, topic=TOPIC, kind="closed form", source="generalised least squares without each group",
            noisy=True,
        )  # fmt: skip


@pytest.mark.parametrize(
    ("noise", "tolerance"), [(ConstantNoise(), 0.05), (AutoregressiveNoise(order=1), 0.2)], ids=["constant", "AR(1)"]
)
def test_estimated_noise_without_a_value_is_that_of_a_refit(noise, tolerance, record_evidence, request):
    """The sum of log densities beside refits of model and noise without each value; a difference of 4 counts."""
    times = np.linspace(0, 3, 90)
    columns = np.stack([np.ones(90), times], axis=1)
    data = Measurements.of(times, {"x": columns @ [1.0, 0.5] + 0.2 * autoregressive(3, 90, 0.5)})
    fit = identify(model(columns, times), data, noise=noise, starts=1, horizon=None)
    at = linearised("x", fit)
    ours = sum(at.without(np.array([row])) for row in range(90))
    again = cross_validate(model(columns, times), data, fit=fit, leave_out="values")
    record_evidence(
        f"linear model, estimated noise, {request.node.callspec.id}: expected log predictive density",
        float(np.sum(again.log_densities)), ours, tolerance=tolerance, topic=TOPIC, kind="other method",
        source="90 refits of model and noise", noisy=True,
    )  # fmt: skip


def test_criteria_of_a_published_regression(record_evidence):
    days = np.arange(21.0)
    data = Measurements.of(days, {"loss": STACK[:, 3]})
    fits = {}
    for name, count in (("all", 4), ("without acid", 3)):
        columns = np.column_stack([np.ones(21), STACK[:, :3]])[:, :count]
        own = PythonModel(
            lambda columns=columns, **values: columns @ np.array([values[f"p{k}"] for k in range(columns.shape[1])]),
            {f"p{k}": (-100.0, 100.0) for k in range(count)}, ["loss"], days,
        )  # fmt: skip
        fits[name] = identify(own, data, starts=1, horizon=None)
    found = compare_models(fits)
    place = found.models.index("all")
    for quantity, reference, ours in (
        ("log-likelihood", -52.28779550239973, found.log_likelihood[place]),
        ("AIC", 112.57559100479946 + 2, found.aic[place]),
        ("BIC", 116.75368075569315 + np.log(21), found.bic[place]),
    ):
        record_evidence(
            f"stack loss: {quantity}, the variance of the noise counted as a parameter", reference, ours,
            tolerance=1e-9, topic=TOPIC, kind="other code", source="statsmodels 0.15: OLS, plus one parameter",
        )  # fmt: skip


def test_the_right_model_is_chosen_over_many_seeds(record_evidence):
    """Where the third column acts, it is chosen; where it does not, the models are equal or the simple one is."""
    chosen, alike = 0, 0
    for seed in range(60):
        noise = 0.2 * np.random.default_rng(seed).standard_normal(30)
        for amplitude in (0.3, 0.0):
            data = Measurements.of(TIMES, {"x": COLUMNS @ [1.0, 0.5, amplitude] + noise})
            fits = {"sine": fitted(COLUMNS, data), "line": fitted(COLUMNS[:, :2], data)}
            found = compare_models(fits)
            if amplitude:
                chosen += found.models[0] == "sine"
            else:
                alike += found.models[0] == "line" or found.findings[0].code == "equal-models"
    record_evidence(
        "share of 60 records whose model with a sine is ranked first", 1.0, chosen / 60, tolerance=0.05, topic=TOPIC,
        kind="known truth", source="sine of 1.5 times the noise",
    )  # fmt: skip
    record_evidence(
        "share of 60 records without a sine in which no difference is claimed for it", 1.0, alike / 60, tolerance=0.05,
        topic=TOPIC, kind="known truth", source="no sine",
    )  # fmt: skip
