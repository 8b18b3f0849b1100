"""The noise of a measurement that is planned: weighted, and whitened, sensitivities of its channels."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from dalembert.errors import InputError, require_known, unknown
from dalembert.forward import Coordinate, ForwardModel
from dalembert.inverse.assessment.sensitivity import noise_of
from dalembert.inverse.noise.correlation.series import Series, even_grid
from dalembert.inverse.noise.likelihood.estimated_noise import EstimatedNoise
from dalembert.inverse.noise.models.independent_noise import KnownNoise
from dalembert.inverse.noise.models.noise_catalogue import noise_model
from dalembert.inverse.noise.models.noise_model import Extent, NoiseModel

# Noise of channels with known parameters: of all, by name, or as a fit has estimated it.
Planned = NoiseModel | str | Mapping[str, NoiseModel | str] | EstimatedNoise


@dataclass(frozen=True, eq=False)
class PlannedChannels:
    """Channels that can be measured, with their noise."""

    names: tuple[str, ...]
    columns: np.ndarray  # (channels,): their places in the model
    deviations: np.ndarray  # (channels,): known standard deviations; NaN where they are not given
    # The noise of each channel, and the values of its parameters.
    noises: tuple[tuple[NoiseModel, Mapping[str, np.ndarray]], ...]
    along: Coordinate

    def whitened(self, response: np.ndarray, jacobian: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return deviations (channels,) of the noise, and weighted sensitivities (samples, channels, parameters). The
        deviations are root mean squares over the samples. Sensitivities are those of the model, with the response
        (samples, all channels), over the deviation, less their prediction from the samples before.
        """
        sizes, rows = np.empty((len(response), len(self.names))), jacobian[:, self.columns].copy()
        for place, (name, (model, values)) in enumerate(zip(self.names, self.noises, strict=True)):
            channel_response = response[:, self.columns[place]]
            sizes[:, place] = model.deviations(
                channel_response, np.full(len(channel_response), self.deviations[place]), values
            )
            if not np.all(sizes[:, place] > 0):
                raise InputError(
                    f"design: the noise of channel {name!r} has no standard deviation at some samples; give its "
                    "deviation, or MixedNoise where the response is 0"
                )
            rows[:, place] /= sizes[:, place, None]
            process = model.whitening(_series(name, self.along))
            if process is not None:
                rows[:, place] = process.matrix(values) @ rows[:, place]
        return np.sqrt(np.mean(sizes**2, axis=0)), rows


def planned_channels(
    model: ForwardModel, deviations: Mapping[str, float] | ArrayLike | None, noise: Planned | None
) -> PlannedChannels:
    """Return the channels of a model that can be measured."""
    if noise is None and deviations is None:
        raise InputError("design: the noise is not known; give deviations, or noise")
    names, columns, known = _channels(model, deviations, noise)
    noises = tuple(_described(name, noise, Extent(1.0, "", 1.0, 1.0, "")) for name in names)
    for name, (named_noise, _) in zip(names, noises, strict=True):
        named_noise.whitening(_series(name, model.coordinate))  # refuses an order that is open
    if deviations is not None and noise is not None and not any(_needs_deviations(*entry) for entry in noises):
        raise InputError(
            "design: noise and deviations were given, and noise needs no deviations; leave one of them out"
        )
    return PlannedChannels(names, columns, known, noises, model.coordinate)


def _channels(
    model: ForwardModel, deviations: Mapping[str, float] | ArrayLike | None, noise: Planned | None
) -> tuple[tuple[str, ...], np.ndarray, np.ndarray]:
    """Names and columns of the channels, and their deviations, NaN where they are not given."""
    if deviations is not None:
        return noise_of(model, deviations, "design")
    known = tuple(channel.name for channel in model.channels)
    names = tuple(noise) if isinstance(noise, Mapping) else known
    if isinstance(noise, EstimatedNoise):
        names = tuple(name for name in known if _fitted(noise, name))
        if not names:
            raise InputError(unknown("channel", next(iter(noise.models), ""), known, "design: noise"))
    for name in names:
        require_known("channel", name, known, "design: noise")
    return names, np.array([known.index(name) for name in names]), np.full(len(names), np.nan)


def _described(name: str, noise: Planned | None, extent: Extent) -> tuple[NoiseModel, Mapping[str, np.ndarray]]:
    """The noise model of a channel, and the values of its parameters."""
    if isinstance(noise, EstimatedNoise):
        return _estimated(name, noise)
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


def _fitted(noise: EstimatedNoise, name: str) -> list[str]:
    """Names of a channel in a fit: its own, or those of its experiments, ``"EXPERIMENT.channel"``."""
    return (
        [name]
        if name in noise.models
        else [full_name for full_name in noise.models if full_name.partition(".")[2] == name]
    )


def _estimated(name: str, noise: EstimatedNoise) -> tuple[NoiseModel, Mapping[str, np.ndarray]]:
    """The noise of a channel in a fit, which all experiments must share."""
    fitted = _fitted(noise, name)
    if not fitted:
        raise InputError(unknown("channel", name, noise.models, "design: noise"))
    if len({noise.bases[full_name] for full_name in fitted}) > 1:
        raise InputError(
            f"design: the noise of channel {name!r} differs between the experiments of the fit ({', '.join(fitted)}). "
            "Give a noise model with numbers for it"
        )
    return noise.models[fitted[0]], noise.of_channel(fitted[0], noise.estimates)


def _needs_deviations(model: NoiseModel, values: Mapping[str, np.ndarray]) -> bool:
    """Whether noise is computed from known deviations."""
    return not np.all(np.isfinite(model.deviations(np.ones(1), np.full(1, np.nan), values)))


def _series(name: str, along: Coordinate) -> Series:
    grid, step = even_grid(along.values)
    return Series(name, np.arange(len(along.values)), along.values, grid, step, along.unit, channel=name)
