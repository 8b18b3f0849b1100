"""Further intervals of a profile: values beyond its first crossings that the data do not contradict either."""

from functools import partial

import numpy as np
import scipy

from dalembert.errors import SolveError
from dalembert.inverse.assessment.walk import ProfileWalk, least, walked
from dalembert.inverse.least_squares.descent import Memo
from dalembert.inverse.problem.problem import MisfitProblem
from dalembert.inverse.starts.neighbours import dips

SCANNED = 25  # values of the parameter that are simulated across its bounds
OTHERS = 2  # points of the other parameters that are tried with each value, beside the identified one
MOST = 3  # dips of the scan that are descended into, the lowest ones


def elsewhere(
    problem: MisfitProblem, vector: np.ndarray, k: int, interval: tuple[float, float], walk: ProfileWalk
) -> tuple[tuple[float, float], ...]:
    """Intervals of parameter ``k`` beside the one around the identified ``vector`` (parameters,), increasing. One batch
    scans the parameter between its bounds. From its lowest dips the misfit is made least over all parameters, and where
    that ends below the threshold at another value, both sides are walked from there. A region whose basin lies between
    two values of the scan is not seen.
    """
    intervals = [interval]
    starts = list(_starts(problem, vector, k, interval))
    for point in problem.prefetched(partial(_around, k, walk, intervals[:1]), starts):
        further = _around(k, walk, intervals, problem, point)
        if further is not None:
            intervals.append(further)
    return tuple(sorted(intervals[1:]))


def _around(
    k: int, walk: ProfileWalk, intervals: list[tuple[float, float]], problem: MisfitProblem, point: np.ndarray
) -> tuple[float, float] | None:
    """Interval around where the misfit is least near a search point, apart from those found; None if there is none."""
    memo, search = Memo(problem), problem.search
    try:
        end = walk.method.minimise(memo.residual, memo.jacobian, search.lower, search.upper, point, ahead=memo.ahead)
        excess, end_vector = (end.misfit - walk.best) / walk.variance, search.vectors(end.x)
        if any(lower <= end_vector[k] <= upper for lower, upper in intervals):
            return None
        if walk.likelihood is not None and excess < 4 * walk.threshold:  # the misfit with fixed noise is near it
            bracket = least(problem, k, end.x, walk)
            if isinstance(bracket, str):
                return None
            excess, end_vector = bracket[0], search.vectors(bracket[1])
        if not excess < walk.threshold or any(lower <= end_vector[k] <= upper for lower, upper in intervals):
            return None
        at = problem.linearise(end_vector)
    except SolveError:
        return None
    lower, upper = (walked(problem, at, k, side, walk, excess).end for side in (-1, 1))
    return lower, upper


def _starts(problem: MisfitProblem, vector: np.ndarray, k: int, interval: tuple[float, float]) -> np.ndarray:
    """Search points (n, parameters) at the lowest dips of a scan outside of the interval."""
    search = problem.search
    values = np.linspace(search.lower[k], search.upper[k], SCANNED)
    size = len(vector)
    grid = np.repeat(search.points(vector)[None], 1 if size == 1 else 1 + OTHERS, axis=0)
    if size > 1:
        spread = scipy.stats.qmc.Halton(size, scramble=False).random(1 + OTHERS)[1:]  # its first point is a corner
        grid[1:] = search.lower + spread * (search.upper - search.lower)
    points = np.repeat(grid[None], SCANNED, axis=0)
    points[:, :, k] = values[:, None]
    misfit = problem.misfit(points.reshape(-1, size)).reshape(SCANNED, -1)
    misfit = np.where(np.isfinite(misfit), misfit, np.inf)
    best = np.argmin(misfit, axis=1)
    chosen, lowest = points[np.arange(SCANNED), best], misfit[np.arange(SCANNED), best]
    along = search.vectors(chosen)[:, k]
    outside = (along < interval[0]) | (along > interval[1])
    low = [n for n in dips(np.concatenate([[np.inf], lowest, [np.inf]])) - 1 if outside[n] and np.isfinite(lowest[n])]
    return chosen[sorted(low, key=lambda n: lowest[n])[:MOST]]
