"""Whether a model answers the same to the same parameters."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from dalembert.findings import Finding
from dalembert.forward import ForwardModel, Recorded
from dalembert.inverse.experiments.experiments import JointModel
from dalembert.inverse.identification.assess import Optimum

SAME = 1e-9
"""Difference of two responses, as a part of their largest value, up to which they are the same but for rounding."""


def non_deterministic_model(optimum: Optimum) -> Iterator[Finding]:
    """Simulate the identified values again and yield a finding if the response differs. Checkpoints are left out,
    because they repeat what they hold. The response may come from a simulation with sensitivities, whose rounding
    chaotic motion amplifies: if the two differ, a third run is compared with the second.
    """
    if optimum.end.nodes is not None:
        return
    fresh = replace(optimum.problem, model=computed(optimum.problem.model))
    again = fresh.responses(optimum.vector[None])[0]
    if np.max(np.abs(again - optimum.response)) <= SAME * np.max(np.abs(optimum.response)):
        return
    apart = float(np.max(np.abs(fresh.responses(optimum.vector[None])[0] - again)))
    if apart > 0:
        message = f"The model is not deterministic: at the same parameters its responses differ by up to {apart:.3g}."
        advice = "Fix the seed of random numbers, and leave no state from one call to the next."
        yield Finding("non-deterministic-model", "error", {"difference": apart}, message, advice)


def computed(model: ForwardModel) -> ForwardModel:
    """The model without its checkpoints."""
    if isinstance(model, JointModel):
        return replace(model, models=tuple(map(computed, model.models)))
    return computed(model.model) if isinstance(model, Recorded) else model
