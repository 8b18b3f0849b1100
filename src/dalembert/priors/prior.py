"""What every prior distribution of one parameter offers."""

from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from dalembert.arguments import is_real
from dalembert.errors import InputError, shown

LEAST = 1e-9  # probability of a prior between the bounds of its parameter, below which the two contradict each other


@dataclass(frozen=True)
class Prior(ABC):
    """Base of the prior distributions of one parameter; a subclass with a ``name`` is a kind of study files."""

    name: ClassVar[str]

    def __post_init__(self) -> None:
        for mistake in self._mistakes():
            raise InputError(f"{type(self).__name__}: {mistake}")

    @abstractmethod
    def _mistakes(self) -> Iterator[str]: ...

    @abstractmethod
    def log_density(self, values: ArrayLike) -> np.ndarray:
        """Logarithm of the density, both (...,); −inf outside the support."""

    @abstractmethod
    def slope(self, values: ArrayLike) -> np.ndarray:
        """Derivative of :meth:`log_density`, both (...,)."""

    @abstractmethod
    def cumulative(self, values: ArrayLike) -> np.ndarray:
        """Probability of a smaller value, both (...,)."""

    @abstractmethod
    def quantile(self, parts: ArrayLike) -> np.ndarray:
        """Value that is larger than the true one with these probabilities, both (...,)."""

    def mistake_within(self, lower: float, upper: float) -> str:
        """Return what is wrong with the prior of a parameter with these bounds; empty if nothing is."""
        within = float(self.cumulative(upper) - self.cumulative(lower))
        if within >= LEAST:
            return ""
        return (
            f"its prior has the probability {within:.1g} between the bounds ({lower:g}, {upper:g}). Correct the prior "
            "or the bounds"
        )

    def within(self, parts: ArrayLike, lower: float, upper: float) -> np.ndarray:
        """Quantiles (...,) of the prior truncated by bounds."""
        ends = self.cumulative(lower), self.cumulative(upper)
        return np.clip(self.quantile(ends[0] + np.asarray(parts) * (ends[1] - ends[0])), lower, upper)


class SquarePrior(Prior):
    """A prior whose −2 log density is the square of a residual and a constant: least squares can use it."""

    @abstractmethod
    def residual(self, values: ArrayLike) -> np.ndarray:
        """The residual, both (...,)."""

    @abstractmethod
    def residual_slope(self, values: ArrayLike) -> np.ndarray:
        """Derivative of :meth:`residual`, both (...,)."""

    @property
    @abstractmethod
    def spread(self) -> float:
        """Standard deviation of the parameter before any data."""


def finite(**numbers: float) -> Iterator[str]:
    for name, value in numbers.items():
        if not is_real(value) or not np.isfinite(value):
            yield f"{name} is {shown(value)}; expected a finite number"


def positive(**numbers: float) -> Iterator[str]:
    for name, value in numbers.items():
        if not is_real(value) or not 0 < value < np.inf:
            why = ", which makes the prior improper" if value == np.inf else ""
            yield f"{name} is {shown(value)}{why}; expected a positive number"


def positive_bound(prior: Prior, lower: float) -> str:
    return "" if lower > 0 else f"its prior is {prior.name}, but its lower bound is {lower:g}. Raise the bound above 0"
