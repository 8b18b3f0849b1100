"""Uniform and log-uniform priors."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from dalembert.arguments import is_real
from dalembert.errors import shown
from dalembert.priors.prior import Prior


@dataclass(frozen=True)
class Uniform(Prior):
    """Uniform distribution: the prior of a parameter of which only the bounds are known.

    Parameters
    ----------
    lower, upper : float
        In SI units. The bounds of the parameter must not exceed them.

    Examples
    --------
    >>> Uniform(1.0, 3.0).quantile(0.25).item()
    1.5
    """

    name: ClassVar[str] = "uniform"
    lower: float
    upper: float
    kind: str = field(default="uniform", init=False, repr=False)

    def _mistakes(self) -> Iterator[str]:
        yield from _proper(self.lower, self.upper)

    def mistake_within(self, lower: float, upper: float) -> str:
        return _narrower(self, lower, upper)

    def log_density(self, values: ArrayLike) -> np.ndarray:
        inside = (np.asarray(values) >= self.lower) & (np.asarray(values) <= self.upper)
        return np.where(inside, -np.log(self.upper - self.lower), -np.inf)

    def slope(self, values: ArrayLike) -> np.ndarray:
        return np.zeros(np.shape(values))

    def cumulative(self, values: ArrayLike) -> np.ndarray:
        return np.clip((np.asarray(values) - self.lower) / (self.upper - self.lower), 0, 1)

    def quantile(self, parts: ArrayLike) -> np.ndarray:
        return self.lower + np.asarray(parts) * (self.upper - self.lower)


@dataclass(frozen=True)
class LogUniform(Prior):
    """Distribution of a positive parameter whose logarithm is uniform: that of an unknown order of magnitude.

    Parameters
    ----------
    lower, upper : float
        In SI units. The bounds of the parameter must not exceed them.

    Examples
    --------
    >>> LogUniform(1.0, 100.0).quantile(0.5).item()
    10.0
    """

    name: ClassVar[str] = "log-uniform"
    lower: float
    upper: float
    kind: str = field(default="log-uniform", init=False, repr=False)

    def _mistakes(self) -> Iterator[str]:
        yield from _proper(self.lower, self.upper)
        if not self.lower > 0:
            yield f"lower is {self.lower:g}, which makes the prior improper; expected a positive number"

    def mistake_within(self, lower: float, upper: float) -> str:
        return _narrower(self, lower, upper)

    def log_density(self, values: ArrayLike) -> np.ndarray:
        values = np.asarray(values)
        inside = (values >= self.lower) & (values <= self.upper)
        return np.where(inside, -np.log(np.maximum(values, self.lower) * np.log(self.upper / self.lower)), -np.inf)

    def slope(self, values: ArrayLike) -> np.ndarray:
        return -1 / np.asarray(values)

    def cumulative(self, values: ArrayLike) -> np.ndarray:
        ratio = np.maximum(np.asarray(values), self.lower) / self.lower
        return np.clip(np.log(ratio) / np.log(self.upper / self.lower), 0, 1)

    def quantile(self, parts: ArrayLike) -> np.ndarray:
        return self.lower * (self.upper / self.lower) ** np.asarray(parts)


def _proper(lower: float, upper: float) -> Iterator[str]:
    if not is_real(lower) or not is_real(upper):
        yield f"lower and upper are {shown(lower)} and {shown(upper)}; expected two numbers"
    elif not (np.isfinite(lower) and np.isfinite(upper)):
        yield f"it extends from {lower:g} to {upper:g}, which makes the prior improper; expected two finite numbers"
    elif not lower < upper:
        yield f"it extends from {lower:g} to {upper:g}; expected two numbers, the lower one first"


def _narrower(prior: Uniform | LogUniform, lower: float, upper: float) -> str:
    """What is wrong where a prior has sharp ends inside the bounds: the search would not know them."""
    if prior.lower <= lower and upper <= prior.upper:
        return ""
    return (
        f"its prior is {prior.name} from {prior.lower:g} to {prior.upper:g}, narrower than its bounds ({lower:g}, "
        f"{upper:g}). Use the ends of the prior as bounds"
    )
