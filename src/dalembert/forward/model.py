"""The narrow waist: what every model offers and every method asks for."""

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from dalembert.forward.responses import Responses
from dalembert.parameters import Parameters


@dataclass(frozen=True)
class Channel:
    """One output of a model, for example the x coordinate of a point."""

    name: str
    unit: str = ""


@dataclass(frozen=True)
class Coordinate:
    """What the samples of a response lie along: time, or frequency.

    Parameters
    ----------
    name, unit : str
    values : array, shape (samples,)
    """

    name: str
    unit: str
    values: np.ndarray


@runtime_checkable
class ForwardModel(Protocol):
    """A map from named parameters to a labelled response of shape (samples, channels)."""

    @property
    def parameters(self) -> Parameters: ...

    @property
    def channels(self) -> tuple[Channel, ...]: ...

    @property
    def coordinate(self) -> Coordinate: ...

    @property
    def fingerprint(self) -> str:
        """Hash of all that determines the response but the parameters' values."""
        ...

    def evaluate(self, vectors: np.ndarray) -> Responses:
        """Responses of a batch; ``vectors`` of shape (batch, parameters), values (batch, samples, channels).

        A sample that fails is marked with its reason; the others return.
        """
        ...

    def jacobian(self, vector: np.ndarray) -> np.ndarray:
        """Derivative of the response, shape (samples, channels, parameters)."""
        ...

    def linearise(self, vector: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Response (samples, channels) and its jacobian, together for less than the price of both."""
        ...

    def first(self, samples: int) -> "ForwardModel":
        """The same model, cut to its first ``samples`` samples."""
        ...
