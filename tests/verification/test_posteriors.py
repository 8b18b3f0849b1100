"""Posteriors against closed forms, by every sampler, and whether they are calibrated."""

import json
from pathlib import Path

import numpy as np
import pytest

import dalembert as da
from dalembert.inverse import NUTS, AffineInvariant, DelayedAcceptance, sample
from dalembert.priors import CorrelatedNormal
from dalembert.study import load
from dalembert.surrogate import TotalDegree
from posterior_calibration import DRAWS, TABLE, probability
from posterior_models import closed_form, line, measured

STUDIES = Path(__file__).parents[2] / "studies"
TOPIC = "Posterior distributions"
CALIBRATION = json.loads(TABLE.read_text(encoding="utf-8"))
JOINT = CorrelatedNormal(("a", "b"), (1.0, 0.5), ((0.01, -0.003), (-0.003, 0.04)))
SAMPLERS = {
    "No-U-Turn": NUTS(),
    "affine-invariant": AffineInvariant(thin=3),
    "delayed acceptance": DelayedAcceptance(TotalDegree(2)),
}


@pytest.mark.parametrize("name", SAMPLERS)
def test_a_linear_model_with_normal_noise_and_prior(record_evidence, name):
    data = measured()
    mean, covariance = closed_form(data, np.array(JOINT.mean), np.array(JOINT.covariance))
    found = sample(
        line(a=JOINT, b=JOINT), data, sampler=SAMPLERS[name], start=[1.0, 0.5], chains=4, draws=300, warmup=150, seed=1
    )
    deviations = np.sqrt(np.diag(covariance))
    effective = float(np.min(np.minimum(found.bulk, found.tail)))
    spread = (found.flat - mean) @ np.linalg.inv(np.linalg.cholesky(covariance)).T
    assert effective > 700
    source = "normal posterior of a linear model; tolerance: four standard errors of 700 independent draws"
    record_evidence(
        f"posterior means of a straight line by the {name} sampler, in posterior deviations", np.zeros(2),
        (found.mean - mean) / deviations, tolerance=0.15, topic=TOPIC, kind="closed form",
        source=source, noisy=True,
    )  # fmt: skip
    record_evidence(
        f"posterior covariance of a straight line by the {name} sampler, whitened", np.eye(2), np.cov(spread.T),
        tolerance=0.21, topic=TOPIC, kind="closed form", source=source, noisy=True,
    )  # fmt: skip


@pytest.mark.slow
def test_samplers_agree_on_the_flexible_pendulum(record_evidence):
    """The moduli of two flexible bars from the motion of joint and tip: by gradients, and without."""
    study = load(STUDIES / "flexible-pendulum-moduli" / "identify.toml")
    channels, times = ["OA.end.x", "OA.end.y", "AB.end.x", "AB.end.y"], np.linspace(0.0, 0.5, 26)
    solver = da.GeneralizedAlpha(step=2e-3, spectral_radius=0.8)
    model = da.TimeResponse(study.builder, study.parameters, channels, times, solver=solver)
    truth = np.array([2e8, 2e7, 5e-3])
    exact = model.evaluate(truth[None]).only()[0]
    noisy = exact + 2e-3 * np.random.default_rng(5).standard_normal(exact.shape)
    data = da.Measurements.of(times, dict(zip(channels, noisy.T, strict=True)), deviations=2e-3)
    settings = {"start": truth, "seed": 1}
    by_gradients = sample(model, data, chains=4, draws=150, warmup=100, **settings)
    without = sample(model, data, sampler=AffineInvariant(walkers=12, thin=3), draws=150, warmup=50, **settings)
    errors = np.hypot(by_gradients.errors, without.errors)
    source = "emcee; tolerance: four standard errors of the difference of both means"
    record_evidence(
        "posterior means of two moduli and a damping, No-U-Turn and affine-invariant, in errors of their difference",
        np.zeros(3), (by_gradients.mean - without.mean) / errors, tolerance=4.0, topic=TOPIC, kind="other method",
        source=source, noisy=True,
    )  # fmt: skip
    assert min(np.min(by_gradients.bulk), np.min(without.bulk)) > 200
    record_evidence(
        "posterior standard deviations of the same, relative", np.ones(3), by_gradients.deviations / without.deviations,
        tolerance=0.3, topic=TOPIC, kind="other method", source=source, noisy=True,
    )  # fmt: skip


@pytest.mark.parametrize("name", ["decay", "pendulum"])
def test_ranks_of_truths_from_the_prior_are_uniform(record_evidence, name):
    """Simulation-based calibration, whose ranks ``python tests/posterior_calibration.py`` writes."""
    row = CALIBRATION[f"ranks {name}"]
    assert row["repetitions"] >= 200
    assert min(probability(row["ranks"])) > 0.01
    ranks = (np.sort(np.array(row["ranks"]), axis=0) + 0.5) / (DRAWS + 1)
    expected = (np.arange(len(ranks)) + 0.5) / len(ranks)
    record_evidence(
        f"simulation-based calibration of a {name}: largest distance of the ranks' distribution from the uniform one",
        np.zeros(ranks.shape[1]), np.max(np.abs(ranks - expected[:, None]), axis=0),
        tolerance=1.63 / np.sqrt(len(ranks)), topic=TOPIC, kind="known truth",
        source=f"S. Talts et al. 2018, {len(ranks)} repetitions; tolerance: 1 % of the Kolmogorov–Smirnov test",
    )  # fmt: skip


def test_posterior_intervals_of_a_mechanism_contain_the_truth(record_evidence):
    """The repetitions of ``python tests/posterior_calibration.py coverage pendulum 400``."""
    row = CALIBRATION["coverage pendulum"]
    record_evidence(
        "coverage of 95 % posterior intervals, length and drag of a pendulum", np.full(2, 0.95), row["share"],
        tolerance=0.03, topic=TOPIC, kind="known truth",
        source=f"the definition of an interval, {row['repetitions']} repetitions",
    )  # fmt: skip
