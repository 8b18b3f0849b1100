"""Small models whose posteriors are known, for tests of sampling."""

import numpy as np

from dalembert.data import Measurements
from dalembert.forward import PythonModel
from dalembert.parameter import Parameter
from dalembert.priors import AnyPrior

TIMES = np.linspace(0.0, 1.0, 11)
DESIGN = np.stack([TIMES, 1 - TIMES], axis=1)
SIGMA = 0.1


def line(bounds: tuple[float, float] = (-5.0, 5.0), **priors: AnyPrior) -> PythonModel:
    """A straight line by its ends: a linear model."""
    box = {name: Parameter(name, *bounds, prior=priors.get(name)) for name in ("a", "b")}
    return PythonModel(lambda a, b: a * TIMES + b * (1 - TIMES), box, ["x"], TIMES)


def measured(seed: int = 1, *, known: bool = True, a: float = 1.2, b: float = 0.3) -> Measurements:
    """Data of the line with noise."""
    noise = SIGMA * np.random.default_rng(seed).standard_normal(len(TIMES))
    return Measurements.of(TIMES, {"x": DESIGN @ [a, b] + noise}, deviations=SIGMA if known else None)


def closed_form(data: Measurements, mean: np.ndarray, covariance: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Mean and covariance of the posterior of the line with a normal prior."""
    found = np.linalg.inv(DESIGN.T @ DESIGN / SIGMA**2 + np.linalg.inv(covariance))
    return found @ (DESIGN.T @ data.values[:, 0] / SIGMA**2 + np.linalg.solve(covariance, mean)), found


def decay(rate: float, height: float) -> np.ndarray:
    """A nonlinear model of two parameters."""
    return height * np.exp(-rate * TIMES)


DECAY = PythonModel(decay, {"rate": (0.1, 10.0), "height": (0.1, 5.0)}, ["x"], TIMES)
DECAYED = Measurements.of(
    TIMES, {"x": decay(2.0, 1.0) + 0.05 * np.random.default_rng(2).standard_normal(len(TIMES))}, deviations=0.05
)
