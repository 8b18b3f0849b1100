"""First guesses of noise parameters from the residuals of a fit."""

from collections.abc import Sequence

import numpy as np

from dalembert.inverse.noise.likelihood.channel_noise import ChannelNoise
from dalembert.inverse.problem.problem import MisfitProblem
from dalembert.parameters import Parameters


def guessed(
    channels: Sequence[ChannelNoise], parameters: Parameters, problem: MisfitProblem, values_at: np.ndarray
) -> np.ndarray:
    """Return first guesses (parameters,) of noise parameters at a response (samples, channels).

    They are means over the channels that share a parameter.
    """
    residual, response = problem.unweighted_residual(values_at).ravel(), values_at.ravel()
    guesses: dict[str, list[float]] = {name: [] for name in parameters.names}
    for channel in channels:
        places = channel.series.rows
        for bare, value in channel.model.guess(channel.series, residual[places], response[places]).items():
            if channel.names[bare] in guesses:
                guesses[channel.names[bare]].append(value)
    values = [
        float(np.mean(guesses[item.name])) if guesses[item.name] else start
        for item, start in zip(parameters, parameters.start, strict=True)
    ]
    return parameters.clip(np.array(values))
