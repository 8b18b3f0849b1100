"""A model with its data, or several experiments, as one model and one set of measurements."""

from collections.abc import Mapping, Sequence

from numpy.typing import ArrayLike

from dalembert.data import Measurements
from dalembert.errors import InputError
from dalembert.forward import ForwardModel
from dalembert.inverse.experiments.experiment import Experiment, ExperimentPart
from dalembert.inverse.experiments.experiments import joint, joint_weights
from dalembert.inverse.problem.matching import check_kinds


def joined(
    owner: str,
    model: ForwardModel | Sequence[Experiment],
    data: Measurements | None,
    weights: ArrayLike | Mapping[str, ArrayLike] | None,
) -> tuple[ForwardModel, Measurements, ArrayLike | None, tuple[ExperimentPart, ...]]:
    """Model, data and weights, with several experiments the joint ones, and where each experiment stands in them."""
    if isinstance(model, Sequence):
        if data is not None:
            raise InputError(f"{owner}: experiments have their own data; leave out the second argument")
        together, measured = joint(model)
        together.parameters.check_some(owner)
        return together, measured, joint_weights(together, weights), together.parts  # pyright: ignore[reportArgumentType]
    if data is None:
        raise InputError(f"{owner}: no data were given; expected {owner}(model, data), or {owner}([Experiment(...)])")
    if isinstance(weights, Mapping):
        raise InputError("weights by name are for several experiments; expected an array (channels,)")
    check_kinds(owner, model, data)
    return model, data, weights, ()
