"""Intervals hold the truth as often as they say, in 500 seeded repetitions."""

import json

import numpy as np
import pytest
from scipy.stats import chi2

import beam_coverage
from correlated_coverage import CASES, TABLE
from correlated_noise import autoregressive
from dalembert.data import Measurements
from dalembert.forward import PythonModel
from dalembert.inverse import identify, predict, profile

TOPIC = "Statistics of estimates"
SOURCE = "the definition of a confidence interval, 500 repetitions"
LEVEL, REPETITIONS, NOISE = 0.95, 500, 0.1
TIMES = np.linspace(0, 2, 21)

LINE = PythonModel(lambda offset, slope: offset + slope * TIMES, {"offset": (-5, 5), "slope": (-5, 5)}, ["x"], TIMES)
DECAY = PythonModel(
    lambda rate, height: height * np.exp(-rate * TIMES), {"rate": (0.1, 5.0), "height": (0.1, 3.0)}, ["x"], TIMES
)


def covered(model, truth, *, known):
    """Share of repetitions in which the truth is held: by intervals of each parameter, by bands sample by sample."""
    exact = model.evaluate(np.array([truth])).only()[0]
    hits = {"deviations": np.zeros(2), "profile": np.zeros(2), "bands": 0.0}
    for seed in range(REPETITIONS):
        noisy = exact + NOISE * np.random.default_rng(seed).standard_normal(exact.shape)
        data = Measurements.of(TIMES, {"x": noisy[:, 0]}, deviations=NOISE if known else None)
        fit = identify(model, data, starts=1, horizon=None, start=truth)
        profiles = profile(model, data, fit, level=LEVEL)
        found = {"deviations": fit.intervals(LEVEL), "profile": profiles.intervals}
        for way, intervals in found.items():
            hits[way] += [
                lower <= value <= upper for value, (lower, upper) in zip(truth, intervals.values(), strict=True)
            ]
        bands = predict(model, fit, LEVEL)
        hits["bands"] += np.mean((bands.lower <= exact) & (exact <= bands.upper))
    return {way: count / REPETITIONS for way, count in hits.items()}


@pytest.mark.slow
@pytest.mark.parametrize("known", [True, False], ids=["given-noise", "estimated-noise"])
@pytest.mark.parametrize(
    ("name", "model", "truth"),
    [("a straight line", LINE, (1.0, 0.5)), ("a decay", DECAY, (1.0, 1.0))],
    ids=["linear", "mildly-nonlinear"],
)
def test_95_percent_intervals_hold_the_truth_in_93_to_97_percent(record_evidence, name, model, truth, known):
    found = covered(model, truth, known=known)
    noise = "given" if known else "estimated"
    for way, words in (("deviations", "value ∓ quantile × deviation"), ("profile", "profile likelihood")):
        for parameter, share in zip(model.parameters.names, found[way], strict=True):
            record_evidence(
                f"coverage of {words}, {parameter} of {name}, noise {noise}",
                LEVEL,
                share,
                tolerance=0.02,
                topic=TOPIC,
                kind="known truth",
                source=SOURCE,
            )
    record_evidence(
        f"coverage of prediction bands, {name}, noise {noise}",
        LEVEL,
        found["bands"],
        tolerance=0.02,
        topic=TOPIC,
        kind="known truth",
        source=SOURCE,
    )


TIMES_200 = np.linspace(0, 10, 200)
DRIFT = PythonModel(
    lambda offset, slope: offset + slope * TIMES_200, {"offset": (-9, 9), "slope": (-9, 9)}, ["x"], TIMES_200
)
SWING = PythonModel(
    lambda cosine, sine: cosine * np.cos(2 * np.pi * TIMES_200) + sine * np.sin(2 * np.pi * TIMES_200),
    {"cosine": (-9, 9), "sine": (-9, 9)},
    ["x"],
    TIMES_200,
)


def under_correlated_noise(model, repetitions, *, known):
    """Coverage of intervals, and mean deviation over the scatter of the estimates, both (parameters,)."""
    truth = np.array([1.0, 0.5])
    exact = model.evaluate(truth[None]).only()[0, :, 0]
    values, deviations, hits = [], [], np.zeros(2)
    for noise in autoregressive(7, 200, 0.6, repetitions):
        data = Measurements.of(TIMES_200, {"x": exact + NOISE * noise}, NOISE if known else None)
        fit = identify(model, data, starts=1, horizon=None, start=truth)
        values.append(fit.values)
        deviations.append(fit.deviations)
        hits += [lower <= value <= upper for value, (lower, upper) in zip(truth, fit.intervals().values(), strict=True)]
    return hits / repetitions, np.mean(deviations, axis=0) / np.std(values, axis=0)


