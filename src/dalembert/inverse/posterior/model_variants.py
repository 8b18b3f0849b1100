"""Variants of a model for sampling: without priors, and with a memory of its responses."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from dalembert.forward import ForwardModel
from dalembert.forward.responses import Responses
from dalembert.forward.wrapped import Wrapped
from dalembert.inverse.experiments.experiment import Experiment
from dalembert.parameters import Parameters


@dataclass(frozen=True)
class WithoutPriors(Wrapped):
    """A model whose parameters have no priors: for data of unknown noise, which a fit cannot weigh against them."""

    plain_parameters: Parameters

    @property
    def parameters(self) -> Parameters:
        return self.plain_parameters

    @classmethod
    def of(cls, model: ForwardModel) -> "WithoutPriors":
        parameters = model.parameters
        plain = tuple(replace(item, prior=None, deviation=None) for item in parameters.items)
        return cls(model, Parameters(plain, parameters.fixed))


def without_priors(model: ForwardModel | Sequence[Experiment]) -> ForwardModel | Sequence[Experiment]:
    """Return a model, or experiments, whose parameters have no priors."""
    if isinstance(model, Sequence):
        return [replace(item, model=WithoutPriors.of(item.model)) for item in model]
    return WithoutPriors.of(model)


@dataclass(frozen=True)
class Remembered(Wrapped):
    """A forward model that simulates no vector twice while one method runs."""

    known: dict[bytes, tuple[np.ndarray, str | None]] = field(default_factory=dict, repr=False, compare=False)

    @property
    def simulations(self) -> int:
        """Number of vectors that were simulated."""
        return len(self.known)

    def evaluate(self, vectors: np.ndarray) -> Responses:
        """Responses of a batch; ``vectors`` (batch, parameters), values (batch, samples, channels)."""
        vectors = np.atleast_2d(np.asarray(vectors, dtype=float))
        keys = [vector.tobytes() for vector in vectors]
        missing = {key: row for row, key in enumerate(keys) if key not in self.known}
        if missing:
            responses = self.model.evaluate(vectors[list(missing.values())])
            self.known.update(zip(missing, zip(responses.values, responses.failures, strict=True), strict=True))
        values, failures = zip(*(self.known[key] for key in keys), strict=True) if keys else ((), ())
        shape = len(self.coordinate.values), len(self.channels)
        return Responses(np.array(values).reshape(-1, *shape), tuple(failures))
