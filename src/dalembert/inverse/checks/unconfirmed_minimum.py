"""A minimum that a single start reached although its residuals are not noise."""

from collections.abc import Iterator
from dataclasses import replace

from dalembert.findings import Finding
from dalembert.inverse.checks.equal_minima import ALIKE, PROMISING
from dalembert.inverse.identification.assess import Optimum
from dalembert.inverse.identification.search import MisfitMinimum
from dalembert.inverse.least_squares.descent import End, refine
from dalembert.inverse.problem.journal import Journal
from dalembert.inverse.problem.problem import MisfitProblem
from dalembert.inverse.problem.random_residuals import random_residuals
from dalembert.optimize import LeastSquares

LEAST = 3
"""Starts from which one alone at the smallest misfit confirms nothing."""

REFINED = 3
"""Ends of other starts, the best ones, that may confirm a minimum: starts end before their descents have converged."""


def unconfirmed_minimum(optimum: Optimum) -> Iterator[Finding]:
    """Yield a finding if one of several starts reached the smallest misfit and the residuals are not noise.

    A false minimum hardly leaves residuals that look like white noise.
    """
    problem = optimum.problem
    noise_like = random_residuals(problem.residual(optimum.response), problem.weights.shape, problem.data.present)
    if optimum.by_squares and optimum.settings.shooting is None and not noise_like:
        yield from single_start(optimum.search)


def single_start(search: MisfitMinimum) -> Iterator[Finding]:
    """Yield a finding if one of several starts reached the smallest misfit and known noise does not explain it."""
    problem, best, ends = search.problem, search.end, search.ends
    if len(ends) < LEAST or not best.success or search.explained_by:
        return
    _, *further_ends = sorted(ends, key=lambda end: end.misfit)
    alike = best.misfit * (1 + ALIKE / max(1, problem.compared - len(best.point)))
    if any(_refined(problem, end, alike) for end in further_ends[:REFINED]):
        return
    message = (
        f"Only 1 of {len(ends)} starts reached the smallest misfit, and its residuals are not noise: another minimum "
        "may be better."
    )
    advice = "Increase `starts`, narrow the bounds, or give a start near the solution."
    yield Finding("unconfirmed-minimum", "error", {"at_best": 1, "starts": len(ends)}, message, advice)


def _refined(problem: MisfitProblem, end: End, alike: float) -> bool:
    """Return True if a start's end, refined where it may be in the same valley, has a misfit below ``alike``."""
    if end.misfit < alike:
        return True
    if not end.misfit < PROMISING * alike:
        return False
    quiet = replace(problem, journal=Journal(problem.samples))
    misfit = refine(quiet, LeastSquares(), end).misfit
    problem.journal.simulations += quiet.journal.simulations
    return misfit < alike
