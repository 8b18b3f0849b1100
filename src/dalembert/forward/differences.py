"""Derivatives of a model's response by central differences, where a complex step cannot be used."""

import numpy as np

from dalembert.errors import SolveError
from dalembert.forward.model import ForwardModel

COMPLEX_STEP = "complex-step"
DERIVATIVES = (COMPLEX_STEP, "central-differences")
# Step in scales, at which truncation and rounding have about the same size.
RELATIVE_STEP = np.finfo(float).eps ** (1 / 3)


def central_differences(model: ForwardModel, vector: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Response (samples, channels) and its derivative (samples, channels, parameters), by one batch."""
    steps = RELATIVE_STEP * model.parameters.scale
    moved = np.diag(steps)
    responses = model.evaluate(np.concatenate([vector[None], vector + moved, vector - moved]))
    for reason in filter(None, responses.failures):
        raise SolveError(reason)
    response, ahead, behind = np.split(responses.values, [1, 1 + len(vector)])
    return response[0], np.moveaxis((ahead - behind) / (2 * steps[:, None, None]), 0, -1)
