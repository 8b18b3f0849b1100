"""Runs of a model, counted, with the reasons of those that fail."""

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from dalembert.errors import InputError, SolveError, StorageError, told
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
    if journal.first is None and len(vectors):
        journal.computed(vectors[0], values[0])
    return values


@contextmanager
def failing_at(model: ForwardModel, journal: Journal, vector: np.ndarray) -> Iterator[None]:
    """Keep the failure of a simulation at a parameter vector (parameters,) in the journal."""
    try:
        yield
    except (InputError, StorageError):  # no other vector will do better
        raise
    except Exception as error:  # whatever a user's function raises is this vector's failure
        journal.failures.append(f"{told(error)} (at {named(model, vector)})")
        raise SolveError(told(error)) from error


def named(model: ForwardModel, vector: np.ndarray) -> str:
    """A parameter vector as text, for example ``"mass = 2, stiffness = 300"``."""
    return ", ".join(f"{name} = {value:.6g}" for name, value in model.parameters.mapping(vector).items())
