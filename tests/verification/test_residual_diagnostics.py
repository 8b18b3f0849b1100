"""Influence of samples and tests of residuals against closed forms, refits and statsmodels."""

import numpy as np
import pytest

from dalembert.data import Measurements
from dalembert.forward import PythonModel
from dalembert.inverse import identify
from dalembert.inverse.diagnostics.noise_tests import normality, runs
from stack_loss import STACK

TOPIC = "Residual diagnostics"
STATSMODELS = "statsmodels 0.15: OLSInfluence of Brownlee's stack loss data"


@pytest.fixture(scope="module")
def series():
    columns = np.column_stack([np.ones(21), STACK[:, :3]])
    names = ("one", "air", "water", "acid")
    model = PythonModel(
        lambda **values: columns @ np.array([values[name] for name in names]),
        {"one": (-100.0, 100.0), "air": (-5.0, 5.0), "water": (-5.0, 5.0), "acid": (-5.0, 5.0)},
        ["loss"],
        np.arange(21.0),
    )
    fit = identify(model, Measurements.of(np.arange(21.0), {"loss": STACK[:, 3]}), starts=1, horizon=None)
    return fit.diagnostics().series[0]


def test_influence_of_the_samples_of_a_published_regression(series, record_evidence):
    picked = [0, 3, 16, 20]
    for quantity, reference, ours in (
        ("leverages", [0.3015554689, 0.1285052431, 0.4121234979, 0.2845334627], series.leverage[picked]),
        ("Cook's distances", [0.1537103724, 0.1305420418, 0.0654730784, 0.6919999163], series.distance[picked]),
        (
            "externally studentised residuals",
            [1.2094746739, 2.0517974811, -0.5995857905, -3.3304933193],
            -series.deleted[picked],
        ),
        ("DFBETAS of day 21", [0.401595435, -1.6238263052, 1.6419272744, -0.3633169797], series.changes[20]),
    ):
        record_evidence(
            f"stack loss, days 1, 4, 17 and 21: {quantity}" if "day" not in quantity else f"stack loss: {quantity}",
            reference, ours, tolerance=1e-6, topic=TOPIC, kind="other code", source=STATSMODELS,
        )  # fmt: skip


def test_leverages_of_a_line_are_those_of_the_closed_form(record_evidence):
    times = np.array([0.0, 0.5, 1.0, 2.0, 3.5, 4.0, 4.5, 7.0, 7.5, 9.0, 9.5, 12.0])
    model = PythonModel(lambda a, b: a + b * times, {"a": (-5.0, 5.0), "b": (-5.0, 5.0)}, ["x"], times)
    noise = 0.1 * np.random.default_rng(0).standard_normal(12)
    fit = identify(model, Measurements.of(times, {"x": 1 - times / 3 + noise}), starts=1, horizon=None)
    centred = times - np.mean(times)
    record_evidence(
        "straight line: leverages 1/n + (t − t̄)²/Σ(t − t̄)²", 1 / 12 + centred**2 / np.sum(centred**2),
        fit.diagnostics().series[0].leverage, tolerance=1e-12, topic=TOPIC, kind="closed form",
        source="hat matrix of a straight line", noisy=True,
    )  # fmt: skip


def test_tests_of_noise_equal_those_of_statsmodels(record_evidence):
    noise = np.random.default_rng(7).standard_normal(60)
    for what, values, reference in (("noise", noise, 0.8248716704843174), ("exp(noise)", np.exp(noise), 7.6488190e-12)):
        record_evidence(
            f"Anderson–Darling test of 60 values, {what}: probability", reference, normality(values), tolerance=1e-8,
            relative=True, topic=TOPIC, kind="other code", source="statsmodels 0.15: normal_ad",
        )  # fmt: skip
    record_evidence(
        "runs of signs of 60 values: probability", 0.901501090238586, runs(noise)[2], tolerance=1e-12, topic=TOPIC,
        kind="other code", source="statsmodels 0.15: runstest_1samp without correction",
    )  # fmt: skip
