"""What minimisers of sums of squares share: their call, and the problem as they see it."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from dalembert.arguments import Checked
from dalembert.intervals import corners
from dalembert.optimize.minimum import Minimum, OnIteration


@dataclass(frozen=True, eq=False)
class SumOfSquares:
    """A sum of squares over a box, by the arguments of :meth:`SquaresMinimiser.minimise`."""

    residual: Callable[[np.ndarray], np.ndarray]
    jacobian: Callable[[np.ndarray], np.ndarray]
    low: np.ndarray
    high: np.ndarray
    unit: np.ndarray
    on_iteration: OnIteration


@dataclass(frozen=True)
class SquaresMinimiser(Checked, ABC):
    """Base of the minimisers of sums of squares."""

    def minimise(
        self,
        residual: Callable[[np.ndarray], np.ndarray],
        jacobian: Callable[[np.ndarray], np.ndarray],
        lower: ArrayLike,
        upper: ArrayLike,
        start: ArrayLike,
        *,
        scale: ArrayLike = 1.0,
        on_iteration: OnIteration | None = None,
    ) -> Minimum:
        """Least sum of squares near ``start``.

        Parameters
        ----------
        residual : callable
            (parameters,) to (residuals,); NaN or infinite where the sample failed, which shortens the step.
        jacobian : callable
            (parameters,) to (residuals, parameters); asked only where the residual was just computed.
        lower, upper, start, scale : array, shape (parameters,)
        on_iteration : callable, optional
            Called with a :class:`Progress` at the start and after each accepted step, with its
            :class:`RegularisedStep` if the method takes such steps.
        """
        low, high = corners(lower, upper)
        x = np.clip(np.asarray(start, dtype=float), low, high)
        unit = np.broadcast_to(np.asarray(scale, dtype=float), x.shape)
        tell = on_iteration or (lambda progress: None)
        return self.descend(SumOfSquares(residual, jacobian, low, high, unit, tell), x)

    @abstractmethod
    def descend(self, problem: SumOfSquares, start: np.ndarray) -> Minimum:
        """Least sum of squares near a point (parameters,) of the box."""
