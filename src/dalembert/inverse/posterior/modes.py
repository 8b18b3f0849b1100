"""Modes of a posterior: where its chains start."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from dalembert.errors import SolveError
from dalembert.inverse.least_squares.descent import End, refine
from dalembert.inverse.posterior.exploration import hopeful, with_guessed_noise
from dalembert.inverse.posterior.preconditioning import Centred, centred
from dalembert.inverse.posterior.target import Target
from dalembert.inverse.posterior.unprior import WithoutPriors
from dalembert.inverse.problem.journal import Journal
from dalembert.inverse.problem.problem import Problem
from dalembert.inverse.problem.search_coordinates import SearchCoordinates
from dalembert.optimize import LeastSquares

LEAST_SHARE = 0.01  # part of the probability below which a mode is left out: it moves no interval that is shown
# Most searches for further modes; a search without gradients costs hundreds of simulations.
CLIMBS, CLIMBS_WITHOUT_GRADIENTS = 8, 3
LOWEST = 30.0  # log density below that of the best mode at which a climb by least squares is left
NEAR = 2.0  # distance from a mode, in its standard deviations, up to which the end of a climb counts as this mode
DIP = 2.0  # fall of the log density between two ends, below the lower one, from which they are two modes
BETWEEN = 9  # points at which the density between two ends is computed
# Draws for each point of the prior at which the search of modes looks, and the fewest and most points.
EXPLORED, FEWEST, MOST = 20, 32, 400


@dataclass(frozen=True, eq=False)
class Modes:
    """The modes of a posterior, that of the largest density first.

    Parameters
    ----------
    centred : tuple of Centred
    shares : array, shape (modes,)
        Of the probability, by the normal approximation of each mode (Laplace).
    """

    centred: tuple[Centred, ...]
    shares: np.ndarray

    @property
    def best(self) -> Centred:
        """The mode of the largest density."""
        return self.centred[0]

    @property
    def targets(self) -> tuple[Target, ...]:
        """The density in the coordinates in which each mode is round."""
        return tuple(one.target for one in self.centred)

    def of(self, problem: Problem) -> "Modes":
        """Return the same modes with the model of another problem."""
        known = tuple(replace(one, target=one.target.of(problem)) for one in self.centred)
        return replace(self, centred=known)

    def of_chains(self, chains: int) -> np.ndarray:
        """Return the mode (chains,) at which each chain starts: each mode has one, the others follow the shares.

        Examples
        --------
        >>> Modes((), np.array([0.7, 0.3])).of_chains(4).tolist()
        [0, 0, 0, 1]
        """
        counts = np.zeros(len(self.shares), dtype=int)
        counts[np.argsort(-self.shares, kind="stable")[:chains]] = 1
        while counts.sum() < chains:  # the next chain goes to the mode that has the fewest for its share (D'Hondt)
            counts[np.argmax(self.shares / (counts + 1))] += 1
        return np.repeat(np.arange(len(counts)), counts)


def modes(
    first: Centred, ends: Sequence[np.ndarray], *, known_noise: bool, gradients: bool, draws: int, seed: int
) -> Modes:
    """Return the modes that are reached from all over the prior and from the ends of a fit.

    Parameters
    ----------
    first : Centred
        The mode that is known.
    ends : sequence of array, shape (parameters of the model,)
        Other points from which to search: those in which the starts of a fit ended.
    known_noise : bool
        Whether the weights of the problem are those of the noise.
    gradients : bool
    draws : int
        Of all chains; the effort of the search follows from it.
    seed : int
    """
    found, known = [first], (first.target.likelihood, first.target.parameters)
    for start in _starts(first.target, ends, known_noise=known_noise, gradients=gradients, draws=draws, seed=seed):
        point = first.target.coordinates.points(start)
        if any(np.linalg.norm(one.target.places(point)) < NEAR for one in found):
            continue
        if first.target.evaluate(first.target.places(point)[None])[0] < max(map(_height, found)) - LOWEST:
            continue
        try:
            end = centred(*known, start, gradients=gradients, local=True)
        except SolveError:
            continue
        if all(_apart(end, one) for one in found):
            found.append(end)
    found.sort(key=_height, reverse=True)
    masses = np.array([_height(one) + np.linalg.slogdet(one.target.factor)[1] for one in found])
    shares = np.exp(masses - np.max(masses))
    shares /= shares.sum()
    kept = [k for k in range(len(found)) if shares[k] >= LEAST_SHARE]
    return Modes(tuple(found[k] for k in kept), shares[kept] / np.sum(shares[kept]))


def _starts(
    target: Target, ends: Sequence[np.ndarray], *, known_noise: bool, gradients: bool, draws: int, seed: int
) -> Iterator[np.ndarray]:
    """Yield vectors (parameters,) near which a mode may be, no two in one minimum of least squares."""
    likelihood, count = target.likelihood, len(target.problem.model.parameters)
    explored = hopeful(target, int(np.clip(draws // EXPLORED, FEWEST, MOST)), seed)[:, :count]
    ends = _distinct(target, ends)
    points = [*ends, *explored][: len(ends) + (CLIMBS if gradients else CLIMBS_WITHOUT_GRADIENTS)]
    if not gradients:
        yield from with_guessed_noise(likelihood, np.array(points))[0] if points else ()
        return
    quiet = replace(likelihood.problem, journal=Journal(likelihood.problem.samples))
    if not known_noise:  # the weights are not those of the noise, and priors have no weight beside them
        quiet = replace(quiet, model=WithoutPriors.of(quiet.model))
        quiet = replace(quiet, search=SearchCoordinates(quiet.model.parameters))
    climbed: list[np.ndarray] = []
    for point in points:
        end = refine(quiet, LeastSquares(), End(quiet.search.points(point), np.inf, False, ""))
        if np.isfinite(end.fitness):
            climbed.append(quiet.search.vectors(end.point))
    likelihood.problem.journal.simulations += quiet.journal.simulations
    if climbed:
        yield from with_guessed_noise(likelihood, np.array(climbed))[0]


def _distinct(target: Target, ends: Sequence[np.ndarray]) -> list[np.ndarray]:
    """Ends (parameters of the model,) of starts, those left out that repeat another one."""
    if not ends:
        return []
    points = SearchCoordinates(target.problem.model.parameters).points(np.array(ends))
    _, first = np.unique(np.round(points, 3), axis=0, return_index=True)
    return [ends[k] for k in sorted(first)]


def _height(mode: Centred) -> float:
    """Log density at a mode."""
    return float(mode.target.evaluate(np.zeros((1, len(mode.vector))))[0])


def _apart(end: Centred, known: Centred) -> bool:
    """Return True if the density falls between two ends, which are then two modes."""
    first, last = (one.target.centre for one in (end, known))
    if min(np.linalg.norm(known.target.places(first)), np.linalg.norm(end.target.places(last))) < NEAR:
        return False
    parts = np.linspace(0.0, 1.0, BETWEEN + 2)[:, None]
    density = end.target.evaluate(end.target.places(first + parts * (last - first)))
    return bool(np.min(density) < min(density[0], density[-1]) - DIP)
