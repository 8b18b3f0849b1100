"""Independent random inputs of a model: each in an interval, uniform or by a distribution."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.polynomial.legendre import leggauss

from dalembert.errors import InputError, shown
from dalembert.forward import ForwardModel
from dalembert.intervals import Box, Interval
from dalembert.latin_hypercube import latin_hypercube
from dalembert.parameter import Parameter
from dalembert.priors import CorrelatedNormal, Prior
from dalembert.priors.prior import LEAST
from dalembert.surrogate.orthonormal import Rule, uniform
from dalembert.uncertainty.propagate import box_of
from dalembert.uncertainty.tails import lost_variance

TAIL = 1e-5  # probability that is cut off at an end of a distribution that is not bounded there
# Parts of equal probability in which a density is integrated, and nodes in each, beside half the degree.
PANELS, NODES = 10, 24
Distributions = Box | Mapping[str, Interval | tuple[float, float] | float | Prior | CorrelatedNormal]


@dataclass(frozen=True, eq=False)
class Inputs:
    """Independent random inputs."""

    box: Box  # interval of each input. Distributions are truncated by it.
    priors: tuple[Prior | None, ...]  # of length d: None for an input that is uniform
    lost: tuple[float, ...]  # of length d: part of the variance of each input that lies in the tails that are cut off

    @property
    def texts(self) -> tuple[str, ...]:
        """Each distribution in words, such as ``"uniform"`` or ``"Normal(mean=1.0, deviation=0.1)"``."""
        return tuple("uniform" if prior is None else repr(prior) for prior in self.priors)

    @property
    def rules(self) -> list[Rule]:
        """Integrals over each distribution, in coordinates of [−1, 1]."""
        return [
            uniform if prior is None else _rule(prior, self.box.lower[k], self.box.upper[k])
            for k, prior in enumerate(self.priors)
        ]

    def points(self, parts: np.ndarray) -> np.ndarray:
        """Points (n, d) at which the distribution functions have values ``parts`` (n, d) in [0, 1]."""
        # The quantile function maps uniform probabilities to the distribution, truncated by the interval.
        points = self.box.points(2 * parts - 1)
        for k, prior in enumerate(self.priors):
            if prior is not None:
                points[:, k] = prior.within(parts[:, k], self.box.lower[k], self.box.upper[k])
        return points

    def random(self, count: int, rng: np.random.Generator) -> np.ndarray:
        """Points (count, d) of the distributions, a Latin hypercube of probabilities."""
        return self.points(latin_hypercube(len(self.box), count, rng))

    def eta(self, points: np.ndarray) -> np.ndarray:
        """Coordinates in [−1, 1] of points; 0 in an interval without width."""
        radius = self.box.radius
        return (points - self.box.middle) / np.where(radius > 0, radius, 1.0)


def inputs_of(model: ForwardModel, distributions: Distributions | None, method: str) -> Inputs:
    """Return the inputs of a model, in its order. ``distributions``: of each parameter an interval, within which it is
    uniform, or a distribution, which the bounds of the parameter truncate. If not given, the priors of the parameters;
    without prior a parameter is uniform between its bounds. ``method``: named in errors.
    """
    items = {item.name: item for item in model.parameters}
    if distributions is None:
        distributions = completed({}, model, method)
    if not isinstance(distributions, Mapping):
        box = box_of(model, distributions)
        return Inputs(box, (None,) * len(box), (0.0,) * len(box))
    for name, entry in distributions.items():
        if isinstance(entry, CorrelatedNormal):
            raise _correlated(method, name)
    priors = {name: entry for name, entry in distributions.items() if isinstance(entry, Prior) and name in items}
    ends = {name: _ends(prior, items[name], method) for name, prior in priors.items()}
    box = box_of(model, {name: ends.get(name, entry) for name, entry in distributions.items()})  # type: ignore[arg-type]
    lost = {
        name: lost_variance(prior, ends[name], (items[name].lower, items[name].upper)) for name, prior in priors.items()
    }
    return Inputs(box, tuple(priors.get(name) for name in box.names), tuple(lost.get(name, 0.0) for name in box.names))


def completed(distributions: Mapping[str, Interval | Prior], model: ForwardModel, method: str) -> dict[str, Any]:
    """Return an entry for each parameter of a model: the one that is given, else its prior, else its bounds."""
    return {
        item.name: distributions[item.name] if item.name in distributions else _known(item, method)
        for item in model.parameters
    }


def _known(item: Parameter, method: str) -> Prior | tuple[float, float]:
    if isinstance(item.prior, CorrelatedNormal):
        raise _correlated(method, item.name)
    return (item.lower, item.upper) if item.prior is None and item.deviation is None else item.distribution


def _correlated(method: str, name: str) -> InputError:
    return InputError(
        f"{method}: the distribution of {name!r} is correlated with others, and indices of correlated parameters are "
        "not defined. Use an interval or a distribution of it alone in intervals."
    )


def _ends(prior: Prior, item: Parameter, method: str) -> tuple[float, float]:
    """Interval of a parameter: its bounds, or where the distribution almost ends if that is narrower."""
    inside = float(prior.cumulative(item.upper) - prior.cumulative(item.lower))
    if not inside >= LEAST:
        raise InputError(
            f"{method}: the distribution of {item.name!r}, {shown(prior)}, has the probability {inside:.1g} between "
            f"the bounds of the parameter ({item.lower:g}, {item.upper:g}). Correct the distribution or the bounds."
        )
    # An end in the tails keeps the interval finite. `lost_variance` measures what is cut off.
    lower, upper = (_end(prior, part) for part in (0.0, 1.0))
    return max(item.lower, lower), min(item.upper, upper)


def _end(prior: Prior, part: float) -> float:
    """End of a distribution, or where less than TAIL is left beyond it if its density is not positive at the end."""
    with np.errstate(divide="ignore", invalid="ignore"):
        end = float(prior.quantile(part))
        sharp = np.isfinite(end) and np.isfinite(prior.log_density(end))
    return end if sharp else float(prior.quantile(abs(part - TAIL)))


def _rule(prior: Prior, lower: float, upper: float) -> Rule:
    """Gauss and Legendre's rule in each of several parts of equal probability, with the density as a weight."""
    # Panels of equal probability are narrow where the density varies most.
    knots = np.unique([lower, *prior.within(np.arange(1, PANELS) / PANELS, lower, upper), upper])
    half, middle = np.diff(knots) / 2, (knots[1:] + knots[:-1]) / 2

    def rule(degree: int) -> tuple[np.ndarray, np.ndarray]:
        # n nodes are exact up to the degree 2 n - 1: that of the polynomial, and at least 46 more for the density.
        nodes, weights = leggauss(degree // 2 + NODES)
        points = middle[:, None] + half[:, None] * nodes
        density = half[:, None] * weights * np.exp(prior.log_density(points))
        # The sum of the weights is one, which also norms the truncated density.
        return ((2 * points - lower - upper) / (upper - lower)).ravel(), density.ravel() / density.sum()

    return rule


def described(inputs: Inputs) -> Iterator[tuple[str, list[float] | str]]:
    """Yield the name of each input with its ends, and its distribution where it is not uniform."""
    for (name, interval), prior in zip(inputs.box.items(), inputs.priors, strict=True):
        yield name, [interval.lower, interval.upper] if prior is None else f"{prior!r} in {interval}"
