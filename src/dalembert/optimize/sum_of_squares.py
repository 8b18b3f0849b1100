"""What minimisers of sums of squares share: their call, and the problem as they see it."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from dalembert.arguments import Checked
from dalembert.intervals import corners
from dalembert.optimize.minimum import Minimum, OnIteration

Residual: TypeAlias = Callable[[np.ndarray], np.ndarray]  # residuals (values,) at a point (parameters,)


class Disturbance(Protocol):
    """What keeps residuals from zero at a point (parameters,) whose slopes are known."""

    def white(self, point: np.ndarray) -> bool:
        """Return True if many residuals look like white noise."""
        ...

    def error(self, point: np.ndarray) -> np.ndarray | None:
        """Return the error of the residuals (values,) that is no noise, such as an integrator's; None if not known."""
        ...


@dataclass(frozen=True, eq=False)
class SumOfSquares:
    """A sum of squares over a box, by the arguments of :meth:`SquaresMinimiser.minimise`."""

    residual: Residual
    jacobian: Callable[[np.ndarray], np.ndarray]
    low: np.ndarray
    high: np.ndarray
    unit: np.ndarray
    on_iteration: OnIteration
    ahead: Residual
    disturbance: Disturbance | None

    @property
    def widths(self) -> np.ndarray:
        """Distances between the bounds (parameters,), in units of the scale."""
        return (self.high - self.low) / self.unit


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
        ahead: Residual | None = None,
        disturbance: Disturbance | None = None,
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
        ahead : callable, optional
            Returns the same as ``residual``, where no jacobian will be asked for.
        disturbance : Disturbance, optional
            Noise and errors of the residuals. With it, a descent leaves out directions that are not identifiable
            between the bounds where it creeps along them.
        """
        low, high = corners(lower, upper)
        x = np.clip(np.asarray(start, dtype=float), low, high)
        unit = np.broadcast_to(np.asarray(scale, dtype=float), x.shape)
        tell = on_iteration or (lambda progress: None)
        problem = SumOfSquares(residual, jacobian, low, high, unit, tell, ahead or residual, disturbance)
        return self.descend(problem, x)

    @abstractmethod
    def descend(self, problem: SumOfSquares, start: np.ndarray) -> Minimum:
        """Least sum of squares near a point (parameters,) of the box."""
