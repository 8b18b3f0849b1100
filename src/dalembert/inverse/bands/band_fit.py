"""The result of an identification from bands."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np

from dalembert.findings import Finding
from dalembert.inverse.events import SearchIteration, StartEnd
from dalembert.inverse.fit.starts_table import starts_table
from dalembert.inverse.fit.stored_data import StoredBands
from dalembert.inverse.fit.stored_search import History, Starts
from dalembert.inverse.least_squares.estimate import Estimate, Identifiability
from dalembert.inverse.least_squares.identifiable import unidentifiable
from dalembert.parameter import Parameter
from dalembert.quantities import unit
from dalembert.results import EndedResult
from dalembert.stored_fields import Labels, OptionalTable, Over, StoredBox, StoredParameters, Table
from dalembert.tables import Table as ResultTable
from dalembert.tables import cell, cells, counted, few_values, interval, labelled, marks, noted, shown

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
    TITLE: ClassVar[str] = "Identified intervals"
    VERDICTS: ClassVar[tuple[str, str]] = ("identified", "not identified")

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

    @property
    def reproduced(self) -> dict[str, np.ndarray]:
        """Lower and upper bounds (samples, channels) as true runs give them, or the surrogate where there were none."""
        return {
            "lower": self.lower if self.checked_lower is None else self.checked_lower,
            "upper": self.upper if self.checked_upper is None else self.checked_upper,
        }

    def key_values(self) -> dict[str, str]:
        return few_values(self.parameters, map(interval, self.box.lower, self.box.upper))

    def facts(self) -> dict[str, str]:
        checked = self.checked_misfit
        return {
            "method": self.method,
            "misfit": shown(self.misfit, digits=3),
            **({} if checked is None else {"misfit by true runs": shown(checked, digits=3)}),
            "fitted bounds": counted(2 * self.lower.size),
            "simulations": counted(self.simulations),
            "time": f"{shown(self.seconds, digits=3)} s",
        }

    def tables(self, truth: Mapping[str, tuple[float, float]] | None = None) -> tuple[ResultTable, ...]:
        """Return the intervals, beside true ones if these are given, the residuals of the bounds, and the starts."""
        known = truth or {}
        true = {
            f"true {side}": [known.get(name, (np.nan, np.nan))[end] for name in self.parameters.names]
            for end, side in enumerate(("lower", "upper"))
        }
        columns = {
            "parameter": self.parameters.names,
            "lower": self.box.lower,
            "upper": self.box.upper,
            **(true if truth else {}),
            "middle": map(cell, self.middle, self.middle_deviations),
            "deviation of the middle": cells(self.middle_deviations, 2),
            "radius": map(cell, self.radius, self.radius_deviations),
            "deviation of the radius": cells(self.radius_deviations, 2),
            "unit": [item.unit for item in self.parameters],
            "lower bound": [float(item.lower) for item in self.parameters],
            "upper bound": [float(item.upper) for item in self.parameters],
            "note": marks(self._note(k, item) for k, item in enumerate(self.parameters)),
        }
        intervals = ResultTable.of("intervals", "Identified intervals", columns)
        starts = [starts_table(self.starts, self.unknowns)] if self.starts else []
        return noted(intervals), self._residuals(), *starts

    def _note(self, k: int, item: Parameter) -> str:
        """Return whether an interval is a single number, as far as the bands show."""
        if item.name not in self.intervals:
            return "given number"
        if self.radius[k] <= ZERO * (item.upper - item.lower):
            return "a single number"
        return "possibly a single number" if self.radius[k] <= 2 * self.radius_deviations[k] else ""

    def _residuals(self) -> ResultTable:
        bands, rows = self.bands, []
        for column, channel in enumerate(bands.channels):
            for side, values in self.reproduced.items():
                residual = np.abs(values[:, column] - getattr(bands, side)[:, column])
                sizes = cells((np.sqrt(np.mean(residual**2)), residual.max()), 3)
                rows.append((channel, side, *sizes, bands.coordinate.values[residual.argmax()], unit(channel)))
        at = labelled(f"largest at {bands.coordinate.name}", bands.coordinate.unit)
        names = ("channel", "bound", "rms residual", "largest residual", at, "unit")
        return noted(ResultTable.of_rows("band-residuals", "Residuals of the bounds", names, rows))


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
