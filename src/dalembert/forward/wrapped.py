"""What models around another model have in common: they answer for it in all that they do not change."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from time import perf_counter
from typing import Self

import numpy as np

from dalembert.findings import Finding
from dalembert.forward.adjoint import ADJOINT, Pull, pullback
from dalembert.forward.complex_steps import check_derivatives
from dalembert.forward.model import Channel, Coordinate, ForwardModel
from dalembert.forward.refinement import Refinement, refined
from dalembert.forward.responses import Responses
from dalembert.parameters import Parameters


@dataclass(frozen=True)
class Wrapped:
    """A forward model that hands everything on to another one."""

    model: ForwardModel

    @property
    def parameters(self) -> Parameters:
        return self.model.parameters

    @property
    def channels(self) -> tuple[Channel, ...]:
        return self.model.channels

    @property
    def scaled(self) -> frozenset[str]:
        """Channels with a gain, whose readings may be in another unit than the channel."""
        return getattr(self.model, "scaled", frozenset())

    @property
    def coordinate(self) -> Coordinate:
        return self.model.coordinate

    @property
    def fingerprint(self) -> str:
        return self.model.fingerprint

    @property
    def spared(self) -> float:
        """Seconds of computing that earlier processes did, and this one need not."""
        return self.model.spared if isinstance(self.model, Wrapped) else 0.0

    def evaluate(self, vectors: np.ndarray) -> Responses:
        """Responses of a batch; ``vectors`` (batch, parameters), values (batch, samples, channels)."""
        return self.model.evaluate(vectors)

    def jacobian(self, vector: np.ndarray) -> np.ndarray:
        """Derivative of the response, (samples, channels, parameters)."""
        return self.model.jacobian(vector)

    def linearise(self, vector: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Response (samples, channels) and its jacobian (samples, channels, parameters)."""
        return self.model.linearise(vector)

    @property
    def adjoint_from(self) -> int | None:
        """Number of parameters from which the adjoint is cheaper than the Jacobian; None without an adjoint."""
        return getattr(self.model, "adjoint_from", None)

    def pullback(self, vector: np.ndarray) -> tuple[np.ndarray, Pull]:
        """Response (samples, channels), and the gradients of its weighted sums by the model's adjoint."""
        return pullback(self.model, vector, ADJOINT)

    def check_derivatives(self, vector: np.ndarray) -> None:
        """Compare the complex step of the model with differences at a vector (parameters,)."""
        check_derivatives(self.model, vector)

    def findings(self, vector: np.ndarray) -> tuple[Finding, ...]:
        """Findings on the other model at a parameter vector (parameters,)."""
        return findings_at(self.model, vector)

    def starting(self, values: Mapping[str, float]) -> Self:
        """The same around the model first built at these values of its parameters."""
        return replace(self, model=starting(self.model, values))

    def first(self, samples: int) -> Self:
        """The same around the model cut to its first ``samples`` samples."""
        return replace(self, model=self.model.first(samples))

    def refined(self) -> Refinement | None:
        """Return the same around a more exact model, or None."""
        finer = refined(self.model)
        return None if finer is None else replace(finer, model=replace(self, model=finer.model))


def starting(model: ForwardModel, values: Mapping[str, float]) -> ForwardModel:
    """The model first built at these values of its parameters, by name; as it is where it does not matter to it."""
    offered = getattr(model, "starting", None)
    return model if offered is None else offered(values)


def findings_at(model: ForwardModel, vector: np.ndarray) -> tuple[Finding, ...]:
    """Findings on a model at a parameter vector (parameters,); none if it offers none."""
    offered = getattr(model, "findings", None)
    return () if offered is None else tuple(offered(vector))


def clock(model: ForwardModel) -> float:
    """Seconds on a clock that also counts what a run computed before it was killed and resumed."""
    return perf_counter() + (model.spared if isinstance(model, Wrapped) else 0.0)
