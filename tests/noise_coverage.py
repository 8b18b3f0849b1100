"""How often 95 % intervals contain the truth, where the noise is estimated with the parameters."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

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


def sampled(case: Case, data: da.Measurements, seed: int) -> Intervals:
    """Intervals of the posterior with uniform priors between the bounds."""
    settings: dict[str, Any] = {"sampler": da.NUTS(), "chains": 1, "draws": 400, "warmup": 150}
    return da.sample(DECAY, data, noise=case.model, start=TRUTH, seed=seed, **settings).intervals(LEVEL)


def contains(
    case: Case, seed: int, methods: Mapping[str, Callable] = METHODS, *, posterior: bool = False
) -> dict[tuple[str, str], bool]:
    """Whether the interval of each method and parameter contains the truth, for the noise of a seed."""
    data = da.Measurements.of(TIMES, {"x": EXACT + case.noise(seed)})
    fit = da.identify(DECAY, data, noise=case.model, starts=1, horizon=None, start=TRUTH)
    found = {method: intervals(data, fit) for method, intervals in methods.items()}
    if posterior:
        found["posterior"] = sampled(case, data, seed)
    return {
        (method, name): intervals[name][0] <= TRUTH[name] <= intervals[name][1]
        for method, intervals in found.items()
        for name in TRUTH
    }


def covered(case: Case, seeds: range, methods: Mapping[str, Callable] = METHODS) -> dict[tuple[str, str], float]:
    """Return the share of seeds in which the interval of each method and parameter contains the truth."""
    found = [contains(case, seed, methods) for seed in seeds]
    return {key: float(np.mean([one[key] for one in found])) for key in found[0]}
