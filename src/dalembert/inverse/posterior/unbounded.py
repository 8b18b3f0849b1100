"""Coordinates without bounds, in which samplers move."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.special import expit, logit

from dalembert.parameters import Parameters

# Distance of a start from the bounds, as a part of their distance: at a bound the coordinate is infinite.
NEAREST = 1e-3


@dataclass(frozen=True)
class UnboundedCoordinates:
    """Coordinates z = logit u, where u runs from 0 to 1 between the bounds of a parameter:
    u = (p − lower)/(upper − lower), or the same of the logarithms for parameters whose logarithm is searched.
    """

    parameters: Parameters

    @cached_property
    def logarithmic(self) -> np.ndarray:
        """Mask of the parameters whose logarithm is searched, shape (parameters,)."""
        return np.array([item.logarithmic for item in self.parameters], dtype=bool)

    @cached_property
    def _ends(self) -> tuple[np.ndarray, np.ndarray]:
        lower, upper, logs = self.parameters.lower, self.parameters.upper, self.logarithmic
        return np.where(logs, np.log(np.where(logs, lower, 1)), lower), np.where(
            logs, np.log(np.where(logs, upper, 1)), upper
        )

    def points(self, vectors: np.ndarray) -> np.ndarray:
        """Coordinates of parameter vectors, both (..., parameters); those at a bound are moved inside."""
        lower, upper = self._ends
        inside = np.where(self.logarithmic, np.log(np.where(self.logarithmic, vectors, 1)), vectors)
        return logit(np.clip((inside - lower) / (upper - lower), NEAREST, 1 - NEAREST))

    def vectors(self, points: np.ndarray) -> np.ndarray:
        """Parameter vectors at coordinates, both (..., parameters)."""
        lower, upper = self._ends
        inside = lower + (upper - lower) * expit(points)
        return self.parameters.clip(np.where(self.logarithmic, np.exp(inside * self.logarithmic), inside))

    def slope(self, points: np.ndarray) -> np.ndarray:
        """dp/dz, both (..., parameters)."""
        lower, upper = self._ends
        # du/dz = u (1 − u), without the cancellation of 1 − u.
        inside = (upper - lower) * expit(points) * expit(-points)
        return np.where(self.logarithmic, self.vectors(points), 1.0) * inside

    def log_slope(self, points: np.ndarray) -> np.ndarray:
        """Σ log dp/dz over the parameters, shape (...,): what makes a density of p one of z."""
        lower, upper = self._ends
        # ln u(1 − u) = −|z| − 2 ln(1 + e^−|z|), finite for any z.
        size = -np.abs(points)
        inside = np.log(upper - lower) + size - 2 * np.log1p(np.exp(size))
        return np.sum(inside + np.where(self.logarithmic, lower + (upper - lower) * expit(points), 0.0), axis=-1)

    def log_slope_gradient(self, points: np.ndarray) -> np.ndarray:
        """Derivative of :meth:`log_slope`, both (..., parameters)."""
        lower, upper = self._ends
        logs = np.where(self.logarithmic, (upper - lower) * expit(points) * expit(-points), 0.0)
        # d/dz ln u(1 − u) = 1 − 2u; for logarithmic parameters d ln p/dz comes on top.
        return logs + expit(-points) - expit(points)
