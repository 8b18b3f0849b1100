"""Minima beside a minimum: where a response that is out of step by a period more or less fits nearly as well."""

import numpy as np

from dalembert.inverse.least_squares.descent import End
from dalembert.inverse.problem.problem import MisfitProblem

POINTS = 14
"""Points on each side of a line."""

RATIO = 1.25
"""Growth of their distances, so that a minimum is seen that is no wider than the way to it."""

FIRST = 2.0
"""Distance of the first, in deviations of the combination that the line is along: the own minimum's border."""

WORSE = 9.0
"""Most that a point may be worse, in variances of a residual, for its minimum to be thought better."""


def neighbours(problem: MisfitProblem, end: End) -> np.ndarray:
    """Search points (n, parameters) near other minima, the most promising first. They are the local minima of the
    misfit, simulated in one batch, along a line through ``end`` for each combination of parameters that a singular
    value of the sensitivities belongs to.
    """
    if end.linearisation is None:
        return np.empty((0, len(end.point)))
    _, singular, directions = np.linalg.svd(problem.slopes(end.linearisation), full_matrices=False)
    variance = end.misfit / max(1, problem.compared - len(end.point))
    rays = [
        end.point + np.array(distances)[:, None] * way
        for value, direction in zip(singular, directions, strict=True)
        for way in (direction, -direction)
        if len(distances := _distances(problem, end.point, way, FIRST * np.sqrt(variance) / max(value, 1e-300))) > 2
    ]
    if not rays:
        return np.empty((0, len(end.point)))
    misfit = np.split(problem.misfit(np.concatenate(rays)), np.cumsum([len(ray) for ray in rays])[:-1])
    hopeful = end.misfit + WORSE * variance
    found = [(f[k], tuple(ray[k])) for ray, f in zip(rays, misfit, strict=True) for k in dips(f) if f[k] < hopeful]
    return np.array([point for _, point in sorted(found)]).reshape(-1, len(end.point))


def _distances(problem: MisfitProblem, point: np.ndarray, way: np.ndarray, first: float) -> np.ndarray:
    """Distances from a point along a way, growing, inside the box."""
    search, moving = problem.search, way != 0
    walls = (np.where(way > 0, search.upper, search.lower) - point)[moving] / way[moving]
    distances = first * RATIO ** np.arange(POINTS)
    return distances[distances <= np.min(walls)]


def dips(misfit: np.ndarray) -> np.ndarray:
    """Numbers of the local minima of misfit (points,) along a ray, its ends left out."""
    finite = np.where(np.isfinite(misfit), misfit, np.inf)
    inside = finite[1:-1]
    return 1 + np.flatnonzero((inside < finite[:-2]) & (inside <= finite[2:]))
