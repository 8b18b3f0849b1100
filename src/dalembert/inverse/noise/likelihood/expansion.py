"""The log-likelihood to second order: whitened residuals and their derivatives."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from dalembert.inverse.noise.likelihood.channel_noise import HALF_LOG_2_PI, ChannelNoise
from dalembert.inverse.problem.problem import Linearisation, MisfitProblem
from dalembert.parameters import Parameters


@dataclass(frozen=True, eq=False)
class Expansion:
    """Log-likelihood, gradient and information at a vector. With w = (m − y)/s, M = ``means`` and S = ``spreads``,
    ∂w = M − w S, the gradient is −Mᵀ w + Sᵀ (w² − 1) and the information Mᵀ M + 2 Sᵀ S: its expectation is Fisher's.
    For parameters of the response and a deviation that does not depend on it, it is Jᵀ Σ⁻¹ J.
    """

    at: Linearisation  # of the response
    vector: np.ndarray  # (parameters,): of the model, then of the noise
    # white, logs: (values,): whitened residuals w, and log s, with the deviation s of each value after those before it
    white: np.ndarray
    logs: np.ndarray
    # means, spreads: (values, parameters): ∂m/s, with the mean m of each value after those before it, and ∂ log s
    means: np.ndarray
    spreads: np.ndarray

    @property
    def value(self) -> float:
        """Log-likelihood."""
        return float(-0.5 * self.white @ self.white - np.sum(self.logs) - HALF_LOG_2_PI * len(self.white))

    @property
    def gradient(self) -> np.ndarray:
        """Its gradient (parameters,)."""
        return -self.means.T @ self.white + self.spreads.T @ (self.white**2 - 1)

    @property
    def rows(self) -> np.ndarray:
        """G with the information Gᵀ G, shape (2 values, parameters)."""
        return np.concatenate([self.means, np.sqrt(2) * self.spreads])


def expanded(
    problem: MisfitProblem,
    channels: Sequence[ChannelNoise],
    parameters: Parameters,
    at: Linearisation,
    vector: np.ndarray,
) -> Expansion:
    """Return the expansion from a linearised response; ``parameters`` are those of the vector."""
    count, known = at.jacobian.shape[-1], parameters.arguments(vector)
    residual, response = problem.unweighted_residual(at.response).ravel(), at.response.ravel()
    jacobian = at.jacobian.reshape(len(residual), count)
    white, logs, means, spreads = [], [], [], []
    for channel in channels:
        places, values = channel.series.rows, channel.values(known)
        density, sizes, slopes, spread = channel.slopes(residual[places], response[places], jacobian[places], values)
        moves, changes = np.zeros((2, len(places), len(vector)))
        moves[:, :count], changes[:, :count] = slopes, spread
        for full, (move, change) in channel.noise_slopes(residual[places], response[places], values).items():
            if full in parameters.names:
                moves[:, parameters.names.index(full)] = move
                changes[:, parameters.names.index(full)] = change
        white.append(density)
        logs.append(sizes)
        means.append(moves + density[:, None] * changes)
        spreads.append(changes)
    return Expansion(at, vector, *(np.concatenate(part) for part in (white, logs, means, spreads)))


def moved(at: Linearisation, vector: np.ndarray) -> Linearisation:
    """Return the linearised response at another vector (parameters,) of the model."""
    return Linearisation(vector, at.response + at.jacobian @ (vector - at.vector), at.jacobian)
