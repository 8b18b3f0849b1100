"""The prior density of all parameters together."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dalembert.inverse.problem.prior import joint_priors
from dalembert.parameters import Parameters
from dalembert.priors import CorrelatedNormal


@dataclass(frozen=True)
class PriorDensity:
    """Product of the priors of all parameters, up to the constant that truncation by the bounds brings."""

    parameters: Parameters

    @cached_property
    def _alone(self) -> list[int]:
        items = self.parameters.items
        return [k for k, item in enumerate(items) if not isinstance(item.prior, CorrelatedNormal)]

    @cached_property
    def _joint(self) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
        """Columns, mean and whitening matrix of the priors of several parameters."""
        joint = joint_priors(self.parameters)
        return [(columns, np.array(prior.mean), prior.whitening()) for prior, columns in joint]

    def __call__(self, vectors: np.ndarray) -> np.ndarray:
        """Logarithm of the density (...,) at vectors (..., parameters)."""
        density = np.zeros(vectors.shape[:-1])
        for k in self._alone:
            density = density + self.parameters.items[k].distribution.log_density(vectors[..., k])
        for columns, mean, matrix in self._joint:
            # Normal density of several parameters: −½ ‖W (p − μ)‖² + ln det W − n/2 ln 2π, with the triangular W = L⁻¹
            # of Σ = L Lᵀ.
            white = (vectors[..., columns] - mean) @ matrix.T
            constant = np.sum(np.log(np.diag(matrix))) - len(mean) / 2 * np.log(2 * np.pi)
            density = density - 0.5 * np.sum(white**2, axis=-1) + constant
        return density

    def gradient(self, vector: np.ndarray) -> np.ndarray:
        """Its derivative at a vector, both (parameters,)."""
        gradient = np.zeros(len(vector))
        for k in self._alone:
            gradient[k] = self.parameters.items[k].distribution.slope(vector[k])
        for columns, mean, matrix in self._joint:
            gradient[columns] = -matrix.T @ matrix @ (vector[columns] - mean)
        return gradient

    def draws(self, count: int, seed: int) -> np.ndarray:
        """Vectors drawn from the truncated prior, shape (count, parameters)."""
        random, parameters = np.random.default_rng(seed), self.parameters
        vectors = np.empty((count, len(parameters)))
        for k in self._alone:
            item = parameters.items[k]
            vectors[:, k] = item.distribution.within(random.random(count), item.lower, item.upper)
        for columns, mean, matrix in self._joint:
            # Truncation by rejection: what falls outside of the bounds is drawn again.
            factor, missing = np.linalg.inv(matrix), np.arange(count)
            lower, upper = parameters.lower[columns], parameters.upper[columns]
            while len(missing):
                vectors[np.ix_(missing, columns)] = mean + random.standard_normal((len(missing), len(mean))) @ factor.T
                drawn = vectors[np.ix_(missing, columns)]
                missing = missing[np.any((drawn < lower) | (drawn > upper), axis=1)]
        return vectors
