"""Which noise model describes which channel, and the parameters of all of them."""

from collections.abc import Mapping
from dataclasses import replace
from typing import TypeAlias

import numpy as np

from dalembert.errors import InputError, unknown
from dalembert.inverse.noise.correlation.series import Series, series_of
from dalembert.inverse.noise.likelihood.channel_noise import ChannelNoise
from dalembert.inverse.noise.likelihood.estimated_noise import EstimatedNoise
from dalembert.inverse.noise.models.independent_noise import ConstantNoise, KnownNoise
from dalembert.inverse.noise.models.noise_catalogue import noise_model
from dalembert.inverse.noise.models.noise_model import Extent, NoiseModel
from dalembert.inverse.problem.problem import MisfitProblem
from dalembert.parameter import Parameter
from dalembert.parameters import Parameters

Noise: TypeAlias = NoiseModel | str | Mapping[str, NoiseModel | str] | EstimatedNoise
"""One noise model for all channels, one for each by name, or those of a fit, whose orders are chosen."""


def picked_models(
    problem: MisfitProblem, noise: Noise | None, *, known: bool
) -> tuple[dict[Series, NoiseModel], NoiseModel | Mapping[str, NoiseModel]]:
    """Return the noise model of each channel with compared values, and the models by which it was chosen.

    ``known`` means that the weights of the problem are 1/variance.
    """
    usual = KnownNoise() if known else ConstantNoise()
    series = list(series_of(problem, fewest=1))
    noise = noise.models if isinstance(noise, EstimatedNoise) else noise
    if not isinstance(noise, Mapping):
        chosen = usual if noise is None else noise_model(noise)
        return dict.fromkeys(series, chosen), chosen
    names = [name for signal in series for name in (signal.name, signal.channel)]
    for name in noise:
        if name not in names:
            raise InputError(unknown("channel", str(name), dict.fromkeys(names), "noise"))
    several = {str(name): noise_model(entry) for name, entry in noise.items()}
    return {signal: several.get(signal.name, several.get(signal.channel, usual)) for signal in series}, several


def noises_of(
    problem: MisfitProblem, picked: Mapping[Series, NoiseModel], *, known: bool
) -> tuple[tuple[ChannelNoise, ...], Parameters]:
    """Return the noise of each series, and the parameters of all of them."""
    channels = tuple(_channel_noise(problem, signal, model, known=known) for signal, model in picked.items())
    return channels, noise_parameters(problem, channels)


def _channel_noise(problem: MisfitProblem, series: Series, model: NoiseModel, *, known: bool) -> ChannelNoise:
    if isinstance(model, KnownNoise) and not known:
        raise InputError(
            f"noise of channel {series.name!r}: KnownNoise was given, but the data have no deviations; give them, or "
            "take ConstantNoise()"
        )
    names = {item.name: f"{base_of(series, model)}.{item.name}" for item in model.parameters(_extent(problem, series))}
    weights = problem.weights.ravel()[series.rows]
    return ChannelNoise(series, model, weights**-0.5, names, model.whitening(series))


def base_of(series: Series, model: NoiseModel) -> str:
    """Return how the names of a channel's noise parameters begin: the same for experiments that share them."""
    return f"noise.{series.name if model.local else series.channel}"


def noise_parameters(problem: MisfitProblem, channels: tuple[ChannelNoise, ...]) -> Parameters:
    """Return the parameters of the noise of all channels; those of the same name are one, if they are alike."""
    by_name: dict[str, tuple[NoiseModel, Extent, str]] = {}
    for channel in channels:
        extent = _extent(problem, channel.series)
        for bare, full in channel.names.items():
            model, before, _ = by_name.get(full, (channel.model, extent, bare))
            if model != channel.model:
                raise InputError(
                    f"noise of channel {channel.series.channel!r}: experiments share its parameters, but have "
                    "different noise models; give all the same, or models with local=True"
                )
            size, step = max(before.size, extent.size), min(before.step, extent.step)
            joint = replace(before, size=size, step=step, length=max(before.length, extent.length))
            by_name[full] = model, joint, bare
    return Parameters(tuple(_named(name, *entry) for name, entry in by_name.items()))


def _named(name: str, model: NoiseModel, extent: Extent, bare: str) -> Parameter:
    return replace(next(item for item in model.parameters(extent) if item.name == bare), name=name)


def _extent(problem: MisfitProblem, series: Series) -> Extent:
    data = problem.data
    values = data.continuous.ravel()[series.rows]
    size = float(np.std(values)) or float(np.max(np.abs(values))) or 1.0
    names = [channel.name for channel in problem.model.channels]
    unit = problem.model.channels[names.index(series.name)].unit
    intervals = np.diff(series.along)
    step = float(np.min(intervals)) if len(intervals) else 1.0
    return Extent(size, unit, step, max(series.length, step), series.unit)
