"""What the restricted likelihood adds: the information on the model's parameters that the noise leaves."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from dalembert.inverse.noise.likelihood.channel_noise import STEP, ChannelNoise
from dalembert.inverse.problem.prior import prior_slopes
from dalembert.inverse.problem.problem import Linearisation, MisfitProblem
from dalembert.parameters import Parameters

RIDGE = 1e-12
"""Of the information, relative to its largest element: combinations that are not identifiable add a constant."""


@dataclass(frozen=True, eq=False)
class Restriction:
    """−½ log |I| of the information I on the model's parameters, a function of the noise parameters alone. Added to the
    log-likelihood it removes the bias of noise parameters that estimating the others causes.

    For a linear model and noise that does not depend on its response the sum is the restricted likelihood; otherwise it
    is that of the linearised model. A prior counts as data. Source: H. D. Patterson, R. Thompson, Recovery of
    inter-block information when block sizes are unequal, Biometrika 58 (1971).
    """

    problem: MisfitProblem
    channels: Sequence[ChannelNoise]
    parameters: Parameters  # of the model, then of the noise
    at: Linearisation  # where the response and its jacobian are taken

    def value(self, vector: np.ndarray) -> float:
        """Return it at a vector (parameters,)."""
        return float(np.real(self._of(self.parameters.arguments(vector))))

    def gradient(self, vector: np.ndarray) -> np.ndarray:
        """Return its gradient (parameters,), 0 for the model's parameters, by complex steps."""
        gradient, known = np.zeros(len(vector)), self.parameters.arguments(vector)
        for place in range(len(self.at.vector), len(vector)):
            name = self.parameters.names[place]
            gradient[place] = np.imag(self._of({**known, name: known[name] + 1j * STEP})) / STEP
        return gradient

    def _of(self, known: Mapping[str, Any]) -> complex:
        total = self._prior.astype(complex)
        for channel in self.channels:
            places = channel.series.rows
            residual, response, jacobian = (part[places] for part in self._flat)
            white, _, moves, spread = channel.slopes(residual, response, jacobian, channel.values(known))
            means = moves + white[:, None] * spread
            total = total + means.T @ means + 2 * spread.T @ spread
        total = total + RIDGE * np.max(np.abs(total)) * np.eye(len(total))
        sign, size = np.linalg.slogdet(total)
        return -0.5 * (size + 1j * np.angle(sign))

    @cached_property
    def _prior(self) -> np.ndarray:
        slopes = prior_slopes(self.problem.model.parameters, self.at.vector, self._scale)
        return slopes.T @ slopes

    @cached_property
    def _flat(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Residual and response (values,), and jacobian with respect to p/scale (values, parameters)."""
        residual = self.problem.unweighted_residual(self.at.response).ravel()
        return residual, self.at.response.ravel(), self.at.jacobian.reshape(len(residual), -1) * self._scale

    @property
    def _scale(self) -> np.ndarray:
        return self.problem.model.parameters.scale
