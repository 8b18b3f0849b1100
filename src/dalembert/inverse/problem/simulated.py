"""Runs of a model, counted, with the reasons of those that fail."""

import numpy as np

from dalembert.forward import ForwardModel
from dalembert.inverse.problem.journal import Journal


def simulated(model: ForwardModel, columns: np.ndarray, journal: Journal, vectors: np.ndarray) -> np.ndarray:
    """Responses (batch, samples, columns) at parameter vectors (batch, parameters); NaN where a sample failed."""
    responses = model.evaluate(vectors)
    journal.simulations += len(vectors)
    journal.failures.extend(
        f"{reason} (at {named(model, vector)})"
        for vector, reason in zip(vectors, responses.failures, strict=True)
        if reason is not None
    )
    values = responses.values[:, :, columns].astype(float)
    values[~responses.ok] = np.nan
    if len(vectors):
        journal.computed(vectors[0], values[0])
    return values


def named(model: ForwardModel, vector: np.ndarray) -> str:
    """A parameter vector as text, for example ``"mass = 2, stiffness = 300"``."""
    return ", ".join(f"{name} = {value:.6g}" for name, value in model.parameters.mapping(vector).items())
