"""A free oscillator as a fast model, and records of it, with noise, that it explains and does not explain."""

import numpy as np

from correlated_noise import autoregressive
from dalembert.data import Measurements
from dalembert.forward import PythonModel

TIMES = np.linspace(0, 8, 321)
TRUTH = (30.0, 0.2, 0.3)
NOISE = 0.002
BOX = {"stiffness": (20.0, 40.0), "damping": (0.01, 1.0), "start": (0.05, 0.5)}


def oscillation(times, stiffness, damping, start):
    """Displacement of a damped oscillator of mass 1 that starts at rest."""
    frequency = np.sqrt(stiffness - damping**2 / 4)
    swing = np.cos(frequency * times) + damping / 2 / frequency * np.sin(frequency * times)
    return start * np.exp(-damping / 2 * times) * swing


def oscillator(times=TIMES):
    return PythonModel(lambda **values: oscillation(times, **values), BOX, ["x"], times)


def rubbing(times, stiffness, damping, start, friction):
    """The same with dry friction, in steps of a tenth of a sample."""
    x, v, found, step = start, 0.0, [start], (times[1] - times[0]) / 10
    for _ in range(10 * (len(times) - 1)):
        v += step * (-stiffness * x - damping * v - friction * np.tanh(v / 1e-3) / (1 + step * friction / 1e-3))
        x += step * v
        found.append(x)
    return np.array(found[::10])


def recorded(exact, seed=0, correlation=0.0, deviations=None, times=TIMES, noise=NOISE):
    """Measurements of an exact motion with white noise, or autoregressive noise of the first order."""
    return Measurements.of(times, {"x": exact + noise * autoregressive(seed, len(times), correlation)}, deviations)
