"""Weighted sensitivities of a model's response, before there are any data."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from dalembert.argument_readers import numbers_of
from dalembert.errors import InputError, SolveError, StorageError, require_known, told
from dalembert.forward import ForwardModel, check_derivatives
from dalembert.inverse.problem.simulated import named


def noise_of(
    model: ForwardModel, deviations: Mapping[str, float] | ArrayLike, where: str
) -> tuple[tuple[str, ...], np.ndarray, np.ndarray]:
    """Channels, their places in the model, and the standard deviations of their noise, each (channels,).

    A mapping chooses the channels that it names; a number holds for all that the model has.
    """
    known = tuple(channel.name for channel in model.channels)
    names = tuple(deviations) if isinstance(deviations, Mapping) else known
    for name in names:
        require_known("channel", name, known, f"{where}: deviations")
    levels = [deviations[name] for name in names] if isinstance(deviations, Mapping) else deviations
    values = numbers_of(levels, where, "deviations")
    if values.shape not in ((), (len(names),)) or not names:
        raise InputError(
            f"{where}: deviations of shape {values.shape} were given; expected a number, or one for each of "
            f"{', '.join(known)}"
        )
    values = np.broadcast_to(values, (len(names),))
    for name, value in zip(names, values, strict=True):
        if not (np.isfinite(value) and value > 0):
            raise InputError(f"{where}: channel {name!r}: its deviation is {value}; expected a positive number")
    return names, np.array([known.index(name) for name in names]), values


def at_of(model: ForwardModel, at: Mapping[str, float] | ArrayLike | None, where: str) -> np.ndarray:
    """The parameter vector (parameters,) to look at; the first guesses if none is given."""
    model.parameters.check_some(where)
    return model.parameters.start if at is None else np.asarray(model.parameters.vector(at), dtype=float)


def linearised(model: ForwardModel, vector: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Response (samples, channels) and jacobian (samples, channels, parameters) at a vector (parameters,)."""
    check_derivatives(model, vector)
    at = named(model, vector)
    try:
        response, jacobian = model.linearise(vector)
    except (InputError, StorageError):  # no other vector will do better
        raise
    except Exception as error:  # whatever a user's function raises is this vector's failure
        raise SolveError(f"{told(error)} (at {at}); look at the model there, or look elsewhere") from error
    if not (np.all(np.isfinite(response)) and np.all(np.isfinite(jacobian))):
        raise SolveError(f"the response or its jacobian at {at} is not finite; look at the model there, or elsewhere")
    return response, jacobian
