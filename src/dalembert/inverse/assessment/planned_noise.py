"""The noise of a measurement that is planned: weighted, and whitened, sensitivities of its channels."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from dalembert.errors import InputError, require_known
from dalembert.forward import Coordinate, ForwardModel
from dalembert.inverse.assessment.sensitivity import linearised, noise_of
from dalembert.inverse.correlation.series import Series, even_grid
from dalembert.inverse.likelihood.estimated_noise import EstimatedNoise
from dalembert.inverse.noise.catalogue import noise_model
from dalembert.inverse.noise.deviations import KnownNoise
from dalembert.inverse.noise.noise_model import Extent, NoiseModel

Planned = NoiseModel | str | Mapping[str, NoiseModel | str] | EstimatedNoise
"""Noise of channels with known parameters: of all, by name, or as a fit has estimated it."""


@dataclass(frozen=True, eq=False)
class PlannedChannels:
    """Channels that can be measured, with their noise.

    Parameters
    ----------
    names : tuple of str
    sizes : array, shape (channels,)
        Standard deviation of the noise, in the root mean square over the samples.
    rows : array, shape (samples, channels, parameters)
        Sensitivities over the standard deviation, less their prediction from the samples before.
    """

    names: tuple[str, ...]
    sizes: np.ndarray
    rows: np.ndarray


def planned_channels(
    model: ForwardModel, vector: np.ndarray, deviations: Mapping[str, float] | ArrayLike | None, noise: Planned | None
) -> PlannedChannels:
    """Return the channels with their weighted sensitivities at a vector (parameters,).

    Raises
    ------
    InputError
        Without deviations and noise, for unknown channels, noise parameters without a value.
    SolveError
        If the simulation fails.
    """
    if noise is None and deviations is None:
        raise InputError("design: the noise is not known; give deviations, or noise")
    names, columns, known = _channels(model, deviations, noise)
    response, jacobian = linearised(model, vector)
    response, rows = response[:, columns], jacobian[:, columns].copy()
    sizes = np.empty(response.shape)
    for place, name in enumerate(names):
        described, values = _described(name, noise, Extent(1.0, "", 1.0, 1.0, ""))
        given = np.full(len(response), np.nan if known is None else known[place])
        sizes[:, place] = described.deviations(response[:, place], given, values)
        if not np.all(sizes[:, place] > 0):
            raise InputError(
                f"design: the noise of channel {name!r} has no standard deviation at some samples; give its deviation, "
                "or MixedNoise where the response is 0"
            )
        rows[:, place] /= sizes[:, place, None]
        process = described.whitening(_series(name, model.coordinate))
        if process is not None:
            rows[:, place] = process.matrix(values) @ rows[:, place]
    return PlannedChannels(names, np.sqrt(np.mean(sizes**2, axis=0)), rows)


def _channels(
    model: ForwardModel, deviations: Mapping[str, float] | ArrayLike | None, noise: Planned | None
) -> tuple[tuple[str, ...], np.ndarray, np.ndarray | None]:
    """Names and columns of the channels, and their deviations where they are given."""
    if deviations is not None:
        return noise_of(model, deviations, "design")
    known = tuple(channel.name for channel in model.channels)
    named = noise.models if isinstance(noise, EstimatedNoise) else noise
    names = tuple(named) if isinstance(named, Mapping) else known
    for name in names:
        require_known("channel", name, known, "design: noise")
    return names, np.array([known.index(name) for name in names]), None


def _described(name: str, noise: Planned | None, extent: Extent) -> tuple[NoiseModel, Mapping[str, np.ndarray]]:
    """The noise model of a channel, and the values of its parameters."""
    if isinstance(noise, EstimatedNoise):
        require_known("channel", name, noise.models, "design: noise")
        return noise.models[name], noise.of_channel(name, noise.estimates)
    chosen = noise.get(name) if isinstance(noise, Mapping) else noise
    model = KnownNoise() if chosen is None else noise_model(chosen)
    parameters = model.parameters(extent)
    unknown = [item.name for item in parameters if not item.is_fixed]
    if unknown:
        raise InputError(
            f"design: the noise of channel {name!r} has no value for {unknown[0]!r}; give a number, or the noise of a "
            "fit"
        )
    return model, {item.name: np.asarray(item.lower) for item in parameters}


def _series(name: str, along: Coordinate) -> Series:
    grid, step = even_grid(along.values)
    return Series(name, np.arange(len(along.values)), along.values, grid, step, along.unit, channel=name)
