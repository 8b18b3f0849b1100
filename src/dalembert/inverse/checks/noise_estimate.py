"""What the estimated noise shows, as findings."""

from collections.abc import Iterator

import numpy as np

from dalembert.errors import listed
from dalembert.findings import Finding
from dalembert.inverse.checks.residual_correlation import systematic_findings
from dalembert.inverse.identification.assess import Optimum
from dalembert.inverse.least_squares.estimate import left_vectors
from dalembert.inverse.noise.correlation.correlated_residuals import NoiseProcess
from dalembert.inverse.noise.correlation.correlation import correlated_series, period_of
from dalembert.inverse.noise.likelihood.channel_noise import ChannelNoise
from dalembert.inverse.noise.likelihood.estimate_noise import NoiseFit
from dalembert.inverse.noise.models.correlated_noise import AutoregressiveNoise, OrnsteinUhlenbeckNoise
from dalembert.inverse.noise.models.noise_model import NoiseModel
from dalembert.inverse.noise.models.whitening import correlations_of
from dalembert.inverse.problem.random_residuals import autocorrelation


def noise_estimate(optimum: Optimum) -> Iterator[Finding]:
    """Yield what was estimated of the noise, and what speaks against the noise model.

    That is noise parameters at a bound, residuals that the noise model leaves correlated, and slow noise.
    """
    noise = optimum.minimum.noise
    if noise is None:
        return
    slow = systematic_findings([process for process in _processes(noise) if process.systematic])
    left = tuple(_left_correlated(noise))
    models = {name: _in_words(model) for name, model in noise.noise.models.items()}
    words = [
        f"of {listed([repr(name) for name, item in models.items() if item == kind])}: {kind}"
        for kind in dict.fromkeys(models.values())
    ]
    message = f"The noise is estimated with the parameters, {'; '.join(words)}."
    message += "" if left else " Whitened by it, the residuals are not correlated."
    values = {"log_likelihood": noise.noise.log_likelihood, "parameters": len(noise.noise.parameters)}
    yield Finding("noise-estimated", "note", values, message)
    yield from (*_at_bounds(noise), *left, *slow)


def _in_words(model: NoiseModel) -> str:
    """Return a noise model in words, such as "autoregressive of order 2, mixed"."""
    order = f" of order {model.order}" if isinstance(model, AutoregressiveNoise) else ""
    inner = getattr(model, "deviation", None)
    return f"{model.name}{order}" + (f", {inner.name}" if isinstance(inner, NoiseModel) else "")


def _at_bounds(noise: NoiseFit) -> Iterator[Finding]:
    for item, value in zip(noise.noise.parameters, noise.noise.values, strict=True):
        near = 1e-6 * (abs(value) if item.log else item.upper - item.lower)
        for side, bound in (("lower", item.lower), ("upper", item.upper)):
            if abs(value - bound) <= near:
                yield Finding(
                    "noise-parameter-at-bound",
                    "warning",
                    {"parameter": item.name, "side": side, "bound": float(bound)},
                    f"The noise parameter {item.name!r} is at its {side} bound {bound:.6g}.",
                    "Take a noise model without it, or widen its bounds.",
                )


def _left_correlated(noise: NoiseFit) -> Iterator[Finding]:
    """Yield a finding where whitened residuals are correlated still."""
    white = np.nan_to_num(noise.noise.whitened).ravel()
    basis = left_vectors(noise.slopes)[: len(white)]
    series = [channel.series for channel in noise.likelihood.channels if len(channel.series.rows) > 1]
    left = correlated_series(series, white, basis)
    if not left:
        return
    worst = min(left, key=lambda signal: left[signal])
    first = autocorrelation(white[worst.rows], (len(worst.rows), 1))
    names = listed([repr(signal.name) for signal in left])
    yield Finding(
        "noise-model-too-simple",
        "warning",
        {"channel": worst.name, "channels": len(left), "autocorrelation": first, "p_value": left[worst]},
        f"The noise model does not describe the residuals of {names}: whitened by it, they are correlated (lag-1 "
        f"autocorrelation {first:.2f}).",
        "Take AutoregressiveNoise, OrnsteinUhlenbeckNoise or a higher order, or check the model structure.",
    )


def _processes(noise: NoiseFit) -> Iterator[NoiseProcess]:
    response, known = noise.at.response.ravel(), noise.noise.estimates
    for channel in noise.likelihood.channels:
        series, model = channel.series, channel.model
        values = {bare: float(known[full]) for bare, full in channel.names.items()}
        time, first = _memory(channel, values)
        if time > 0:
            yield NoiseProcess(
                channel=series.name,
                p_value=0.0,  # chosen on purpose
                first=first,
                order=model.order if isinstance(model, AutoregressiveNoise) else 1,  # pyright: ignore[reportArgumentType]
                even=series.grid is not None,
                variance=1.0,
                time=float(min(time, series.length)),
                period=period_of(series, response[series.rows]),
                unit=series.unit,
                first_order=isinstance(model, OrnsteinUhlenbeckNoise) or getattr(model, "order", 0) == 1,
            )


def _memory(channel: ChannelNoise, values: dict[str, float]) -> tuple[float, float]:
    """Return the time in which the autocorrelation of a channel's noise decays by e, and that of neighbours."""
    step = channel.series.step
    if isinstance(channel.model, OrnsteinUhlenbeckNoise):
        return values["time"], float(np.exp(-step / values["time"]))
    if not isinstance(channel.model, AutoregressiveNoise) or not channel.model.order:
        return 0.0, 0.0
    known = correlations_of([np.asarray(values[f"partial{k}"]) for k in range(1, channel.model.order + 1)], MEMORY)
    below = np.flatnonzero(np.abs(known) < np.exp(-1))
    return float(below[0] if len(below) else MEMORY) * step, float(known[1])


MEMORY = 1000
"""Most samples over which the autocorrelation of noise is followed."""
