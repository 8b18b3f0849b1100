"""Many starts of least squares, chosen among screened points and led by a growing horizon."""

from collections.abc import Iterator
from dataclasses import replace
from itertools import count

import numpy as np

from dalembert.inverse.descent import End, descend
from dalembert.inverse.neighbours import neighbours
from dalembert.inverse.noise import NoiseFloor, random_residuals
from dalembert.inverse.problem import Problem
from dalembert.inverse.spread import spread_points
from dalembert.optimize import Squares

HORIZONS = ("growing", None)

SCREENED = 8
"""Points simulated to choose starts from, a parameter and start."""

BESIDE = 2
"""Descents from beside the best end, the most promising ones."""

APART = 0.05
"""Chosen points keep this part of the box's width from each other."""


def multistart(
    problem: Problem,
    method: Squares,
    floor: NoiseFloor,
    *,
    starts: int,
    seed: int,
    horizon: str | None,
    spread: str,
    start: np.ndarray,
) -> list[End]:
    """Ends of up to ``starts`` descents from search points.

    Stops early when an end reaches a conclusive noise floor, or, from the third start on, when the best end has been
    reached twice and leaves residuals that look like noise. With more than one start each is left once a step gains
    less than a thousandth of the fitness; the best end is to be polished.
    """
    ladder = [problem.first(samples) for samples in horizons(problem, horizon)]
    hasty = method if starts == 1 else replace(method, gain=max(1e-3, method.gain))
    ends: list[End] = []
    for point, rung in _attempts(ladder, starts, seed, spread, start):
        ends.append(_descent(ladder[rung:], hasty, point))
        if floor.conclusive and ends[-1].fitness <= floor.fitness:
            return ends
        if len(ends) == starts or (len(ends) >= 3 and _reproduced(problem, ends)):
            break
    return ends if starts == 1 else ends + _beside(problem, hasty, min(ends, key=lambda end: end.fitness), starts)


def _descent(ladder: list[Problem], method: Squares, point: np.ndarray) -> End:
    """End of a descent, told to the journal."""
    journal, search = ladder[-1].journal, ladder[-1].search
    values = search.vectors(point)
    journal.began(values)
    end = descend(ladder, method, point)
    journal.ended(values, search.vectors(end.point), end.fitness, end.success, end.message)
    return end


def _beside(problem: Problem, method: Squares, best: End, most: int) -> list[End]:
    """Ends of up to ``most`` descents from beside the best end, and from beside a better one that they lead to."""
    ends: list[End] = []
    while True:
        for point in neighbours(problem, best)[: min(BESIDE, most - len(ends))]:
            ends.append(_descent([problem], method, point))
            if ends[-1].fitness < (1 - method.gain) * best.fitness:
                best = ends[-1]
                break
        else:
            return ends


def horizons(problem: Problem, horizon: str | None) -> list[int]:
    """Numbers of samples from short to all: an eighth, a quarter, a half, all, but none too few to tell anything."""
    if horizon is None:
        return [problem.samples]
    least = max(3, -(-2 * len(problem.search.lower) // problem.weights.shape[1]))
    measured = np.cumsum(np.mean(problem.data.present, axis=1)).round(9)  # samples, gaps taken off
    parts = [problem.samples // part for part in (8, 4, 2)]
    return [samples for samples in parts if samples > 0 and measured[samples - 1] >= least] + [problem.samples]


def _attempts(
    ladder: list[Problem], starts: int, seed: int, spread: str, first: np.ndarray
) -> Iterator[tuple[np.ndarray, int]]:
    """Search points to start from, each with the rung of the ladder to begin on.

    The given start comes first, its horizon growing from the shortest. Then points spread over the box are simulated in
    one batch, and the horizons, half of the samples, a quarter, an eighth, take turns to name the best point left
    by the misfit over themselves and to grow from it: the longer ones stand above the noise, the shorter ones hold
    fewer false minima.
    """
    yield first, 0
    points, scores = _screen(ladder, SCREENED * starts * len(first), seed, spread)
    search, longest = ladder[-1].search, max(0, len(ladder) - 2)
    free = np.isfinite(scores[-1])
    for turn in count():
        if not free.any():
            return
        rung = longest - turn % (longest + 1)
        chosen = int(np.argmin(np.where(free, scores[rung], np.inf)))
        free &= np.max(np.abs(points - points[chosen]) / (search.upper - search.lower), axis=1) > APART
        yield points[chosen], rung


def _screen(ladder: list[Problem], number: int, seed: int, spread: str) -> tuple[np.ndarray, np.ndarray]:
    """Points (number, parameters) over the box, and their misfit over each horizon, (rungs, number)."""
    whole = ladder[-1]
    points = spread_points(whole, number, seed, spread)
    squares = whole.squares(whole.responses(whole.search.vectors(points)))
    scores = np.array([squares[:, : rung.samples].sum(axis=(1, 2)) for rung in ladder])
    scores = np.where(np.isfinite(scores), scores, np.inf)
    whole.journal.screened(scores[-1])
    return points, scores


def _reproduced(problem: Problem, ends: list[End]) -> bool:
    """Whether a second end cannot be told from the best one by the data, and the residuals look like noise.

    Two ends cannot be told apart when fitness and linearised residuals differ by less than one variance of the noise,
    fitness/(values − parameters).
    """
    best, *others = sorted(ends, key=lambda end: end.fitness)
    at = best.linearisation
    freedom = problem.compared - len(best.point)
    if at is None or freedom <= 0:
        return False
    if not random_residuals(problem.residual(at.response), problem.weights.shape, problem.data.present):
        return False
    slopes, variance = problem.slopes(at), best.fitness / freedom
    return any(
        end.fitness - best.fitness < variance and np.sum((slopes @ (end.point - best.point)) ** 2) < variance
        for end in others
    )
