"""Normal, log-normal and half-normal priors: those that least squares can use."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from dalembert.priors.prior import SquarePrior, finite, positive, positive_bound


@dataclass(frozen=True)
class Normal(SquarePrior):
    """Normal distribution.

    Parameters
    ----------
    mean, deviation : float
        In SI units.

    Examples
    --------
    >>> Normal(2.0, 0.5).residual(3.0).item()
    2.0
    """

    name: ClassVar[str] = "normal"
    mean: float
    deviation: float
    kind: str = field(default="normal", init=False, repr=False)

    def _mistakes(self) -> Iterator[str]:
        yield from finite(mean=self.mean)
        yield from positive(deviation=self.deviation)

    def residual(self, values: ArrayLike) -> np.ndarray:
        return (np.asarray(values) - self.mean) / self.deviation

    def residual_slope(self, values: ArrayLike) -> np.ndarray:
        return np.full(np.shape(values), 1 / self.deviation)

    @property
    def spread(self) -> float:
        return self.deviation

    def log_density(self, values: ArrayLike) -> np.ndarray:
        return -0.5 * self.residual(values) ** 2 - np.log(self.deviation * np.sqrt(2 * np.pi))

    def slope(self, values: ArrayLike) -> np.ndarray:
        return -self.residual(values) / self.deviation

    def cumulative(self, values: ArrayLike) -> np.ndarray:
        from scipy.special import ndtr  # parameters are imported without SciPy

        return ndtr(self.residual(values))

    def quantile(self, parts: ArrayLike) -> np.ndarray:
        from scipy.special import ndtri  # parameters are imported without SciPy

        return self.mean + self.deviation * ndtri(parts)


@dataclass(frozen=True)
class LogNormal(SquarePrior):
    """Distribution of a positive parameter whose logarithm is normal.

    In a fit by least squares, its residual (ln p − ln median)/log_deviation gives the mode of ln p.

    Parameters
    ----------
    median : float
        In SI units.
    log_deviation : float
        Standard deviation of the natural logarithm: 0.1 is about 10 % of the value.

    Examples
    --------
    >>> LogNormal(2.0, 0.1).quantile(0.5).item()
    2.0
    """

    name: ClassVar[str] = "log-normal"
    median: float
    log_deviation: float
    kind: str = field(default="log-normal", init=False, repr=False)

    def _mistakes(self) -> Iterator[str]:
        yield from positive(median=self.median, log_deviation=self.log_deviation)

    def mistake_within(self, lower: float, upper: float) -> str:
        return positive_bound(self, lower) or super().mistake_within(lower, upper)

    def residual(self, values: ArrayLike) -> np.ndarray:
        return np.log(np.asarray(values) / self.median) / self.log_deviation

    def residual_slope(self, values: ArrayLike) -> np.ndarray:
        return 1 / (self.log_deviation * np.asarray(values))

    @property
    def spread(self) -> float:
        square = self.log_deviation**2
        return self.median * float(np.exp(square / 2) * np.sqrt(np.expm1(square)))

    def log_density(self, values: ArrayLike) -> np.ndarray:
        values = np.asarray(values)
        return -0.5 * self.residual(values) ** 2 - np.log(values * self.log_deviation * np.sqrt(2 * np.pi))

    def slope(self, values: ArrayLike) -> np.ndarray:
        return -(self.residual(values) / self.log_deviation + 1) / np.asarray(values)

    def cumulative(self, values: ArrayLike) -> np.ndarray:
        from scipy.special import ndtr  # parameters are imported without SciPy

        return ndtr(self.residual(values))

    def quantile(self, parts: ArrayLike) -> np.ndarray:
        from scipy.special import ndtri  # parameters are imported without SciPy

        return self.median * np.exp(self.log_deviation * ndtri(parts))


@dataclass(frozen=True)
class HalfNormal(SquarePrior):
    """Distribution of ``|x|`` where x is normal with mean 0: for a parameter that is not negative and probably small.

    Parameters
    ----------
    deviation : float
        Of x, in SI units.

    Examples
    --------
    >>> HalfNormal(2.0).cumulative(2.0).round(4).item()
    0.6827
    """

    name: ClassVar[str] = "half-normal"
    deviation: float
    kind: str = field(default="half-normal", init=False, repr=False)

    def _mistakes(self) -> Iterator[str]:
        yield from positive(deviation=self.deviation)

    def mistake_within(self, lower: float, upper: float) -> str:
        if lower < 0:
            return f"its prior is half-normal, but its lower bound is {lower:g}. Raise the bound to 0 or more"
        return super().mistake_within(lower, upper)

    def residual(self, values: ArrayLike) -> np.ndarray:
        return np.asarray(values) / self.deviation

    def residual_slope(self, values: ArrayLike) -> np.ndarray:
        return np.full(np.shape(values), 1 / self.deviation)

    @property
    def spread(self) -> float:
        return self.deviation * float(np.sqrt(1 - 2 / np.pi))

    def log_density(self, values: ArrayLike) -> np.ndarray:
        density = -0.5 * self.residual(values) ** 2 - np.log(self.deviation * np.sqrt(np.pi / 2))
        return np.where(np.asarray(values) >= 0, density, -np.inf)

    def slope(self, values: ArrayLike) -> np.ndarray:
        return -self.residual(values) / self.deviation

    def cumulative(self, values: ArrayLike) -> np.ndarray:
        from scipy.special import log_ndtr  # parameters are imported without SciPy

        return -np.expm1(np.log(2) + log_ndtr(-np.maximum(self.residual(values), 0)))

    def quantile(self, parts: ArrayLike) -> np.ndarray:
        from scipy.special import ndtri  # parameters are imported without SciPy

        return -self.deviation * ndtri((1 - np.asarray(parts)) / 2)
