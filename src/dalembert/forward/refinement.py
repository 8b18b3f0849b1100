"""The same model with smaller numerical errors, to estimate how far these move its response."""

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from dalembert.forward.model import ForwardModel


@dataclass(frozen=True, eq=False)
class Refinement:
    """A model with finer steps or tighter tolerances.

    Parameters
    ----------
    model : ForwardModel
        Of the same parameters, channels and samples; its fingerprint is another one.
    factor : float or array, shape (channels,)
        Error of the coarser response as a multiple of its difference to the finer one (see :func:`error_factor`); 0 for
        channels that are not refined.
    how : str
        What is finer, such as ``"at half the step"``.
    """

    model: ForwardModel
    factor: float | np.ndarray
    how: str


@runtime_checkable
class Refinable(Protocol):
    """A forward model that may have a more exact one."""

    def refined(self) -> Refinement | None:
        """Return a more exact model, or None."""
        ...


def refined(model: ForwardModel) -> Refinement | None:
    """Return a more exact model, or None where the model offers none."""
    return model.refined() if isinstance(model, Refinable) else None


def error_factor(order: int | None) -> float:
    """Return the error of a response as a multiple of its difference to that at half the step, for a method's order.

    It is 2^q/(2^q − 1) with the order q (Richardson's extrapolation); 1 for None, where the finer response is so exact
    that the difference is the error.

    >>> error_factor(2), error_factor(None)
    (1.3333333333333333, 1.0)
    """
    return 1.0 if order is None else 2.0**order / (2.0**order - 1)
