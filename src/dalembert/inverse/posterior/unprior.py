"""A model without the priors of its parameters: for data of unknown noise, which a fit cannot weigh against them."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from dalembert.forward import ForwardModel
from dalembert.forward.wrapped import Wrapped
from dalembert.inverse.experiments.experiment import Experiment
from dalembert.parameters import Parameters


@dataclass(frozen=True)
class WithoutPriors(Wrapped):
    """A model whose parameters have no priors.

    Parameters
    ----------
    known : Parameters
        Those of the model, without priors.
    """

    known: Parameters

    @property
    def parameters(self) -> Parameters:
        return self.known

    @classmethod
    def of(cls, model: ForwardModel) -> "WithoutPriors":
        own = model.parameters
        bare = tuple(replace(item, prior=None, deviation=None) for item in own.items)
        return cls(model, Parameters(bare, own.fixed))


def without_priors(model: ForwardModel | Sequence[Experiment]) -> ForwardModel | Sequence[Experiment]:
    """Return a model, or experiments, whose parameters have no priors."""
    if isinstance(model, Sequence):
        return [replace(item, model=WithoutPriors.of(item.model)) for item in model]
    return WithoutPriors.of(model)
