"""Gradients of weighted sums of a response: by the adjoint of a model, or by its Jacobian."""

from collections.abc import Callable
from typing import Any

import numpy as np

from dalembert.errors import InputError, require_known
from dalembert.forward.model import ForwardModel

Pull = Callable[[np.ndarray], np.ndarray]
"""From a cotangent (samples, channels) to the derivative of sum(cotangent * response), (parameters,)."""

AUTO, DIRECT, ADJOINT = GRADIENTS = ("auto", "direct", "adjoint")


def prefers_adjoint(model: ForwardModel) -> bool:
    """Return whether a model has an adjoint that is cheaper than its Jacobian, by the number of its parameters."""
    least = getattr(model, "adjoint_from", None)
    return least is not None and len(model.parameters) >= least


def pullback(model: ForwardModel, vector: np.ndarray, derivative: str = AUTO) -> tuple[np.ndarray, Pull]:
    """Return the response of a model, and what gives the gradients of its weighted sums.

    Parameters
    ----------
    model : ForwardModel
    vector : array, shape (parameters,)
    derivative : {"auto", "direct", "adjoint"}
        By the Jacobian, whose price grows with the number of parameters, or by the adjoint. "auto" takes the adjoint
        where the model has one and its number of parameters is at least the model's ``adjoint_from``.

    Returns
    -------
    response : array, shape (samples, channels)
    pull : function
        From a cotangent c (samples, channels) to d sum(c * response) / d parameters, shape (parameters,). It may be
        called several times.

    Raises
    ------
    InputError
        For ``derivative="adjoint"`` where the model has no adjoint.

    Examples
    --------
    >>> import numpy as np
    >>> from dalembert.forward import PythonModel, pullback
    >>> times = np.linspace(0, 1, 3)
    >>> decay = PythonModel(lambda rate: np.exp(-rate * times), {"rate": (0.1, 2.0)}, ["x"], times)
    >>> response, pull = pullback(decay, np.array([1.0]))
    >>> pull(2 * response).round(4).tolist()
    [-0.6386]
    """
    require_known("derivative", derivative, GRADIENTS, "pullback")
    adjoint: Any = getattr(model, "pullback", None)
    if derivative == ADJOINT and adjoint is None:
        raise InputError(f"{type(model).__name__} has no adjoint. Take derivative='direct', or a TimeResponse")
    if derivative == ADJOINT or (derivative == AUTO and prefers_adjoint(model)):
        return adjoint(np.asarray(vector, dtype=float))
    response, jacobian = model.linearise(vector)
    return response, lambda cotangent: np.einsum("sc,scp->p", np.asarray(cotangent, dtype=float), jacobian)
