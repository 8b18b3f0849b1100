"""One experiment's share of a fit to several."""

from dataclasses import dataclass

import numpy as np

from dalembert.data import Measurements
from dalembert.inverse.experiments.experiments import Part


@dataclass(frozen=True, eq=False)
class ExperimentFit:
    """An experiment beside the response that is fitted to it, or predicted.

    Parameters
    ----------
    name : str
    data : Measurements
    response, weights : array, shape (samples, channels)
        ``weights`` are 0 where a value was not fitted.
    """

    name: str
    data: Measurements
    response: np.ndarray
    weights: np.ndarray

    @property
    def residuals(self) -> np.ndarray:
        """Response − data, shape (samples, channels)."""
        return self.data.difference(self.response)

    @property
    def fitted(self) -> bool:
        """Whether any of its values was fitted."""
        return bool(np.any(self.weights > 0))


def experiment_fit(part: Part, data: Measurements, response: np.ndarray, weights: np.ndarray) -> ExperimentFit:
    """The share of a part in joint data, response and weights (samples, channels)."""
    return ExperimentFit(part.name, part.data(data), response[part.block], weights[part.block])
