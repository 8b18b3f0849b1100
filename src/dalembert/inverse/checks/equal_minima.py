"""Other minima that the data cannot distinguish from the best one."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from dalembert.findings import Finding
from dalembert.inverse.identification.assess import Optimum
from dalembert.inverse.identification.search import MisfitMinimum
from dalembert.inverse.least_squares.descent import End, refine
from dalembert.inverse.problem.journal import Journal
from dalembert.inverse.problem.problem import MisfitProblem
from dalembert.inverse.problem.simulated import named
from dalembert.optimize import LeastSquares

ALIKE = 4.0
"""Variances of the noise, two deviations, by which the misfits of two minima may differ before the data decide."""

PROMISING = 2.0
"""Ratio of misfits up to which the end of a start is refined: starts end before their descent has converged."""

SAME = 1e-3
"""Relative difference of values up to which two minima count as one."""


def equal_minima(optimum: Optimum) -> Iterator[Finding]:
    """Yield the finding on other minima in which starts ended and whose misfit equals the best within the noise."""
    search, problem, misfit = optimum.search, optimum.search.problem, optimum.search.end.misfit
    known = optimum.noise_is_known if optimum.minimum.noise is None else optimum.posed.noise_is_given
    rivals = _rivals(search, optimum.estimate.deviations, known=known)
    if not rivals:
        return
    names = problem.model.parameters.names
    vectors = [problem.search.vectors(end.point) for end in rivals]
    values: dict[str, float] = {"minima": len(rivals)}
    for number, (vector, end) in enumerate(zip(vectors, rivals, strict=True), 1):
        values |= {f"other_{number}.{name}": float(value) for name, value in zip(names, vector, strict=True)}
        values[f"other_{number}.misfit"] = float(end.misfit)
    which = "Another minimum explains" if len(rivals) == 1 else f"{len(rivals)} other minima explain"
    listed = "; ".join(named(problem.model, vector) for vector in vectors)
    message = f"{which} the data as well, within the noise: {listed}."
    if misfit > search.floor.misfit:  # below, a ratio means nothing
        message += f" Misfit: {', '.join(f'{end.misfit / misfit:.4g}' for end in rivals)} times as large."
    advice = "Measure another channel, or narrow the bounds so that they contain one minimum."
    yield Finding("equal-minima", "warning", values, message, advice)


def _rivals(search: MisfitMinimum, deviations: np.ndarray, *, known: bool) -> list[End]:
    """Return other minima in which starts ended and whose misfit equals the best within the noise.

    Minima are distinct where a value differs by more than two ``deviations`` (parameters,) and by more than 0.1 %; NaN
    decides nothing. The deviation of a parameter that is not identifiable is infinite, so ends along a flat valley are
    one minimum. If the values of other parameters differ along the valley, it is recognised by a descent from the
    middle that keeps the misfit. ``known``: whether the deviations follow from given ones of the data.
    """
    problem, best, floor = search.problem, search.end, search.floor
    variance = best.misfit / max(1, problem.compared - len(best.point))
    noise = max(variance, 1.0 if floor.known else floor.misfit / problem.compared)
    inflation = np.sqrt(max(1.0, noise / max(1.0 if known else variance, np.finfo(float).tiny)))
    with np.errstate(invalid="ignore"):  # 0 · inf
        reach = 2.0 * inflation * deviations
    quiet = replace(problem, journal=Journal(problem.samples))
    rivals: list[End] = []
    for start in sorted(problem.journal.starts, key=lambda start: start.misfit):
        if not start.misfit < PROMISING * best.misfit + ALIKE * noise:
            break
        end = End(problem.search.points(start.end), start.misfit, start.success, start.message)
        if not _new(problem, end, [best, *rivals], reach):
            continue
        if search.is_one_run:
            end = refine(quiet, LeastSquares(), end)
        if not (end.success and end.misfit - best.misfit < ALIKE * noise):
            continue
        most = best.misfit + ALIKE * noise
        if _new(problem, end, [best, *rivals], reach) and not _one_valley(quiet, best, end, deviations, most, reach):
            rivals.append(end)
    problem.journal.simulations += quiet.journal.simulations
    return rivals


def _new(problem: MisfitProblem, end: End, known: list[End], reach: np.ndarray) -> bool:
    """Return True if an end lies apart from the known ones."""
    here, *known_points = (problem.search.vectors(point_end.point) for point_end in (end, *known))
    sizes = [np.fmax(reach, SAME * np.maximum(np.abs(here), np.abs(point))) for point in known_points]
    return all(np.any(np.abs(here - point) > size) for point, size in zip(known_points, sizes, strict=True))


def _one_valley(
    problem: MisfitProblem, best: End, end: End, deviations: np.ndarray, most: float, reach: np.ndarray
) -> bool:
    """Return True if a combination is not identifiable, and a descent between two ends keeps their misfit."""
    widths = problem.model.parameters.upper - problem.model.parameters.lower
    if not np.any(deviations > widths / np.sqrt(12)):
        return False
    between = refine(problem, LeastSquares(), replace(best, point=(best.point + end.point) / 2, linearisation=None))
    return between.misfit < most and _new(problem, between, [best, end], reach)
