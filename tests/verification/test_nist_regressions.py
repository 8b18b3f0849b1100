"""Nonlinear regressions of NIST: certified values and deviations, from two starts, with wide bounds and defaults."""

from functools import cache

import numpy as np
import pytest

from nist_regressions import MODELS, TOO_FAR, Regression, digits, lm, ours, trf

TOPIC = "Least squares: NIST regressions"
SOURCE = "NIST Statistical Reference Datasets, nonlinear regression"


@pytest.fixture(scope="module")
def regressions(reference):
    return {name: Regression(name, given) for name, given in reference("nist_regressions").items()}


@cache
def fitted(problem, number):
    """Values and deviations over the certified ones, both (parameters,), of an identification with defaults."""
    fit = problem.fit(problem.starts[number])
    values, order = problem.as_certified(fit.values)
    assert fit.success
    # Those that NIST certifies are for independent residuals.
    deviations = fit.deviations if fit.correlated is None else fit.correlated.deviations
    return values / problem.values, deviations[order] / np.array(problem.given["deviations"])


def starts_of(name):
    return [number for number in (0, 1) if (name, number) != TOO_FAR]


@pytest.mark.parametrize("name", MODELS)
def test_values_and_deviations_are_the_certified_ones(name, regressions, record_evidence):
    starts = starts_of(name)
    found = [fitted(regressions[name], number) for number in starts]
    values, deviations = (np.array(all_of) for all_of in zip(*found, strict=True))
    which = "both starts" if len(starts) == 2 else f"start {starts[0] + 1}"
    common = {"tolerance": 1e-4, "topic": TOPIC, "kind": "published", "source": SOURCE}
    record_evidence(f"{name}, {which}: values over the certified ones", np.ones_like(values), values, **common)
    record_evidence(f"{name}, {which}: deviations over the certified ones", np.ones_like(values), deviations, **common)


def test_a_fit_from_too_far_a_start_is_no_success(regressions):
    name, number = TOO_FAR
    fit = regressions[name].fit(regressions[name].starts[number])
    assert not fit.success
    assert fit.misfit > 1e5 * regressions[name].given["squares"]
    assert fit.outcome[0].code == "not-converged"
    lost = [finding.values for finding in fit.conclusions if finding.code == "unidentifiable-parameter"]
    assert lost == [{"parameter": "b2"}, {"parameter": "b3"}]


def test_half_of_the_fits_have_six_digits(regressions, record_evidence):
    assert set(regressions) == set(MODELS)
    found = [fitted(problem, k) for name, problem in regressions.items() for k in starts_of(name)]
    assert len(found) == 33
    reached = sum(digits(values) > 4 for values, _ in found)
    assert reached == 33
    record_evidence(
        "fits from each of 34 starts: share with four digits", 1.0, reached / 34, tolerance=None, topic=TOPIC,
        kind="published", source=f"{SOURCE}; from start 1 of MGH10 the fit is reported as not converged",
    )  # fmt: skip
    assert np.median([digits(values) for values, _ in found]) > 6
    assert np.median([digits(deviations) for _, deviations in found]) > 6


def test_one_descent_needs_no_more_evaluations_than_trf_and_lm(regressions, record_evidence):
    """Over the fits that all of them bring to four digits; a jacobian counts as one evaluation a parameter."""
    reached, spent = {}, {}
    for method in (ours, trf, lm):
        for name, problem in regressions.items():
            for number, start in enumerate(problem.starts):
                problem.evaluations = 0
                values, _ = problem.as_certified(method(problem, start))
                reached[method, name, number] = digits(values / problem.values) > 4
                spent[method, name, number] = problem.evaluations
    for peer in (trf, lm):
        source = f"scipy.optimize.least_squares, {peer.__name__}, tolerance 1e-14"
        record_evidence(
            "one descent from each of 34 starts: share with four digits",
            sum(reached[peer, name, number] for name in MODELS for number in (0, 1)) / 34,
            sum(reached[ours, name, number] for name in MODELS for number in (0, 1)) / 34,
            tolerance=None, topic=TOPIC, kind="other code", source=source,
        )  # fmt: skip
        for name in MODELS:
            both = [k for k in (0, 1) if reached[peer, name, k] and reached[ours, name, k]]
            if not both:
                continue
            theirs, mine = (sum(spent[method, name, k] for k in both) for method in (peer, ours))
            starts = f"start{'s' if len(both) > 1 else ''} {' and '.join(str(k + 1) for k in both)}"
            record_evidence(
                f"{name}, {starts}: evaluations of one descent", theirs, mine,
                tolerance=None, topic=TOPIC, kind="other code", source=source,
            )  # fmt: skip
        assert all(reached[ours, name, k] for name in MODELS for k in starts_of(name))
        both = [key[1:] for key in reached if key[0] is ours and reached[key] and reached[peer, *key[1:]]]
        assert sum(spent[ours, *key] for key in both) <= sum(spent[peer, *key] for key in both)
