"""A minimum that a single start reached although its residuals are not noise."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from dalembert.findings import Finding
from dalembert.inverse.least_squares.descent import End, refine
from dalembert.inverse.noise.noise_floor import NoiseFloor, random_residuals
from dalembert.inverse.problem.journal import Journal
from dalembert.inverse.problem.problem import MisfitProblem
from dalembert.inverse.starts.rivals import ALIKE, PROMISING
from dalembert.optimize import LeastSquares

LEAST = 3
"""Starts from which one alone at the smallest misfit confirms nothing."""

REFINED = 3
"""Ends of other starts, the best ones, that may confirm a minimum: starts end before their descents have converged."""


def unconfirmed_findings(
    problem: MisfitProblem, best: End, ends: Sequence[End], floor: NoiseFloor, *, white: bool
) -> Iterator[Finding]:
    """Yield a finding if one of several starts reached the smallest misfit and the residuals are not noise.

    Parameters
    ----------
    problem : Problem
    best : End
        The smallest misfit, refined.
    ends : sequence of End
        Of the starts, before the best one was refined.
    floor : NoiseFloor
    white : bool
        Whether the residuals look like white noise: a false minimum hardly leaves such residuals.
    """
    if len(ends) < LEAST or white or not best.success or best.misfit <= floor.misfit:
        return
    _, *others = sorted(ends, key=lambda end: end.misfit)
    alike = best.misfit * (1 + ALIKE / max(1, problem.compared - len(best.point)))
    if any(_refined(problem, end, alike) for end in others[:REFINED]):
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


def look_white(problem: MisfitProblem, response: np.ndarray) -> bool:
    """Return True if the residuals of a response (samples, channels) look like white noise."""
    return random_residuals(problem.residual(response), problem.weights.shape, problem.data.present)
