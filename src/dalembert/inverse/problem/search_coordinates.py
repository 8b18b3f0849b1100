"""The coordinates in which parameters are searched."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dalembert.parameters import Parameters

BOUND = 1e-6
"""Distance from a bound, as a part of the width between bounds, up to which a parameter is on it."""


@dataclass(frozen=True)
class SearchCoordinates:
    """Search coordinates z of parameters p: p/scale, or ln(p/lower) for parameters whose logarithm is searched."""

    parameters: Parameters

    @cached_property
    def logarithmic(self) -> np.ndarray:
        """Mask of the parameters whose logarithm is searched, shape (parameters,)."""
        return np.array([item.logarithmic for item in self.parameters], dtype=bool)

    @cached_property
    def _unit(self) -> np.ndarray:
        return np.where(self.logarithmic, self.parameters.lower, self.parameters.scale)

    @cached_property
    def lower(self) -> np.ndarray:
        return self.points(self.parameters.lower)

    @cached_property
    def upper(self) -> np.ndarray:
        return self.points(self.parameters.upper)

    def points(self, vectors: np.ndarray) -> np.ndarray:
        """Coordinates of parameter vectors, both (..., parameters)."""
        ratio = vectors / self._unit
        return np.where(self.logarithmic, np.log(np.where(self.logarithmic, ratio, 1.0)), ratio)

    def vectors(self, points: np.ndarray) -> np.ndarray:
        """Parameter vectors at coordinates, both (..., parameters), inside the bounds."""
        vectors = self._unit * np.where(self.logarithmic, np.exp(points * self.logarithmic), points)
        return np.clip(vectors, self.parameters.lower, self.parameters.upper)

    def slope(self, vector: np.ndarray) -> np.ndarray:
        """dp/dz at a parameter vector, both (parameters,)."""
        return np.where(self.logarithmic, vector, self._unit)


def off_bounds(parameters: Parameters, values: np.ndarray) -> np.ndarray:
    """Return which parameters are on no bound at values, both of shape (parameters,)."""
    near = BOUND * (parameters.upper - parameters.lower)
    return (values - parameters.lower > near) & (parameters.upper - values > near)