@pytest.mark.slow
@pytest.mark.parametrize("known", [True, False], ids=["given-noise", "estimated-noise"])
@pytest.mark.parametrize(("name", "model"), [("a straight line", DRIFT), ("an oscillation", SWING)])
def test_intervals_under_correlated_noise(record_evidence, name, model, known):
    coverage, ratio = under_correlated_noise(model, 400, known=known)
    source = "the definition of a confidence interval, 400 repetitions, 200 samples, AR(1) noise with φ = 0.6"
    noise = "given" if known else "estimated"
    for parameter, share, relative in zip(model.parameters.names, coverage, ratio, strict=True):
        words = f"{parameter} of {name}, noise {noise}"
        record_evidence(
            f"coverage under correlated noise, {words}",
            LEVEL,
            share,
            tolerance=0.03,
            topic=TOPIC,
            kind="known truth",
            source=source,
        )
        record_evidence(
            f"mean deviation over scatter under correlated noise, {words}",
            1.0,
            relative,
            tolerance=0.1,
            topic=TOPIC,
            kind="known truth",
            source=source,
        )


@pytest.mark.parametrize("model", [DRIFT, SWING], ids=["slow", "oscillating"])
@pytest.mark.slow
def test_intervals_under_correlated_noise_in_fewer_repetitions(model):
    """Without the correction the coverage is 0.67 and 0.75, the ratio 0.5 and 0.6."""
    coverage, ratio = under_correlated_noise(model, 100, known=True)
    assert np.all(coverage >= 0.88)
    np.testing.assert_allclose(ratio, 1, atol=0.2)


def test_intervals_of_short_records_with_correlated_noise(record_evidence):
    """The repetitions of ``python tests/correlated_coverage.py 1000``: at least 90 % of 95 % intervals."""
    table = json.loads(TABLE.read_text(encoding="utf-8"))
    assert table["seeds"] == 1000
    assert [(row["samples"], row["lag1"]) for row in table["cases"]] == CASES
    for row in table["cases"]:
        record_evidence(
            f"coverage of 95 % intervals of a line, offset and slope, {row['samples']} samples, AR(1) noise with lag-1 "
            f"{row['lag1']:g}, not stated",
            np.full(2, LEVEL),
            np.array([row["offset"], row["slope"]]) / 100,
            tolerance=0.05,
            topic=TOPIC,
            kind="known truth",
            source="the definition of a confidence interval, 1,000 repetitions",
        )


def test_profile_likelihood_of_a_linear_case(record_evidence):
    noisy = LINE.evaluate(np.array([[1.0, 0.5]])).only()[0] + NOISE * np.random.default_rng(0).standard_normal((21, 1))
    data = Measurements.of(TIMES, {"x": noisy[:, 0]}, deviations=NOISE)
    found = profile(LINE, data, identify(LINE, data), level=LEVEL).intervals
    slopes = np.stack([np.ones(21), TIMES], axis=1)
    covariance = NOISE**2 * np.linalg.inv(slopes.T @ slopes)
    middle = covariance @ slopes.T @ noisy[:, 0] / NOISE**2
    radius = np.sqrt(chi2.ppf(LEVEL, 1) * np.diag(covariance))
    record_evidence(
        "ends of the 95 % profile likelihood intervals of a straight line",
        np.stack([middle - radius, middle + radius], axis=1),
        np.array(list(found.values())),
        tolerance=1e-7,
        topic=TOPIC,
        kind="closed form",
        source="estimate ∓ quantile × deviation",
        noisy=True,
    )


def test_intervals_of_a_beam_in_space(record_evidence):
    """Of 400 seeds 368 to 391 intervals contain the truth with a probability of 98.5 %; the first ones are repeated."""
    table = json.loads(beam_coverage.TABLE.read_text(encoding="utf-8"))
    assert (table["seeds"], table["first"]) == (beam_coverage.SEEDS, beam_coverage.FIRST)
    for name, count in table["contained"].items():
        record_evidence(
            f"coverage of 95 % intervals of a short beam from the motion of its tip, {name}", LEVEL,
            count / table["seeds"], tolerance=0.03, topic=TOPIC, kind="known truth",
            source="the definition of a confidence interval, 400 seeds",
        )  # fmt: skip
        assert 368 <= count <= 391
    first = [beam_coverage.contains(seed) for seed in range(beam_coverage.FIRST, beam_coverage.FIRST + 10)]
    assert np.array(first).sum(axis=0).tolist() == table["in the first ten"]
