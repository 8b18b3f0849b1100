"""The linear model of residuals about a point, and its regularised steps inside the bounds."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dalembert.optimize.tikhonov import Regularised


@dataclass(frozen=True, eq=False)
class LinearModel:
    """Residuals r + S d of a step d with down ≤ d ≤ up. What meets a bound stays there, and the others are chosen anew:
    clipped, the free step (3, 2) would be (3, 1).
    >>> slopes = np.array([[2.0, 1.0], [1.0, -1.0]])
    >>> model = LinearModel(np.array([-8.0, -1.0]), slopes, np.full(2, -9.0), np.array([9.0, 1.0]))
    >>> model.step(0.0).round(12).tolist()
    [3.2, 1.0]
    """

    residual: np.ndarray  # (values,): r
    slopes: np.ndarray  # (values, parameters): S
    # down, up (parameters,): room to the bounds, down ≤ 0 ≤ up.
    down: np.ndarray
    up: np.ndarray

    @cached_property
    def free(self) -> np.ndarray:
        """Mask (parameters,) of the parameters that no bound keeps from going downhill."""
        uphill = self.slopes.T @ self.residual
        return ~(((self.down >= 0) & (uphill > 0)) | ((self.up <= 0) & (uphill < 0)))

    @cached_property
    def regularised(self) -> Regularised:
        """The problem of the free parameters alone, without bounds."""
        return self._full if self.free.all() else Regularised.of(self.slopes[:, self.free], -self.residual)

    def step(self, mu: float) -> np.ndarray:
        """The step (parameters,) of least ‖r + S d‖² + μ² ‖d‖² between the bounds."""
        full = self._full
        step = full.steps(mu)
        if np.all((self.down <= step) & (step <= self.up)):
            return step
        from scipy.optimize import lsq_linear

        size = len(step)
        # The same minimum from k + parameters rows, in place of all values: S = U diag(s) Vᵀ, and Uᵀ leaves norms as
        # they are.
        matrix = np.vstack([full.singular[:, None] * full.directions, mu * np.eye(size)])
        right = np.concatenate([full.parts, np.zeros(size)])
        solution = lsq_linear(matrix, right, (self.down, self.up), method="bvls", tol=1e-14, max_iter=10 * (1 + size))
        return np.clip(solution.x, self.down, self.up)

    def foreseen(self, step: np.ndarray) -> float:
        """Fall of the sum of squares, ‖r‖² − ‖r + S d‖², without the cancellation."""
        change = self.slopes @ step
        return -float((2 * self.residual + change) @ change)

    @cached_property
    def _full(self) -> Regularised:
        return Regularised.of(self.slopes, -self.residual)
