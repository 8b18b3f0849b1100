"""Continuation of responses over frequency: from one given frequency to the next, or along the curve past its folds."""

from collections.abc import Iterator
from dataclasses import replace
from itertools import islice

import numpy as np

from dalembert.vibration.balance.arc_length import EASY, PathPoint, PathProblem, along, on_border
from dalembert.vibration.balance.newton import Solution

BEHIND = 2.0
"""Part of the way between two frequencies by which the curve from one to the other may turn back behind the first, as
long as it keeps half of that."""
MOST_AROUND = 500
"""Points of that curve after which continuation to the second frequency stops."""
MOST_LOST = 20
"""Points in succession that are not found, after which continuation stops. Their steps grow to the longest."""


def at_frequencies(equations: PathProblem, omegas: np.ndarray, start: Solution | None) -> Iterator[PathPoint]:
    """Yield solutions at given frequencies, each from the last converged one, else from the next one."""
    return _from_behind(equations, _at_frequencies(equations, omegas, start))


def _from_behind(equations: PathProblem, points: Iterator[PathPoint]) -> Iterator[PathPoint]:
    """Yield points of a curve in their order; those that were not found are sought from the one behind them.

    At a kink of the forces a branch may end, and the next one begin before that: it is found from its other points.
    """
    missed: list[PathPoint] = []
    for point in points:
        missed.append(point)
        if not point.solution.converged:
            continue
        known = point.solution
        for place in range(len(missed) - 2, -1, -1):
            # Backwards, from the nearest point to the farthest: each is the start of the next.
            omega = missed[place].solution.omega
            known = equations.solve(_predicted(known, omega), omega, known.samples)
            if not known.converged:
                break
            missed[place] = replace(missed[place], solution=known)
        yield from missed
        missed = []
    yield from missed


def _at_frequencies(equations: PathProblem, omegas: np.ndarray, start: Solution | None) -> Iterator[PathPoint]:
    known = start
    for omega in omegas:
        solution = equations.first(omega) if known is None else _towards(equations, known, omega)
        known = solution if solution.converged else known
        yield PathPoint(solution)


def _towards(equations: PathProblem, known: Solution, omega: float) -> Solution:
    """Return the solution at a frequency from a known one. Steps that do not converge are halved."""
    way = [omega]
    worst = None
    while way:
        # Natural continuation: the guess is U + (dU/dω) Δω, with dU/dω = -J⁻¹ ∂R/∂ω.
        solution = equations.solve(_predicted(known, way[-1]), way[-1], known.samples)
        if solution.converged:
            known = solution
            way.pop()
        elif len(way) > equations.method.halvings:
            # After the last halving: a fresh start, then the way along the curve and its folds.
            fresh = equations.first(omega)
            return fresh if fresh.converged else _around(equations, known, omega) or worst or solution
        else:
            worst = worst or solution
            way.append((known.omega + way[-1]) / 2)
    return known


def _around(equations: PathProblem, known: Solution, omega: float) -> Solution | None:
    """Return the solution at a frequency along the curve from a known one, past folds."""
    if known.omega == omega or not equations.method.halvings:
        return None
    for point in islice(along(equations, known.omega, omega, known, _behind(known.omega, omega)), MOST_AROUND):
        if point.solution.converged and point.solution.omega == omega:
            return point.solution
    return None


def _predicted(known: Solution, omega: float) -> np.ndarray:
    if omega == known.omega:
        return known.unknowns
    try:
        return known.unknowns + (omega - known.omega) * known.rate()
    except np.linalg.LinAlgError:
        return known.unknowns


def natural(equations: PathProblem, begin: float, end: float, start: Solution | None) -> Iterator[PathPoint]:
    """Yield solutions from one frequency to another, with steps as long as Newton's method allows."""
    return _from_behind(equations, _natural(equations, begin, end, start))


def _natural(equations: PathProblem, begin: float, end: float, start: Solution | None) -> Iterator[PathPoint]:
    known = start if start is not None else equations.first(begin)
    yield PathPoint(known)
    # Steps from a quarter of the longest on; they double after few iterations and halve where none converges.
    longest = (end - begin) * equations.method.resolution
    step, lost = longest / 4, 0
    while known.omega != end and lost < MOST_LOST:
        target = known.omega + step
        target = end if abs(end - target) < 1e-3 * abs(step) or (end - target) * step < 0 else target
        guess = _predicted(known, target) if known.converged else known.unknowns
        solution = equations.solve(guess, target, known.samples)
        if not (solution.converged or lost) and abs(step) > abs(longest) * 2.0**-equations.method.halvings:
            step /= 2
            continue
        if not solution.converged:
            fresh = equations.first(target)
            solution = fresh if fresh.converged else solution
        yield PathPoint(solution)
        known = solution if solution.converged else replace(known, omega=target)
        lost = 0 if solution.converged else lost + 1
        step = min(2 * step, longest, key=abs) if lost or solution.iterations <= EASY else step


def across(equations: PathProblem, begin: float, end: float, start: Solution | None) -> Iterator[PathPoint]:
    """Points of :func:`along` between two frequencies, where the curve may leave and come back at the first of them."""
    low, high = min(begin, end), max(begin, end)
    before: Solution | None = None
    outside = 0
    for point in along(equations, begin, end, start, _behind(begin, end)):
        solution, leaves = point.solution, not low <= point.solution.omega <= high
        # The curve crosses the first frequency: a point on the border ends the part inside, or begins it again.
        if before is not None and leaves != bool(outside) and solution.converged:
            border = equations.solve(*on_border(before, solution, begin), solution.samples)
            yield PathPoint(border, returned=not leaves)
        if not leaves:
            yield point
        outside = outside + 1 if leaves else 0
        if outside > MOST_AROUND:
            return
        before = solution


def _behind(begin: float, end: float) -> float:
    return min(BEHIND, 0.5 * abs(begin / (end - begin)))
