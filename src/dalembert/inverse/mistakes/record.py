"""A fit with its data, as hypotheses about mistakes in the data see it."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from dalembert.findings import Finding
from dalembert.inverse.noise.correlation.series import Series, series_of
from dalembert.inverse.problem.problem import Linearisation, MisfitProblem

TIME = "s"

RANKED = 4000
"""Most values by which mistakes are ranked: the standard deviation of their mean square is 2 % of it."""

GOLDEN = (5**0.5 - 1) / 2


@dataclass(frozen=True, eq=False)
class FittedRecord:
    """Data, and the response of the model that was fitted to them."""

    problem: MisfitProblem
    at: Linearisation  # at the identified values
    known: bool  # whether the variance of a weighted residual is known to be 1

    @cached_property
    def series(self) -> tuple[Series, ...]:
        """Each channel of each experiment, with its fitted values."""
        return tuple(series_of(self.problem))

    @cached_property
    def experiments(self) -> dict[str, tuple[Series, ...]]:
        """The series of each experiment; the name of a single one is empty."""
        names = dict.fromkeys(signal.experiment for signal in self.series)
        return {name: tuple(signal for signal in self.series if signal.experiment == name) for name in names}

    @cached_property
    def residual(self) -> np.ndarray:
        """W^½ (R − data), shape (values,), flat from (samples, channels)."""
        return (np.sqrt(self.problem.weights) * self.problem.unweighted_residual(self.at.response)).ravel()

    @cached_property
    def ranked(self) -> np.ndarray:
        """Values by which mistakes are ranked: all fitted ones, or of many some, at distances that do not repeat.

        Multiples of the golden ratio modulo 1 spread evenly, and no period of the record is a multiple of theirs.
        """
        fitted = np.flatnonzero(self.problem.weights > 0)
        if len(fitted) <= RANKED:
            return fitted
        stride = len(fitted) / RANKED
        number = np.arange(RANKED)
        return fitted[(stride * (number + (GOLDEN * number) % 1)).astype(int)]

    def compared(self, shown: np.ndarray, rows: np.ndarray) -> np.ndarray:
        """Return weighted residuals W^½ (R − data) of a response (rows,) at some of the values."""
        data = self.problem.data
        apart = shown - data.values.ravel()[rows]
        if data.wraps:
            wraps = data.wrapping[rows % data.values.shape[1]]
            apart = np.where(wraps, apart - 2 * np.pi * np.rint(apart / (2 * np.pi)), apart)
        return np.sqrt(self.problem.weights.ravel()[rows]) * apart

    def data_of(self, signal: Series) -> np.ndarray:
        """Data of a series (values,), without jumps by whole turns."""
        return self.problem.data.continuous.ravel()[signal.rows]

    def response_of(self, signal: Series) -> np.ndarray:
        """Response of a series (values,)."""
        return self.at.response.ravel()[signal.rows]


@dataclass(frozen=True)
class Verdict:
    """What a mistake explains."""

    number: float  # the number that describes the mistake; NaN if it has none
    # explained: part of the squares of all residuals that it takes away, if the parameters are identified with it
    explained: float

    @property
    def sentence(self) -> str:
        """How much it explains."""
        return f"This explains {100 * self.explained:.3g} % of the squares of all residuals."


@dataclass(frozen=True, eq=False)
class Mistake:
    """A mistake that a record may have."""

    # shown: from a response flat over (samples × channels, ...) and a number to what a record with this mistake shows
    # of it; NaN where that is not known
    shown: Callable[[np.ndarray, float], np.ndarray]
    finding: Callable[[Verdict], Finding]  # from the verdict to the finding
    numbers: np.ndarray  # (numbers,): numbers to try, evenly spaced; a single NaN if the mistake has none
    # blamed: values that it leaves out because they are wrong; other values that it leaves out are only unknown
    blamed: np.ndarray = field(default_factory=lambda: np.zeros(0, dtype=int))
    # least: smallest size of the number at which the mistake is reported; smaller ones have another finding
    least: float = 0.0
    visible: bool = False  # whether the data alone show it, so that it is tested though the residuals look like noise
    # shown_at: from these and some rows to the same at these rows, where that is faster
    shown_at: Callable[[np.ndarray, float, np.ndarray], np.ndarray] | None = None


NONE = np.array([np.nan])
"""Numbers of a mistake that has none."""


def without(rows: np.ndarray, response: np.ndarray, _: float) -> np.ndarray:
    """Return a response (values, ...) of which some rows are not known."""
    shown = response.copy()
    shown[rows] = np.nan
    return shown
