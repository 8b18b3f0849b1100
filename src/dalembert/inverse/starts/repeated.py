"""Whether a model answers the same to the same parameters."""

from dataclasses import replace

import numpy as np

from dalembert.findings import Finding
from dalembert.forward import ForwardModel, Recorded
from dalembert.inverse.experiments.experiments import JointModel
from dalembert.inverse.problem.problem import MisfitProblem

SAME = 1e-9
"""Difference of two responses, as a part of their largest value, up to which they are the same but for rounding."""


def repeated(problem: MisfitProblem, vector: np.ndarray, response: np.ndarray) -> tuple[Finding, ...]:
    """Simulate a vector (parameters,) again and compare with its response (samples, channels).

    Checkpoints are left out, because they repeat what they hold. The response may come from a simulation with
    sensitivities, whose rounding chaotic motion amplifies: if the two differ, a third run is compared with the second.
    """
    fresh = replace(problem, model=computed(problem.model))
    again = fresh.responses(vector[None])[0]
    size = np.max(np.abs(response))
    if np.max(np.abs(again - response)) <= SAME * size:
        return ()
    apart = float(np.max(np.abs(fresh.responses(vector[None])[0] - again)))
    if apart == 0:
        return ()
    message = f"The model is not deterministic: at the same parameters its responses differ by up to {apart:.3g}."
    advice = "Fix the seed of random numbers, and leave no state from one call to the next."
    return (Finding("non-deterministic-model", "error", {"difference": apart}, message, advice),)


def computed(model: ForwardModel) -> ForwardModel:
    """The model without its checkpoints."""
    if isinstance(model, JointModel):
        return replace(model, models=tuple(map(computed, model.models)))
    return computed(model.model) if isinstance(model, Recorded) else model
