"""The result of an identification from bands."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np

from dalembert.findings import Finding
from dalembert.inverse.events import SearchIteration, StartEnd
from dalembert.inverse.fit.stored_data import StoredBands
from dalembert.inverse.fit.stored_search import History, Starts
from dalembert.inverse.least_squares.estimate import Estimate, Identifiability
from dalembert.inverse.least_squares.identifiable import unidentifiable
from dalembert.parameters import Parameter
from dalembert.results import EndedResult, fact_lines, fixed_lines, text_table
from dalembert.stored_fields import Labels, OptionalTable, Over, StoredBox, StoredParameters, Table

ZERO = 1e-6  # lengths below this part of the bounds' width are zero
ADVICE = "Identify it as a number without a radius, or give bands of a quantity that depends more on it."


@dataclass(frozen=True, eq=False)
class BandFit(EndedResult):
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
    misfit : float
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
        Least and largest response of true runs at the points where the surrogate has its minima and maxima; None if
        no run was made there, or every one failed.
    checked_misfit : float
        The misfit of these; None without them.
    history : tuple of SearchIteration
        Best misfit along each start; its values are the unknowns.
    starts : tuple of StartEnd
    success : bool
    outcome : tuple of Finding
        How the search ended; ``status`` is their text.
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

    parameters: StoredParameters
    intervals: tuple[str, ...]
    box: StoredBox
    unknowns: Annotated[tuple[str, ...], Labels("unknown")]
    middle_deviations: Annotated[np.ndarray, Over("parameter")]
    radius_deviations: Annotated[np.ndarray, Over("parameter")]
    correlation: Annotated[np.ndarray, Over("unknown", "unknown_")]
    singular_values: Annotated[np.ndarray, Over("combination")]
    directions: Annotated[np.ndarray, Over("combination", "unknown")]
    misfit: float
    bands: StoredBands
    weights: Table
    lower: Table
    upper: Table
    error: Table
    checked_lower: OptionalTable
    checked_upper: OptionalTable
    checked_misfit: float | None
    history: Annotated[tuple[SearchIteration, ...], History("unknown")]
    starts: Annotated[tuple[StartEnd, ...], Starts("unknown")]
    success: bool
    outcome: tuple[Finding, ...]
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
    def estimate(self) -> Estimate:
        """Standard deviations and correlation of the unknowns."""
        is_interval = [name in self.intervals for name in self.parameters.names]
        deviations = np.concatenate([self.middle_deviations, self.radius_deviations[is_interval]])
        return Estimate(deviations, self.correlation, self.singular_values, self.directions)

    def identifiability(self) -> Identifiability:
        """What the bands can identify: singular values, combinations, and findings on what they cannot."""
        return Identifiability(self.singular_values, self.directions, tuple(_identifiability(self)))

    @property
    def conclusions(self) -> tuple[Finding, ...]:
        """How the search ended, what the bands cannot identify, and what else the method concludes."""
        return (*self.outcome, *self.identifiability().findings, *self.findings)

    def summary(self) -> str:
        """Return a table of intervals with middles, radii, deviations and bounds, then effort and findings."""
        rows: list[tuple[str, ...]] = [("parameter", "interval", "middle", "±", "radius", "±", "unit", "bounds")]
        for k, item in enumerate(self.parameters):
            known = item.name in self.intervals
            rows.append(
                (
                    item.name,
                    f"[{self.box.lower[k]:.7g}, {self.box.upper[k]:.7g}]",
                    f"{self.middle[k]:.7g}",
                    f"{self.middle_deviations[k]:.2g}",
                    f"{self.radius[k]:.5g}" if known else "0 (given)",
                    f"{self.radius_deviations[k]:.2g}" if known else "",
                    item.unit,
                    f"{item.lower:.6g} to {item.upper:.6g}",
                )
            )
        checked = "not checked" if self.checked_misfit is None else f"{self.checked_misfit:.6g} by true runs"
        facts = [
            *fact_lines(
                method=self.method,
                misfit=f"{self.misfit:.6g} (weighted sum of squares of {2 * self.lower.size} bounds), {checked}",
                simulations=self.simulations,
                seconds=f"{self.seconds:.2g}",
                starts=len(self.starts),
            ),
            *fixed_lines(self),
        ]
        findings = map(str, (*self.identifiability().findings, *self.findings))
        return "\n".join([*text_table(rows), "", *facts, "", self.status, *findings])


def _identifiability(fit: BandFit) -> Iterator[Finding]:
    """Yield findings on ends at a bound, radii that may be zero, and unknowns that the bands do not identify."""
    for k, item in enumerate(fit.parameters):
        yield from _of_one(fit, k, item)
    width, scale = fit.parameters.upper - fit.parameters.lower, fit.parameters.scale
    is_interval = np.array([name in fit.intervals for name in fit.parameters.names], dtype=bool)
    widths, scales = np.concatenate([width, width[is_interval] / 2]), np.concatenate([scale, scale[is_interval]])
    yield from unidentifiable(fit.unknowns, widths, scales, fit.estimate)


def _of_one(fit: BandFit, k: int, item: Parameter) -> Iterator[Finding]:
    small = ZERO * (item.upper - item.lower)
    radius, deviation = float(fit.radius[k]), float(fit.radius_deviations[k])
    for side, end in (("lower", fit.box.lower[k]), ("upper", fit.box.upper[k])):
        bound = getattr(item, side)
        if abs(end - bound) <= small:
            yield Finding(
                "interval-at-bound",
                "warning",
                {"parameter": item.name, "side": side, "bound": float(bound)},
                f"The {side} end of {item.name!r} is at its bound {bound:.6g}.",
                "Widen the bound if the true interval may reach beyond it.",
            )
    if item.name not in fit.intervals:
        return
    values = {"parameter": item.name, "radius": radius, "deviation": deviation}
    if radius <= small:
        message = f"The radius of {item.name!r} is zero: one value of it explains the bands."
        yield Finding("zero-radius", "warning", values, message, ADVICE)
    elif radius <= 2 * deviation < np.inf:
        message = (
            f"The radius of {item.name!r}, {radius:.2g} ± {deviation:.2g}, does not differ significantly from zero: "
            "the bands do not show that it varies."
        )
        yield Finding("zero-radius", "warning", values, message, ADVICE)
