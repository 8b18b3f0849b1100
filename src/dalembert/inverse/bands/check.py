"""True runs where a surrogate has its minima and maxima, and the best candidate that they check."""

from dataclasses import dataclass

import numpy as np

from dalembert.inverse.bands.band_problem import BandProblem
from dalembert.inverse.bands.candidate import Candidate
from dalembert.surrogate import ChebyshevPolynomial

LOSS = 1e-6  # a bound may be checked at a point where the surrogate is this part of its range away from it


@dataclass(frozen=True, eq=False)
class Check:
    """True runs at points (runs, d) of a box, those that failed left out."""

    points: np.ndarray  # (runs, d)
    values: np.ndarray  # (runs, outputs)
    error: np.ndarray  # (outputs,): largest difference between surrogate and true runs

    @property
    def lower(self) -> np.ndarray:
        """Least outputs of the true runs, shape (outputs,)."""
        return self.values.min(axis=0)

    @property
    def upper(self) -> np.ndarray:
        """Largest outputs of the true runs, shape (outputs,)."""
        return self.values.max(axis=0)


@dataclass(frozen=True, eq=False)
class BandSolution:
    """The best candidate, on the surrogate that bounds it."""

    polynomial: ChebyshevPolynomial
    candidate: Candidate
    error: np.ndarray  # (outputs,): estimate of the surrogate's largest error on the candidate's box
    check: Check | None
    success: bool
    message: str
    reached: int | None = None  # number of descents that ended there; None for a method without descents


def check(problem: BandProblem, polynomial: ChebyshevPolynomial, at: Candidate) -> Check | None:
    """True runs at a few points of a candidate's box at which the surrogate takes all of its bounds; None if all fail.
    Many bounds are taken at the same corners. Of the points where they are taken a small part is chosen such that on
    the surrogate no bound is missed by more than ``LOSS`` of its channel's range.
    """
    points = _cover(problem, polynomial, at)
    values = problem.run(points)
    ok = np.all(np.isfinite(values), axis=1)
    if not ok.any():
        return None
    error = np.max(np.abs(polynomial(points[ok]) - values[ok]), axis=0)
    return Check(points[ok], values[ok], error)


def _cover(problem: BandProblem, polynomial: ChebyshevPolynomial, at: Candidate) -> np.ndarray:
    """Points (n, d) that take all bounds nearly: greedily the one that takes most of those that are left."""
    assert at.bounds.at_lower is not None
    assert at.bounds.at_upper is not None
    points = np.unique(np.concatenate([at.bounds.at_lower, at.bounds.at_upper]), axis=0)
    values = polynomial(points)
    allowed = LOSS * scale(problem)
    takes = np.hstack([values <= at.bounds.lower + allowed, values >= at.bounds.upper - allowed])
    chosen = []
    while takes.any():
        best = int(np.argmax(takes.sum(axis=1)))
        chosen.append(best)
        takes = takes & ~takes[best]
    return points[np.sort(chosen)]


def scale(problem: BandProblem) -> np.ndarray:
    """Range of each output's channel over the given bands, shape (outputs,)."""
    bands = problem.bands
    span = bands.upper.max(axis=0) - bands.lower.min(axis=0)
    span = np.where(span > 0, span, np.maximum(np.abs(bands.upper).max(axis=0), np.finfo(float).tiny))
    return np.broadcast_to(span, problem.shape).ravel()
