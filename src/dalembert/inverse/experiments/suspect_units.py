"""Channels whose data are suspected to be in another unit than the response."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import islice

import numpy as np

from dalembert.data import Measurements
from dalembert.findings import Finding
from dalembert.forward import ForwardModel
from dalembert.inverse.experiments.explained import GOOD, explained
from dalembert.inverse.experiments.without_outliers import without_outliers
from dalembert.inverse.least_squares.descent import End, refine
from dalembert.inverse.noise.correlation.series import Series, series_of
from dalembert.inverse.problem.journal import Journal
from dalembert.inverse.problem.problem import MisfitProblem, pose
from dalembert.optimize import LeastSquares

PREFIX, ANGLE = 1e3, 180 / np.pi
"""Usual factors between units: a metric prefix, such as mm and m, and degrees for radians."""

TOLERATED = {PREFIX: 4.0, 1 / PREFIX: 4.0, ANGLE: 3.0, 1 / ANGLE: 3.0}
"""Largest quotient of a ratio and a factor, either way, at which the factor is suspected."""

FLAT = 1e-9
"""Range of a channel, as a part of its largest value, below which it is constant but for rounding."""

FITTED = LeastSquares(trials=25)
"""Descent to data in another unit."""

ROUGH = 1.5
"""Mean square of successive differences over the variance from which data are mostly noise: white noise has 2."""


@dataclass(frozen=True)
class SuspectUnit:
    """A channel whose data vary by a usual factor more, or less, than the response.

    Parameters
    ----------
    channel : str
    factor : float
        About what the ratio is: 1000, 57.3, or the inverse of one of them.
    ratio : float
        Range of the data over that of the response.
    """

    channel: str
    factor: float
    ratio: float

    @property
    def question(self) -> str:
        """What may be wrong, as a question."""
        if self.factor in (PREFIX, 1 / PREFIX):
            return "Is a metric prefix wrong, such as mm for m?"
        return "Are the data in degrees?" if self.factor > 1 else "Were data in radians converted from degrees?"


def suspect_units(problem: MisfitProblem, response: np.ndarray) -> tuple[SuspectUnit, ...]:
    """Return the channels whose ranges differ by a usual factor from those of a response (samples, channels).

    Channels that are constant but for rounding, and data that are mostly noise, are not judged.
    """
    units = {channel.name: channel.unit for channel in problem.model.channels}
    found = []
    for series in series_of(problem):
        ratio = _ratio(problem, response, series)
        factors = (factor for factor in _factors(units.get(series.name, "")) if _like(ratio, factor))
        found += [SuspectUnit(series.name, factor, ratio) for factor in islice(factors, 1)]
    return tuple(found)


def unit_findings(problem: MisfitProblem, vector: np.ndarray, response: np.ndarray) -> Iterator[Finding]:
    """Yield the units that the first response of a fit makes suspect, if another unit explains the data.

    A unit is wrong if the response explains a channel badly, and explains it and the suspected one where the model is
    fitted to the data in the other unit, from the same starts. Where the response explains all channels, a parameter
    may have made up for the unit: it changed by the suspected factor or its square root, and the first response
    explains the data in the other unit as it is.

    Where the end explains a channel badly, the first response is computed for all samples, if the fit began with fewer.

    Parameters
    ----------
    problem : Problem
    vector : array, shape (parameters,)
        The identified values.
    response : array, shape (samples, channels)
        At these values.
    """
    first = problem.journal.first
    if first is None:
        return
    poor = {name for name, share in _shares(problem, response).items() if not share >= GOOD}
    begun = problem.first(len(first.response))
    suspects = suspect_units(begun, first.response)
    if poor and len(first.response) < problem.samples:
        suspects += suspect_units(problem, problem.responses(first.vector[None])[0])
    suspects = {suspect.channel: suspect for suspect in suspects}
    changed = {name: _changed(problem, first.vector, vector, one.factor) for name, one in suspects.items()}
    wrong = _explaining(problem, first.vector, list(suspects.values()), poor) if poor else []
    for name, suspect in suspects.items():
        absorbed = not poor and changed[name] and _good(begun, first.response, [suspect]) >= {name}
        if suspect in wrong or absorbed:
            yield unit_finding(suspect, changed[name])


def first_unit_findings(model: ForwardModel, data: Measurements) -> tuple[Finding, ...]:
    """Return the units that the response at the first guesses makes suspect, from one simulation."""
    problem = pose(model, data, None, Journal(len(data.coordinate.values)))
    response = problem.responses(model.parameters.start[None])[0]
    return tuple(unit_finding(suspect) for suspect in suspect_units(problem, response))


def unit_finding(suspect: SuspectUnit, changed: str = "") -> Finding:
    """Return the finding on a suspected unit; ``changed`` is the parameter that makes up for it."""
    values = {"channel": suspect.channel, "ratio": suspect.ratio, "factor": suspect.factor, "parameter": changed}
    absorbed = f" The fit changes {changed!r} by such a factor to make up for it." if changed else ""
    message = (
        f"The data of {suspect.channel!r} vary {suspect.ratio:.3g} times as much as the response at the first guesses. "
        f"{suspect.question}{absorbed}"
    )
    advice = "Give the unit of the column in units. If the unit is right, start closer to the true values."
    return Finding("suspect-unit", "warning", values, message, advice)


def _shares(problem: MisfitProblem, response: np.ndarray) -> dict[str, float]:
    """Part of the variation of each channel that a response explains."""
    names = [series.name for series in series_of(problem)]
    return dict(zip(names, (one.share for one in explained(problem, response, problem.weights, np.inf)), strict=True))


def _explaining(
    problem: MisfitProblem, first: np.ndarray, suspects: Sequence[SuspectUnit], poor: set[str]
) -> Sequence[SuspectUnit]:
    """Return the suspects with which their channels and a poor one are explained: all together, or a single one.

    The fits begin where those of the data began. The first that explains the channels ends the search.
    """
    together = [suspects] if len(suspects) > 1 else []
    begun = first, *(start.start for start in problem.journal.starts)
    starts = [start for start in begun if np.all(np.isfinite(start))]  # NaN where a swarm scattered its points
    for tried in (*together, *([suspect] for suspect in suspects)):
        part = replace(_converted(problem, tried), journal=Journal(problem.samples), loss=None)
        ends = (refine(part, FITTED, End(part.search.points(start), np.inf, False, "")) for start in starts)
        good = (_good(problem, part.responses(part.search.vectors(end.point)[None])[0], tried) for end in ends)
        found = any(names & poor and names >= {suspect.channel for suspect in tried} for names in good)
        problem.journal.simulations += part.journal.simulations
        if found:
            return tried
    return []


def _good(problem: MisfitProblem, response: np.ndarray, suspects: Sequence[SuspectUnit]) -> set[str]:
    """Names of the channels that a response explains after a change of the suspected units."""
    return {name for name, share in _shares(_converted(problem, suspects), response).items() if share >= GOOD}


def _converted(problem: MisfitProblem, suspects: Sequence[SuspectUnit]) -> MisfitProblem:
    """The problem of data whose suspected units are changed; their weights change as those of converted deviations."""
    factors = np.ones(problem.weights.size)
    for series in series_of(problem):
        factors[series.rows] = next((one.factor for one in suspects if one.channel == series.name), 1.0)
    factors = factors.reshape(problem.weights.shape)
    data = replace(problem.data, values=problem.data.values / factors)
    return replace(problem, data=data, weights=problem.weights * factors**2)


def _ratio(problem: MisfitProblem, response: np.ndarray, series: Series) -> float:
    """Range of a channel's data over that of the response; NaN where one of them says nothing."""
    rows, column = np.divmod(series.rows, response.shape[1])
    column = column[0]
    data, computed = problem.data.continuous[rows, column], response[rows, column]
    if problem.data.wrapping[column]:
        computed = np.unwrap(computed)
    data, computed = without_outliers(data, computed)
    ranges = np.array([np.ptp(data), np.ptp(computed)])
    if np.any(ranges <= FLAT * np.array([np.max(np.abs(data)), np.max(np.abs(computed))])):
        return np.nan
    if np.mean(np.diff(data) ** 2) > ROUGH * np.var(data):
        return np.nan
    return float(ranges[0] / ranges[1])


def _factors(unit: str) -> tuple[float, ...]:
    """Factors that may lie between the data and a response in a unit."""
    angles = (ANGLE, 1 / ANGLE) if unit.split("/")[0] == "rad" else ()
    return (*angles, PREFIX, 1 / PREFIX)


def _changed(problem: MisfitProblem, start: np.ndarray, end: np.ndarray, factor: float) -> str:
    """Name of a parameter that changed by a factor, its square root, or their inverse; empty if there is none."""
    for name, before, after in zip(problem.model.parameters.names, start, end, strict=True):
        change = after / before if before * after > 0 else 1.0
        if any(_like(ratio, factor) for ratio in (change, 1 / change, change**2, change**-2)):
            return name
    return ""


def _like(ratio: float, factor: float) -> bool:
    """Whether a ratio is about a factor."""
    return 1 / TOLERATED[factor] < ratio / factor < TOLERATED[factor]
