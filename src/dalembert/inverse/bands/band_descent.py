"""Least squares over middles and radii on a surrogate."""

import numpy as np

from dalembert.inverse.bands.band_problem import BandProblem
from dalembert.inverse.bands.candidate import Candidate, candidate, slopes
from dalembert.latin_hypercube import latin_hypercube
from dalembert.optimize import LeastSquares, Minimum, Progress
from dalembert.surrogate import ChebyshevPolynomial, bounds

APART = 0.1  # chosen starts keep this part of the widths of the unknowns' bounds from each other


def descend(problem: BandProblem, polynomial: ChebyshevPolynomial, method: LeastSquares, x: np.ndarray) -> Minimum:
    """Least squares from unknowns x (d + k,), recorded in the journal as a separate start."""
    unknowns, journal = problem.unknowns, problem.journal
    at = candidate(problem, polynomial, x)

    def moved(x: np.ndarray) -> Candidate:
        nonlocal at
        if not np.array_equal(at.x, x):
            at = candidate(problem, polynomial, x)
        return at

    def residual(x: np.ndarray) -> np.ndarray:
        return problem.residual(moved(x).bounds.lower, at.bounds.upper)

    def jacobian(x: np.ndarray) -> np.ndarray:
        return jacobian_of(problem, polynomial, moved(x))

    def progress(now: Progress) -> None:
        journal.step(now.best, unknowns.physical(now.x), problem.shape[0])

    journal.began(unknowns.physical(x))
    minimum = method.minimise(
        residual,
        jacobian,
        unknowns.lower,
        unknowns.upper,
        x,
        scale=unknowns.upper - unknowns.lower,
        on_iteration=progress,
    )
    journal.ended(unknowns.physical(x), unknowns.physical(minimum.x), minimum.misfit, minimum.success, minimum.message)
    return minimum


def jacobian_of(problem: BandProblem, polynomial: ChebyshevPolynomial, at: Candidate) -> np.ndarray:
    """Jacobian of the residual by the unknowns, shape (2 × outputs, d + k)."""
    by_lower, by_upper = slopes(problem, polynomial, at)
    of_lower, of_upper = problem.unknowns.slopes(at.x)
    return by_lower @ of_lower + by_upper @ of_upper


def screened(problem: BandProblem, polynomial: ChebyshevPolynomial, number: int, starts: int, seed: int) -> np.ndarray:
    """The best of ``number`` scattered boxes as starts, unknowns (up to starts, d + k), no two of them close."""
    unknowns = problem.unknowns
    width = unknowns.upper - unknowns.lower
    x = unknowns.lower + width * latin_hypercube(len(width), number, np.random.default_rng((seed, 1)))
    bounded = bounds(polynomial, *unknowns.ends(x))
    order = x[np.argsort(problem.misfit(bounded.lower, bounded.upper), kind="stable")]
    chosen = order[:1]
    for start in order[1:]:
        if len(chosen) == starts:
            break
        if np.all(np.max(np.abs(chosen - start) / width, axis=1) > APART):
            chosen = np.concatenate([chosen, start[None]])
    return chosen
