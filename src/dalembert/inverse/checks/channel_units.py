"""Units of channels that the first response of a fit makes suspect."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from dalembert.findings import Finding
from dalembert.inverse.identification.assess import Optimum
from dalembert.inverse.least_squares.descent import End, refine
from dalembert.inverse.noise.correlation.series import series_of
from dalembert.inverse.plausibility.suspect_units import SuspectUnit, is_like, suspect_units, unit_finding
from dalembert.inverse.problem.journal import Journal
from dalembert.inverse.problem.problem import MisfitProblem
from dalembert.inverse.validation.explained import GOOD, explained
from dalembert.optimize import LeastSquares

FITTED = LeastSquares(trials=25)
"""Descent to data in another unit."""


def channel_units(optimum: Optimum) -> Iterator[Finding]:
    """Yield the units that the first response of a fit makes suspect, if another unit explains the data.

    A unit is wrong if the response explains a channel badly, and explains it and the suspected one where the model is
    fitted to the data in the other unit, from the same starts. Where the response explains all channels, a parameter
    may have made up for the unit: it changed by the suspected factor or its square root, and the first response
    explains the data in the other unit as it is. Where the end explains a channel badly, the first response is computed
    for all samples, if the fit began with fewer.
    """
    first = optimum.problem.journal.first
    if first is None:
        return
    # The search alone counts its simulations.
    problem = replace(optimum.problem, journal=replace(optimum.problem.journal, failures=[]))
    poor = {name for name, share in _shares(problem, optimum.response).items() if not share >= GOOD}
    begun = problem.first(len(first.response))
    suspects = suspect_units(begun, first.response)
    if poor and len(first.response) < problem.samples:
        suspects += suspect_units(problem, problem.responses(first.vector[None])[0])
    suspects = {suspect.channel: suspect for suspect in suspects}
    changed = {name: _changed(problem, first.vector, optimum.vector, item.factor) for name, item in suspects.items()}
    wrong = _explaining(problem, first.vector, list(suspects.values()), poor) if poor else []
    for name, suspect in suspects.items():
        absorbed = not poor and changed[name] and _good(begun, first.response, [suspect]) >= {name}
        if suspect in wrong or absorbed:
            yield unit_finding(suspect, changed[name])


def _shares(problem: MisfitProblem, response: np.ndarray) -> dict[str, float]:
    """Part of the variation of each channel that a response explains."""
    names = [series.name for series in series_of(problem)]
    return dict(zip(names, (item.share for item in explained(problem, response, problem.weights, np.inf)), strict=True))


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
        explains = any(names & poor and names >= {suspect.channel for suspect in tried} for names in good)
        problem.journal.simulations += part.journal.simulations
        if explains:
            return tried
    return []


def _good(problem: MisfitProblem, response: np.ndarray, suspects: Sequence[SuspectUnit]) -> set[str]:
    """Names of the channels that a response explains after a change of the suspected units."""
    return {name for name, share in _shares(_converted(problem, suspects), response).items() if share >= GOOD}


def _converted(problem: MisfitProblem, suspects: Sequence[SuspectUnit]) -> MisfitProblem:
    """The problem of data whose suspected units are changed; their weights change as those of converted deviations."""
    factors = np.ones(problem.weights.size)
    for series in series_of(problem):
        factors[series.rows] = next((suspect.factor for suspect in suspects if suspect.channel == series.name), 1.0)
    factors = factors.reshape(problem.weights.shape)
    data = replace(problem.data, values=problem.data.values / factors)
    return replace(problem, data=data, weights=problem.weights * factors**2)


def _changed(problem: MisfitProblem, start: np.ndarray, end: np.ndarray, factor: float) -> str:
    """Name of a parameter that changed by a factor, its square root, or their inverse; empty if there is none."""
    for name, before, after in zip(problem.model.parameters.names, start, end, strict=True):
        change = after / before if before * after > 0 else 1.0
        if any(is_like(ratio, factor) for ratio in (change, 1 / change, change**2, change**-2)):
            return name
    return ""
