"""The result of an identification from bands."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from dalembert.contents import Contents
from dalembert.data import Bands
from dalembert.findings import Finding
from dalembert.intervals import Box
from dalembert.inverse.events import StartEnd, Step
from dalembert.inverse.fit.doubts import doubts
from dalembert.inverse.least_squares.estimate import Estimate, Identifiability
from dalembert.parameters import Parameters
from dalembert.results import Result


@dataclass(frozen=True, eq=False)
class BandFit(Result):
    """Intervals of parameters whose response fills given bands, how well they are known, and how they were found.

    The unknowns are the middles of all parameters, then the radii of those that are intervals.

    Parameters
    ----------
    parameters : Parameters
    intervals : tuple of str
        Parameters with an unknown radius; the others are numbers, their radius is zero.
    box : Box
        The identified intervals.
    unknowns : tuple of str
        For example ``("theta1 middle", "theta2 middle", "theta1 radius")``.
    middle_deviations, radius_deviations : array, shape (parameters,)
        Standard deviations from the variance of the residuals; zero for a radius that is not unknown, NaN where they
        could not be computed.
    correlation : array, shape (unknowns, unknowns)
    singular_values : array, shape (unknowns,)
        Of W^½ ∂(lower, upper)/∂unknown · scale, largest first.
    directions : array, shape (unknowns, unknowns)
        A row a singular value: the combination of unknown/scale that it belongs to.
    fitness : float
        Σ W ((lower − given lower)² + (upper − given upper)²) over samples and channels.
    bands : Bands
        The given ones.
    weights : array, shape (samples, channels)
        W.
    lower, upper : array, shape (samples, channels)
        Bounds of the surrogate over ``box``.
    error : array, shape (samples, channels)
        Estimate of the surrogate's largest error.
    checked_lower, checked_upper : array, shape (samples, channels)
        Least and largest response of true runs at the points where the surrogate has its bounds; None if no run was
        made there, or every one failed.
    checked_fitness : float
        The fitness of these; None without them.
    history : tuple of Step
        Best fitness along each start; its values are the unknowns.
    starts : tuple of StartEnd
    success : bool
    status : str
        How it went and what to do, in full sentences.
    method : str
    simulations : int
    seconds : float
        Spent on the whole identification.
    provenance : mapping
        Versions, seed, hashes of model and data, method and settings.
    findings : tuple of Finding
        What the method concludes about the result.
    """

    FORMAT: ClassVar[str] = "dalembert bandfit 1"

    parameters: Parameters
    intervals: tuple[str, ...]
    box: Box
    unknowns: tuple[str, ...]
    middle_deviations: np.ndarray
    radius_deviations: np.ndarray
    correlation: np.ndarray
    singular_values: np.ndarray
    directions: np.ndarray
    fitness: float
    bands: Bands
    weights: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    error: np.ndarray
    checked_lower: np.ndarray | None
    checked_upper: np.ndarray | None
    checked_fitness: float | None
    history: tuple[Step, ...]
    starts: tuple[StartEnd, ...]
    success: bool
    status: str
    method: str
    simulations: int
    seconds: float
    provenance: Mapping[str, Any]
    findings: tuple[Finding, ...] = ()

    @property
    def middle(self) -> np.ndarray:
        """Middles of the intervals, shape (parameters,)."""
        return self.box.middle

    @property
    def radius(self) -> np.ndarray:
        """Radii of the intervals, shape (parameters,)."""
        return self.box.radius

    @property
    def estimates(self) -> dict[str, float]:
        """Ends of the intervals by name, for example ``{"theta1 lower": 0.7, "theta1 upper": 0.8}``."""
        sides = {"lower": self.box.lower, "upper": self.box.upper}
        return {f"{name} {side}": float(sides[side][k]) for k, name in enumerate(self.box) for side in sides}

    @property
    def told(self) -> Estimate:
        """What the bands tell about the unknowns."""
        is_interval = [name in self.intervals for name in self.parameters.names]
        deviations = np.concatenate([self.middle_deviations, self.radius_deviations[is_interval]])
        return Estimate(deviations, self.correlation, self.singular_values, self.directions)

    def identifiability(self) -> Identifiability:
        """What the bands can tell: singular values, combinations, and sentences on what they cannot."""
        from dalembert.inverse.bands.telling import sentences

        return Identifiability(self.singular_values, self.directions, sentences(self))

    @property
    def doubts(self) -> tuple[str, ...]:
        """Why the intervals are to be doubted although the search ended well, each reason in a few words."""
        return (*doubts(self.status, self.identifiability()), *super().doubts)

    def summary(self) -> str:
        """The result as a text table with its status."""
        from dalembert.inverse.bands.summary import summary

        return summary(self)

    def contents(self) -> Contents:
        from dalembert.inverse.bands.storage import contents_of

        return contents_of(self)

    @classmethod
    def from_xarray(cls, dataset: Any) -> "BandFit":
        """The result that :meth:`to_xarray` turned into a dataset."""
        from dalembert.inverse.bands.storage import from_xarray

        return from_xarray(dataset)
