"""The error of a response that the integrator causes, from a more exact simulation."""

from dataclasses import dataclass

import numpy as np

from dalembert.data.record import TURN
from dalembert.errors import ClusterError, StorageError, told
from dalembert.forward.refinement import Refinement
from dalembert.inverse.problem.problem import Linearisation, MisfitProblem


@dataclass(frozen=True, eq=False)
class IntegrationError:
    """Error (samples, channels) of a response, 0 where a value is missing.

    ``how`` is what the more exact simulation was, such as ``"at half the step"``; why it failed if ``error`` is None.
    """

    how: str
    error: np.ndarray | None


def integration_error(problem: MisfitProblem, at: Linearisation, finer: Refinement) -> IntegrationError:
    """Simulate a vector more exactly, and return the error of its response."""
    problem.journal.simulations += 1
    try:
        responses = finer.model.evaluate(at.vector[None])
    except (StorageError, ClusterError):
        raise
    except Exception as error:  # a model that works at its own steps may fail at finer ones
        return IntegrationError(f"the simulation {finer.how} failed: {told(error)}", None)
    if not responses.ok[0]:
        return IntegrationError(f"the simulation {finer.how} failed: {responses.failures[0]}", None)
    factor = np.broadcast_to(finer.factor, len(problem.model.channels))[problem.columns]
    error = factor * (at.response - responses.values[0][:, problem.columns])
    error[:, problem.data.wrapping] -= TURN * np.rint(error[:, problem.data.wrapping] / TURN)
    return IntegrationError(finer.how, np.where(problem.data.present, error, 0.0))


def as_residuals(problem: MisfitProblem, at: Linearisation, error: np.ndarray) -> np.ndarray:
    """Return an error (samples, channels) of a response as a change of :meth:`MisfitProblem.residuals`."""
    return np.concatenate([problem.weighted(error, at.response).ravel(), np.zeros(problem.priors)])
