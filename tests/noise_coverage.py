"""How often 95 % intervals contain the truth, where the noise is estimated with the parameters."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

import dalembert as da
from correlated_noise import autoregressive

LEVEL = 0.95
TIMES = np.linspace(0.0, 3.0, 61)
TRUTH = {"height": 2.0, "rate": 0.8}
DECAY = da.PythonModel(
    lambda height, rate: height * np.exp(-rate * TIMES), {"height": (0.2, 8.0), "rate": (0.05, 4.0)}, ["x"], TIMES
)
EXACT = TRUTH["height"] * np.exp(-TRUTH["rate"] * TIMES)


@dataclass(frozen=True)
class Case:
    """Noise of a seed (samples,), and the noise model that describes it."""

    name: str
    noise: Callable[[int], np.ndarray]
    model: da.NoiseModel


def normal(seed: int) -> np.ndarray:
    return np.random.default_rng(seed).standard_normal(len(TIMES))


CASES = (
    Case("independent", lambda seed: 0.1 * normal(seed), da.ConstantNoise()),
    Case("proportional", lambda seed: 0.1 * EXACT * normal(seed), da.ProportionalNoise()),
    Case("AR(1), 0.6", lambda seed: 0.1 * autoregressive(seed, len(TIMES), 0.6), da.AutoregressiveNoise(order=1)),
)

Intervals = Mapping[str, tuple[float, float]]


def linear(data: da.Measurements, fit: da.Fit) -> Intervals:
    """Intervals from standard deviations."""
    return fit.intervals(LEVEL)


def profiled(data: da.Measurements, fit: da.Fit) -> Intervals:
    """Intervals from profile likelihoods."""
    return da.profile(DECAY, data, fit, level=LEVEL).intervals


METHODS: dict[str, Callable[[da.Measurements, da.Fit], Intervals]] = {"deviations": linear, "profiles": profiled}
"""Ways to intervals by name; another one is one more function."""


def covered(case: Case, seeds: range, methods: Mapping[str, Callable] = METHODS) -> dict[tuple[str, str], float]:
    """Return the share of seeds in which the interval of each method and parameter contains the truth."""
    hits = {(method, name): 0 for method in methods for name in TRUTH}
    for seed in seeds:
        data = da.Measurements.of(TIMES, {"x": EXACT + case.noise(seed)})
        fit = da.identify(DECAY, data, noise=case.model, starts=1, horizon=None, start=TRUTH)
        for method, intervals in methods.items():
            for name, (lower, upper) in intervals(data, fit).items():
                hits[method, name] += lower <= TRUTH[name] <= upper
    return {key: count / len(seeds) for key, count in hits.items()}
