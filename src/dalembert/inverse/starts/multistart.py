"""Many starts of least squares, chosen among screened points and led by a growing horizon."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from itertools import count, islice
from typing import TypeAlias

import numpy as np

from dalembert.inverse.least_squares.descent import End, descend, recorded
from dalembert.inverse.noise.noise_floor import NoiseFloor
from dalembert.inverse.problem.problem import MisfitProblem, Work
from dalembert.inverse.problem.random_residuals import random_residuals
from dalembert.inverse.problem.search_coordinates import SearchCoordinates
from dalembert.inverse.starts.neighbours import neighbours
from dalembert.inverse.starts.spread import spread_points
from dalembert.optimize import Squares

Attempt: TypeAlias = tuple[np.ndarray, int, float | None]
"""A search point (parameters,) to start from, the rung of the ladder of horizons to begin on, and the point's misfit
over all samples if it is known."""

HORIZONS = ("growing",)

SCREENED = 8
"""Points simulated to choose starts from, a parameter and start."""

BESIDE = 2
"""Descents from beside the best end, the most promising ones."""

DIRECT = 4
"""Starts from which on the last one is the given one again, over all samples: short horizons may lead astray."""

APART = 0.05
"""Chosen points keep this part of the box's width from each other."""


def multistart(
    problem: MisfitProblem,
    method: Squares,
    floor: NoiseFloor,
    *,
    starts: int,
    seed: int,
    horizon: str | None,
    spread: str,
    start: np.ndarray,
) -> list[End]:
    """Ends of up to ``starts`` descents from search points. Stops early when an end reaches a conclusive noise floor,
    or, from the third start on, when the best end has been reached twice and leaves residuals that look like noise.
    With more than one start each is left once a step gains less than a thousandth of the misfit; the best end is to be
    polished.
    """
    sizes = horizons(problem, horizon)
    ladder = [problem.first(samples) for samples in sizes]
    hasty = method if starts == 1 else replace(method, gain=max(1e-3, method.gain))
    ends: list[End] = []
    for point, rung, misfit in _attempts(ladder, partial(_ahead, sizes, hasty), starts, seed, spread, start, ends):
        ends.append(recorded(problem, point, partial(descend, ladder[rung:], hasty, point, misfit)))
        if floor.conclusive and ends[-1].misfit <= floor.misfit:
            return ends
        if len(ends) == starts or (len(ends) >= 3 and _reproduced(problem, ends)):
            break
    return ends if starts == 1 else ends + _beside(problem, hasty, min(ends, key=lambda end: end.misfit), starts)


def _ahead(sizes: Sequence[int], method: Squares, problem: MisfitProblem, attempt: Attempt) -> None:
    """The same descent on a worker of a cluster."""
    point, rung, misfit = attempt
    descend([problem.first(samples) for samples in sizes[rung:]], method, point, misfit)


def _beside(problem: MisfitProblem, method: Squares, best: End, most: int) -> list[End]:
    """Ends of up to ``most`` descents from beside the best end, and from beside a better one that they lead to."""
    ends: list[End] = []
    ahead = partial(_ahead, [problem.samples], method)
    while True:
        points = neighbours(problem, best)[: min(BESIDE, most - len(ends))]
        for point, *_ in problem.prefetched(ahead, [(point, 0, None) for point in points]):
            ends.append(recorded(problem, point, partial(descend, [problem], method, point)))
            if ends[-1].misfit < (1 - method.gain) * best.misfit:
                best = ends[-1]
                break
        else:
            return ends


def horizons(problem: MisfitProblem, horizon: str | None) -> list[int]:
    """Numbers of samples from short to all: an eighth, a quarter, a half, all; without numbers that are too few."""
    if horizon is None:
        return [problem.samples]
    least = max(3, -(-2 * len(problem.search.lower) // problem.weights.shape[1]))
    measured = np.cumsum(np.mean(problem.data.present, axis=1)).round(9)  # samples, gaps taken off
    parts = [problem.samples // part for part in (8, 4, 2)]
    return [samples for samples in parts if samples > 0 and measured[samples - 1] >= least] + [problem.samples]


def _attempts(
    ladder: list[MisfitProblem],
    ahead: Work[Attempt],
    starts: int,
    seed: int,
    spread: str,
    first: np.ndarray,
    ends: Sequence[End],
) -> Iterator[Attempt]:
    """Up to ``starts`` search points, each with its first horizon in the ladder, and its end if that is known. The
    stated start comes first, its horizon growing from the shortest. If its misfit is larger at the end than at the
    start, the same start over all samples is next; otherwise it is the last. Then points spread over the box are
    simulated in one batch. The best of them are the other starts; a cluster runs them in parallel.
    """
    yield first, 0, None
    whole = len(ladder) - 1
    again: list[Attempt] = [(first, whole, None)] if whole and starts >= DIRECT else []
    if again and not ends[0].begun <= ladder[whole].misfit(first[None])[0]:
        yield again.pop()
        starts -= 1
    points, scores = _screen(ladder, SCREENED * starts * len(first), seed, spread)
    others = [*islice(_chosen(ladder[-1].search, points, scores), starts - 1 - len(again)), *again]
    yield from ladder[-1].prefetched(ahead, others)


def _chosen(search: SearchCoordinates, points: np.ndarray, scores: np.ndarray) -> Iterator[Attempt]:
    """Screened points (number, parameters) to start from, by their misfit over each horizon (rungs, number). The
    horizons, half of the samples, a quarter, an eighth, take turns to name the best point left by the misfit over
    themselves and to grow from it: the longer ones stand above the noise, the shorter ones hold fewer false minima.
    """
    longest = max(0, len(scores) - 2)
    free = np.isfinite(scores[-1])
    for turn in count():
        if not free.any():
            return
        rung = longest - turn % (longest + 1)
        chosen = int(np.argmin(np.where(free, scores[rung], np.inf)))
        free &= np.max(np.abs(points - points[chosen]) / (search.upper - search.lower), axis=1) > APART
        yield points[chosen], rung, float(scores[-1, chosen])


def _screen(ladder: list[MisfitProblem], number: int, seed: int, spread: str) -> tuple[np.ndarray, np.ndarray]:
    """Points (number, parameters) over the box, and their misfit over each horizon, (rungs, number)."""
    whole = ladder[-1]
    points = spread_points(whole, number, seed, spread)
    squares = whole.squares(whole.responses(whole.search.vectors(points)))
    scores = np.array([squares[:, : rung.samples].sum(axis=(1, 2)) for rung in ladder])
    scores = np.where(np.isfinite(scores), scores, np.inf)
    whole.journal.screened(scores[-1])
    return points, scores


def _reproduced(problem: MisfitProblem, ends: list[End]) -> bool:
    """Whether the data do not distinguish a second end from the best one, and the residuals look like noise. Two ends
    are the same if misfit and linearised residuals differ by less than one variance of the noise, misfit/(values −
    parameters).
    """
    best, *others = sorted(ends, key=lambda end: end.misfit)
    at = best.linearisation
    freedom = problem.compared - len(best.point)
    if at is None or freedom <= 0:
        return False
    if not random_residuals(problem.residual(at.response), problem.weights.shape, problem.data.present):
        return False
    slopes, variance = problem.slopes(at), best.misfit / freedom
    return any(
        end.misfit - best.misfit < variance and np.sum((slopes @ (end.point - best.point)) ** 2) < variance
        for end in others
    )
