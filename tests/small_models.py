"""Small models that the tests of identification share."""

import numpy as np

from dalembert.data import Bands, Measurements
from dalembert.forward import PythonModel

TIMES = np.linspace(0, 4, 41)


def line(offset, slope):
    """Linear in its parameters, in two channels."""
    return np.stack([offset + slope * TIMES, slope * TIMES**2 - offset], axis=1)


def decay(size, rate):
    return size * np.exp(-rate * TIMES)


LINE = PythonModel(line, {"offset": (-5.0, 5.0), "slope": (-5.0, 5.0)}, ["x", "y"], TIMES)
DECAY = PythonModel(decay, {"size": (0.5, 4.0), "rate": (0.1, 3.0)}, ["x"], TIMES)


def measured(model, values, noise=0.0, seed=0, deviations=None):
    """Measurements of a model's own response, with noise."""
    exact = model.evaluate(np.array([values])).only()[0]
    noisy = exact + noise * np.random.default_rng(seed).standard_normal(exact.shape)
    names = [channel.name for channel in model.channels]
    return Measurements.of(model.coordinate, dict(zip(names, noisy.T, strict=True)), deviations)


def banded(model, lower, upper, points=201):
    """Bands of a model's own response over a box of parameters that it is monotonic in, or scanned."""
    axes = [np.linspace(low, high, points if high > low else 1) for low, high in zip(lower, upper, strict=True)]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(axes))
    values = model.evaluate(grid).only()
    names = [channel.name for channel in model.channels]
    low, high = values.min(axis=0), values.max(axis=0)
    return Bands.of(model.coordinate, {name: (low[:, k], high[:, k]) for k, name in enumerate(names)})
