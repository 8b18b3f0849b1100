"""Starts of any other method than least squares, and the least squares that may polish them."""

from functools import partial
from typing import TypeAlias

import numpy as np

from dalembert.inverse.least_squares.descent import End, refine
from dalembert.inverse.noise.noise_floor import NoiseFloor
from dalembert.inverse.problem.problem import MisfitProblem
from dalembert.inverse.starts.spread import spread_points
from dalembert.optimize import Minimiser, Progress, Squares, Swarm

Method: TypeAlias = Swarm | Minimiser
"""A minimiser of a misfit that comes in batches."""


def runs(
    problem: MisfitProblem,
    method: Method,
    floor: NoiseFloor,
    *,
    starts: int,
    seed: int,
    spread: str,
    start: np.ndarray | None,
) -> list[End]:
    """Ends of up to ``starts`` runs, the first from the search point ``start`` if there is one, seeds counting up.

    Local minimisers begin the other runs at points spread over the box; swarms scatter their own points.
    """
    points: list[np.ndarray | None] = [start, *[None] * (starts - 1)]
    if isinstance(method, Minimiser):
        points[1:] = list(spread_points(problem, starts, seed, spread))[1:]
    ends: list[End] = []
    attempts = list(enumerate(points, seed))
    alone, run = isinstance(method, Minimiser) and not method.batched, partial(_run, method)
    for attempt in problem.prefetched(run, attempts) if alone else attempts:
        ends.append(run(problem, attempt))
        if floor.conclusive and ends[-1].misfit <= floor.misfit:
            break
    return ends


def polished(problem: MisfitProblem, method: Squares, best: End) -> End:
    """End of least squares from ``best``, as a separate start; ``best`` if the misfit does not fall."""
    journal, vector = problem.journal, problem.search.vectors(best.point)
    journal.began(vector)
    end = refine(problem, method, best)
    journal.ended(vector, problem.search.vectors(end.point), end.misfit, end.success, f"polished: {end.message}")
    return end if end.misfit <= best.misfit else best


def _run(method: Method, problem: MisfitProblem, attempt: tuple[int, np.ndarray | None]) -> End:
    """End of a run with a seed, from a search point if there is one."""
    (seed, point), journal, search = attempt, problem.journal, problem.search
    begin = None if point is None else search.vectors(point)
    minimise = method.minimise
    if isinstance(method, Minimiser):
        minimise = partial(method.minimise, gradient=problem.gradient)

    def progress(now: Progress) -> None:
        journal.step(now.best, search.vectors(now.x), problem.samples)

    journal.began(begin)
    found = minimise(problem.misfit, search.lower, search.upper, seed, start=point, on_iteration=progress)
    end = End(found.x, found.misfit, found.success, found.message, found.stationary)
    nowhere = np.full_like(search.lower, np.nan)
    journal.ended(
        nowhere if begin is None else begin,
        search.vectors(end.point) if np.isfinite(end.misfit) else nowhere,
        end.misfit,
        end.success,
        end.message,
    )
    return end
