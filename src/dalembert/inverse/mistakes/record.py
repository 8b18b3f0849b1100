"""A fit with its data, as hypotheses about mistakes in the data see it."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from dalembert.findings import Finding
from dalembert.inverse.correlation.series import Series, series_of
from dalembert.inverse.problem.problem import Linearisation, Problem

TIME = "s"


@dataclass(frozen=True, eq=False)
class FittedRecord:
    """Data, and the response of the model that was fitted to them.

    Parameters
    ----------
    problem : Problem
    at : Linearisation
        At the identified values.
    known : bool
        Whether the variance of a weighted residual is known to be 1.
    """

    problem: Problem
    at: Linearisation
    known: bool

    @cached_property
    def series(self) -> tuple[Series, ...]:
        """Each channel of each experiment, with its fitted values."""
        return tuple(series_of(self.problem))

    @cached_property
    def experiments(self) -> dict[str, tuple[Series, ...]]:
        """The series of each experiment; the name of a single one is empty."""
        names = dict.fromkeys(own.experiment for own in self.series)
        return {name: tuple(own for own in self.series if own.experiment == name) for name in names}

    @cached_property
    def residual(self) -> np.ndarray:
        """W^½ (R − data), shape (values,), flat from (samples, channels)."""
        return (np.sqrt(self.problem.weights) * self.problem.misfit(self.at.response)).ravel()

    def data_of(self, own: Series) -> np.ndarray:
        """Data of a series (values,), without jumps by whole turns."""
        return self.problem.data.continuous.ravel()[own.rows]

    def response_of(self, own: Series) -> np.ndarray:
        """Response of a series (values,)."""
        return self.at.response.ravel()[own.rows]


@dataclass(frozen=True)
class Verdict:
    """What a mistake explains.

    Parameters
    ----------
    number : float
        The number that describes the mistake; NaN if it has none.
    explained : float
        Part of the squares of all residuals that it takes away, if the parameters are identified with it.
    """

    number: float
    explained: float

    @property
    def sentence(self) -> str:
        """How much it explains."""
        return f"This explains {100 * self.explained:.3g} % of the squares of all residuals."


@dataclass(frozen=True, eq=False)
class Mistake:
    """A mistake that a record may have.

    Parameters
    ----------
    shown : callable
        From a response flat over (samples × channels, ...) and a number to what a record with this mistake shows of it;
        NaN where that is not known.
    finding : callable
        From the verdict to the finding.
    numbers : array, shape (numbers,)
        Numbers to try, evenly spaced; a single NaN if the mistake has none.
    blamed : array of int
        Values that it leaves out because they are wrong; other values that it leaves out are only unknown.
    least : float
        Smallest size of the number at which the mistake is reported; smaller ones have another finding.
    visible : bool
        Whether the data alone show it, so that it is tested though the residuals look like noise.
    """

    shown: Callable[[np.ndarray, float], np.ndarray]
    finding: Callable[[Verdict], Finding]
    numbers: np.ndarray
    blamed: np.ndarray = field(default_factory=lambda: np.zeros(0, dtype=int))
    least: float = 0.0
    visible: bool = False


NONE = np.array([np.nan])
"""Numbers of a mistake that has none."""


def without(rows: np.ndarray, response: np.ndarray, _: float) -> np.ndarray:
    """Return a response (values, ...) of which some rows are not known."""
    shown = response.copy()
    shown[rows] = np.nan
    return shown
