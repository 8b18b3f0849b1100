"""Minima that the data cannot distinguish: mentioned wherever starts ended in them, and flat valleys are not minima."""

import numpy as np
import pytest

from dalembert.data import Measurements
from dalembert.forward import PythonModel
from dalembert.inverse import identify
from dalembert.optimize import ParticleSwarm

TIMES = np.linspace(0, 5, 41)
NOISES = (0.0, 1e-3, 0.02, 0.1)
LINE = PythonModel(lambda a: a**2 * TIMES, {"a": (-3.0, 2.0)}, ["x"], TIMES)
MIRRORED = PythonModel(
    lambda place, rate: place**2 * np.cos(rate * TIMES), {"place": (-3.0, 2.5), "rate": (0.5, 4.0)}, ["x"], TIMES
)
PERMUTED = PythonModel(
    lambda a, p, b, q: a * np.exp(-p * TIMES) + b * np.exp(-q * TIMES),
    {"a": (0.1, 5.0), "p": (0.05, 5.0), "b": (0.1, 5.0), "q": (0.05, 5.0)},
    ["x"],
    TIMES,
)
PRODUCT = PythonModel(
    lambda a, b, rate: a * b * np.exp(-rate * TIMES), {"a": (0.1, 5.0), "b": (0.1, 5.0), "rate": (0.1, 3.0)}, ["x"],
    TIMES,
)  # fmt: skip
CIRCLE = PythonModel(
    lambda a, b, rate: (a**2 + b**2) * np.exp(-rate * TIMES),
    {"a": (-2.0, 2.0), "b": (-2.0, 2.0), "rate": (0.1, 3.0)}, ["x"], TIMES,
)  # fmt: skip


def fitted(model, values, seed, **settings):
    noise = NOISES[seed % 4]
    column = model.function(*values) + noise * np.random.default_rng(seed).standard_normal(len(TIMES))
    known = noise or None if seed % 8 >= 4 else None
    return identify(model, Measurements.of(TIMES, {"x": column}, deviations=known), seed=seed, **settings)


def unidentifiable(fit):
    """Return the names of parameters that doubts are about."""
    return {
        name
        for item in fit.doubts
        for key in ("parameter", "parameters")
        for name in item.values.get(key, "").split(", ")
    }


def named(fit):
    return [finding for finding in fit.findings if finding.code == "equal-minima"]


def elsewhere(fit):
    """Whether starts ended apart from the values, by their deviations and 0.1 %, with a misfit equal in the noise."""
    noise = max(fit.misfit / (len(TIMES) - len(fit.values)), 1e-12)
    apart = np.fmax(2 * fit.deviations, 1e-3 * np.abs(fit.values))
    return any(
        start.misfit - fit.misfit < 4 * noise and np.any(np.abs(start.end - fit.values) > apart) for start in fit.starts
    )


@pytest.mark.parametrize(("model", "values"), [(MIRRORED, (1.5, 2.0)), (PERMUTED, (2.0, 0.4, 1.0, 3.0))])
def test_minima_that_starts_ended_in_are_named(model, values):
    fits = [fitted(model, values, seed) for seed in range(40)]
    ended = [fit for fit in fits if elsewhere(fit)]
    assert len(ended) >= 10
    assert all(map(named, ended))


@pytest.mark.slow
@pytest.mark.parametrize("settings", [{"method": "L-BFGS-B", "starts": 4}, {"method": ParticleSwarm(), "starts": 3}])
def test_minima_of_methods_without_sensitivities_are_named(settings):
    fits = [fitted(MIRRORED, (1.5, 2.0), seed, **settings) for seed in range(24)]
    ended = [fit for fit in fits if elsewhere(fit)]
    assert len(ended) >= 3
    assert all(map(named, ended))


@pytest.mark.parametrize(("model", "values"), [(PRODUCT, (2.0, 1.0, 1.0)), (CIRCLE, (1.0, 1.0, 1.0))])
def test_a_flat_valley_is_not_identifiable_and_not_two_minima(model, values):
    fits = [fitted(model, values, seed) for seed in range(1, 40, 2)]
    assert not any(map(named, fits))
    assert all({"a", "b"} <= unidentifiable(fit) for fit in fits)


def test_a_named_minimum_is_the_permuted_one():
    fit = fitted(PERMUTED, (2.0, 0.4, 1.0, 3.0), 2, method="L-BFGS-B", starts=4)
    (finding,) = named(fit)
    other = [finding.values[f"other_1.{name}"] for name in ("a", "p", "b", "q")]
    np.testing.assert_allclose(np.roll(other, 2), fit.values, rtol=1e-4)
    assert finding.values["minima"] == 1
    np.testing.assert_allclose(finding.values["other_1.misfit"], fit.misfit, rtol=1e-6)


def test_two_values_that_explain_one_channel_are_a_doubt_once():
    fit = fitted(LINE, (1.5,), 3)
    assert abs(abs(fit.values[0]) - 1.5) < 0.02
    (finding,) = named(fit)
    np.testing.assert_allclose(finding.values["other_1.a"], -fit.values[0], rtol=1e-3)
    assert fit.doubts.count(finding) == 1
    assert fit.summary().count(finding.message) == 1


def test_one_minimum_has_no_rival():
    swing = PythonModel(lambda rate: np.cos(rate * TIMES), {"rate": (0.5, 8.0)}, ["x"], TIMES)
    fit = fitted(swing, (4.0,), 3)
    np.testing.assert_allclose(fit.values, [4.0], atol=3 * fit.deviations[0])
    assert named(fit) == []
