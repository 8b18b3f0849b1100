"""One parameter: its bounds, first guess, scale, unit and prior."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dalembert.arguments import is_real
from dalembert.errors import InputError, shown
from dalembert.priors import AnyPrior, CorrelatedNormal, Normal, Prior, Uniform, prior_of


@dataclass(frozen=True)
class Parameter:
    """One uncertain number of a model.

    Parameters
    ----------
    name : str
    lower, upper : float
        Bounds, in SI units, ``lower <= upper``. A parameter with equal bounds is fixed: the model uses its value, and
        no method varies it.
    unit : str
        Unit symbol for labels, for example ``"Pa"``.
    scale : float, optional
        Typical size; the larger absolute bound if not given.
    start : float, optional
        First guess; the middle of the bounds if not given.
    log : bool, optional
        Whether the identification searches its logarithm, so that factors count and not differences. If not given:
        where both bounds are positive and more than a decade apart.
    deviation : float, optional
        What is known before any data: the standard deviation of the true value around ``start``. It enters an
        identification as one more measurement; the data then need deviations too. Short for a normal ``prior``
        around ``start``.
    prior : Normal, LogNormal, HalfNormal, Uniform, LogUniform or CorrelatedNormal, optional
        What is known before any data, truncated by the bounds; uniform within them if not given. A mapping with its
        ``kind`` and its arguments is accepted, too.
    """

    name: str
    lower: float
    upper: float
    unit: str = ""
    scale: float | None = None
    start: float | None = None
    log: bool | None = None
    deviation: float | None = None
    prior: AnyPrior | None = None

    def __post_init__(self) -> None:
        if not isinstance(self.name, str):
            raise InputError(f"parameter: name is {shown(self.name)}; expected a text")
        if isinstance(self.prior, Mapping):  # as files hold it
            object.__setattr__(self, "prior", prior_of(self.prior))
        for mistake in self._mistakes():
            raise InputError(f"parameter {self.name!r}: {mistake}")

    def _mistakes(self) -> Iterator[str]:
        for what in ("lower", "upper", "scale", "start", "deviation"):
            value = getattr(self, what)
            if not is_real(value) and (value is not None or what in ("lower", "upper")):
                yield f"{what} is {shown(value)}; expected a number"
        if not isinstance(self.unit, str):
            yield f"unit is {shown(self.unit)}; expected a text such as 'Pa'"
        if not isinstance(self.log, bool | np.bool_ | None):
            yield f"log is {shown(self.log)}; expected True, False or None"
        bounds = f"({self.lower}, {self.upper})"
        if not (np.isfinite(self.lower) and np.isfinite(self.upper) and self.lower <= self.upper):
            yield f"bounds are {bounds}; expected two finite numbers, the lower one first"
        if self.scale is not None and not 0 < self.scale < np.inf:
            yield f"scale is {self.scale}; expected a positive number"
        if self.start is not None and not self.lower <= self.start <= self.upper:
            yield f"start {self.start} lies outside its bounds {bounds}; widen the bounds or move the start"
        if self.deviation is not None and not (np.isfinite(self.deviation) and self.deviation > 0):
            yield (
                f"deviation is {self.deviation}; expected a positive number, the standard deviation of what is known "
                "of it before any data"
            )
        if self.is_fixed and self.deviation is not None:
            yield (
                f"both bounds are {self.lower}, so it is fixed and has no deviation; give bounds that differ, or leave "
                "the deviation out"
            )
        if self.log and not self.lower > 0:
            yield (
                f"its logarithm is to be searched, but its lower bound is {self.lower}; expected a positive one; raise "
                "the bound or leave log out"
            )

        yield from self._prior_mistakes()

    def _prior_mistakes(self) -> Iterator[str]:
        if self.prior is None:
            return
        if not isinstance(self.prior, AnyPrior):
            yield f"prior is {shown(self.prior)}; expected a prior such as Normal(mean, deviation)"
        elif self.deviation is not None:
            yield "it has a deviation and a prior, which both say what is known of it; leave one of them out"
        elif self.is_fixed:
            yield f"both bounds are {self.lower}, so it is fixed and has no prior; leave the prior out"
        elif isinstance(self.prior, CorrelatedNormal) and self.name not in self.prior.names:
            yield f"its prior is that of {', '.join(self.prior.names)}; expected its name among them"
        elif mistake := self.distribution.mistake_within(self.lower, self.upper):
            yield mistake

    @cached_property
    def distribution(self) -> Prior:
        """Prior distribution of it alone: as declared, else uniform within the bounds."""
        if isinstance(self.prior, CorrelatedNormal):
            return self.prior.marginal(self.name)
        if self.prior is not None:
            return self.prior
        if self.deviation is not None:
            start = (self.lower + self.upper) / 2 if self.start is None else self.start
            return Normal(float(start), float(self.deviation))
        return Uniform(float(self.lower), float(self.upper))

    @property
    def is_fixed(self) -> bool:
        """Whether both bounds are equal, so that the value is known exactly."""
        return self.lower == self.upper

    @property
    def logarithmic(self) -> bool:
        """Whether its logarithm is searched: as ``log`` says, or for positive bounds more than a decade apart."""
        return self.log if self.log is not None else 0 < 10 * self.lower < self.upper
