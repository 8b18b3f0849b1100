"""The published method: a separate surrogate for every candidate box, and a swarm of boxes."""

from dataclasses import dataclass, field

import numpy as np

from dalembert.arguments import Checked
from dalembert.errors import InputError, SolveError
from dalembert.inverse.bands.band_problem import BandProblem
from dalembert.inverse.bands.candidate import candidate
from dalembert.inverse.bands.check import BandSolution, check
from dalembert.inverse.problem.surrogates import surrogate_of
from dalembert.optimize import ImprovedParticleSwarm, ParticleSwarm, Progress
from dalembert.surrogate import ChebyshevPolynomial, TotalDegree, bounds
from dalembert.surrogate.basis import chebyshev, products, total_degree

# Sides of the answer narrower than twice this part of the parameters' bounds are widened to that for its last
# surrogate, so that it has slopes there.
WIDENED = 1e-3


@dataclass(frozen=True)
class Nested(Checked):
    """A swarm of candidate boxes, each bounded on a separate surrogate; a whole swarm is one batch of runs.

    Parameters
    ----------
    swarm : ImprovedParticleSwarm or ParticleSwarm
    scheme : TotalDegree
        The published order 2 from 12 runs for two intervals.

    Notes
    -----
    It costs particles × iterations × runs of the scheme. A box is as bad as can be when one of its runs fails.

    Source: Guo & Jin, Inverse dynamical problem of flexible multibody systems with interval uncertainty, 2025.
    """

    swarm: ImprovedParticleSwarm | ParticleSwarm = field(default_factory=ImprovedParticleSwarm)
    scheme: TotalDegree = field(default_factory=TotalDegree)

    @property
    def name(self) -> str:
        return f"nested {type(self.swarm).__name__}"

    def search(self, problem: BandProblem, seed: int) -> BandSolution:
        """The best box.

        Raises
        ------
        SolveError
            If not one candidate could be simulated.
        """
        unknowns, journal = problem.unknowns, problem.journal
        if not len(unknowns.chosen):
            raise InputError("no intervals were given; expected the name of at least one parameter")
        # Coordinates (runs, k) of a surrogate's runs, exponents (terms, k), and values to coefficients (terms, runs).
        eta = self.scheme.points(len(unknowns.chosen))
        exponents = total_degree(len(unknowns.chosen), self.scheme.order)
        solve = np.linalg.pinv(products(chebyshev(eta, exponents.max(axis=0)), exponents))

        def misfit(x: np.ndarray) -> np.ndarray:
            lower, upper = unknowns.ends(x)
            points = np.repeat(lower[:, None], len(eta), axis=1)
            width = (upper - lower)[:, None, unknowns.chosen]
            points[..., unknowns.chosen] += (1 + eta) / 2 * width
            values = problem.run(points.reshape(-1, points.shape[-1])).reshape(len(x), len(eta), -1)
            ok = np.all(np.isfinite(values), axis=(1, 2))
            result = np.full(len(x), np.inf)
            if not ok.any():
                return result
            coefficients = np.moveaxis(solve @ values[ok], 1, 0).reshape(len(exponents), -1)
            ones = np.ones(eta.shape[1])
            bounded = bounds(ChebyshevPolynomial(-ones, ones, exponents, coefficients), -ones, ones)
            result[ok] = problem.misfit(*(side.reshape(ok.sum(), -1) for side in (bounded.lower, bounded.upper)))
            return result

        def progress(now: Progress) -> None:
            journal.step(now.best, unknowns.physical(now.x), problem.shape[0])

        journal.began(None)
        best = self.swarm.minimise(misfit, unknowns.lower, unknowns.upper, seed, on_iteration=progress)
        nowhere = np.full_like(unknowns.lower, np.nan)
        end = unknowns.physical(best.x) if best.success else nowhere
        journal.ended(nowhere, end, best.misfit, best.success, best.message)
        if not best.success:
            raise SolveError(
                f"none of the {best.evaluations} candidate boxes could be simulated; the first failure: "
                f"{journal.failures[0]}; look at the model there, or change the bounds"
            )
        return self._told(problem, best.x, best.message, seed)

    def _told(self, problem: BandProblem, x: np.ndarray, message: str, seed: int) -> BandSolution:
        """The best box once more, with a surrogate that also has slopes in directions without width, and a check."""
        search = problem.unknowns.search
        lower, upper = problem.unknowns.ends(x)
        least = WIDENED * (search.upper - search.lower)
        thin = upper - lower < 2 * least
        middle = np.clip((lower + upper) / 2, search.lower + least, search.upper - least)
        surrogate = surrogate_of(
            problem.run,
            np.where(thin, middle - least, lower),
            np.where(thin, middle + least, upper),
            self.scheme,
            problem.journal,
            shape=problem.shape,
            seed=seed,
            held_out=0,
        )
        at = candidate(problem, surrogate.polynomial, x)
        checked = check(problem, surrogate.polynomial, at)
        error = surrogate.error if checked is None else checked.error
        return BandSolution(surrogate.polynomial, at, error, checked, True, message)
