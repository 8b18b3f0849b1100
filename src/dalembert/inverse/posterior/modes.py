"""Modes of a posterior: where its chains start."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import KDTree

from dalembert.errors import SolveError
from dalembert.inverse.least_squares.descent import End, refine
from dalembert.inverse.noise.likelihood.guesses import guessed
from dalembert.inverse.noise.likelihood.likelihood import Likelihood
from dalembert.inverse.posterior.model_variants import WithoutPriors
from dalembert.inverse.posterior.posed import Length, PosedPosterior, SearchStart
from dalembert.inverse.posterior.preconditioning import Centred, centred
from dalembert.inverse.posterior.prior_density import PriorDensity
from dalembert.inverse.posterior.target import Target
from dalembert.inverse.problem.journal import Journal
from dalembert.inverse.problem.problem import MisfitProblem
from dalembert.inverse.problem.search_coordinates import SearchCoordinates
from dalembert.latin_hypercube import latin_hypercube
from dalembert.optimize import LeastSquares
from dalembert.parameters import Parameters
from dalembert.priors import CorrelatedNormal

LEAST_SHARE = 0.01  # part of the probability below which a mode is left out: it moves no interval that is shown
# Most searches for further modes; a search without gradients costs hundreds of simulations.
CLIMBS, CLIMBS_WITHOUT_GRADIENTS = 8, 3
LOWEST = 30.0  # log density below that of the best mode at which a climb by least squares is left
NEAR = 2.0  # distance from a mode, in its standard deviations, up to which the end of a climb counts as this mode
DIP = 2.0  # fall of the log density between two ends, below the lower one, from which they are two modes
# Neighbours on each side, for each parameter, that a point must exceed to be a local maximum of the points.
NEIGHBOURS = 2
BETWEEN = 9  # points at which the density between two ends is computed
# Draws for each point of the prior at which the search of modes looks, and the fewest and most points.
EXPLORED, FEWEST, MOST = 20, 32, 400


@dataclass(frozen=True, eq=False)
class PosteriorModes:
    """The modes of a posterior, that of the largest density first."""

    centred: tuple[Centred, ...]
    shares: np.ndarray  # (modes,): of the probability, by the normal approximation of each mode (Laplace)

    @property
    def best(self) -> Centred:
        """The mode of the largest density."""
        return self.centred[0]

    @property
    def targets(self) -> tuple[Target, ...]:
        """The density in the coordinates in which each mode is round."""
        return tuple(mode.target for mode in self.centred)

    def of(self, problem: MisfitProblem) -> "PosteriorModes":
        """Return the same modes with the model of another problem."""
        known = tuple(replace(mode, target=mode.target.of(problem)) for mode in self.centred)
        return replace(self, centred=known)

    def of_chains(self, chains: int) -> np.ndarray:
        """Return the mode (chains,) at which each chain starts: each mode has one, the others follow the shares.

        >>> PosteriorModes((), np.array([0.7, 0.3])).of_chains(4).tolist()
        [0, 0, 0, 1]
        """
        counts = np.zeros(len(self.shares), dtype=int)
        counts[np.argsort(-self.shares, kind="stable")[:chains]] = 1
        while counts.sum() < chains:  # the next chain goes to the mode that has the fewest for its share (D'Hondt)
            counts[np.argmax(self.shares / (counts + 1))] += 1
        return np.repeat(np.arange(len(counts)), counts)


def find_modes(posed: PosedPosterior, start: SearchStart, length: Length, *, gradients: bool) -> PosteriorModes:
    """Return the modes that are reached from a start, from all over the prior and from the ends of a fit's starts.

    ``gradients`` says whether the model has a jacobian; the effort of the search follows from the length of the chains.
    """
    known = posed.likelihood, posed.parameters
    first = centred(*known, start.vector, gradients=gradients)
    ends = [] if start.fit is None else [end.end for end in start.fit.starts if np.isfinite(end.misfit)]
    modes = [first]
    starts = _starts(first.target, ends, posed.known_noise, length, gradients=gradients)
    for vector in starts:
        point = first.target.coordinates.points(vector)
        if any(np.linalg.norm(mode.target.places(point)) < NEAR for mode in modes):
            continue
        if first.target.evaluate(first.target.places(point)[None])[0] < max(map(_height, modes)) - LOWEST:
            continue
        try:
            end = centred(*known, vector, gradients=gradients, local=True)
        except SolveError:
            continue
        if all(_apart(end, mode) for mode in modes):
            modes.append(end)
    modes.sort(key=_height, reverse=True)
    # Laplace's approximation: a mode has the probability p(mode) √det(2π Σ) with Σ = factor factorᵀ, up to a constant.
    masses = np.array([_height(mode) + np.linalg.slogdet(mode.target.factor)[1] for mode in modes])
    shares = np.exp(masses - np.max(masses))
    shares /= shares.sum()
    kept = [k for k in range(len(modes)) if shares[k] >= LEAST_SHARE]
    return PosteriorModes(tuple(modes[k] for k in kept), shares[kept] / np.sum(shares[kept]))


def _starts(
    target: Target, ends: Sequence[np.ndarray], known_noise: bool, length: Length, *, gradients: bool
) -> Iterator[np.ndarray]:
    """Yield vectors (parameters,) near which a mode may be, at most one in each minimum of least squares."""
    likelihood, count = target.likelihood, len(target.problem.model.parameters)
    explored = local_maxima(target, int(np.clip(length.total // EXPLORED, FEWEST, MOST)), length.seed)[:, :count]
    ends = _distinct(target, ends)
    points = [*ends, *explored][: len(ends) + (CLIMBS if gradients else CLIMBS_WITHOUT_GRADIENTS)]
    if not gradients:
        yield from with_guessed_noise(likelihood, np.array(points))[0] if points else ()
        return
    quiet = replace(likelihood.problem, journal=Journal(likelihood.problem.samples))
    if not known_noise:  # the weights are not those of the noise, so they set no weight of data against priors
        quiet = replace(quiet, model=WithoutPriors.of(quiet.model))
        quiet = replace(quiet, search=SearchCoordinates(quiet.model.parameters))
    climbed: list[np.ndarray] = []
    for point in points:
        end = refine(quiet, LeastSquares(), End(quiet.search.points(point), np.inf, False, ""))
        if np.isfinite(end.misfit):
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
    return float(mode.target.evaluate(np.zeros((1, len(mode.vector))))[0])


def _apart(end: Centred, known: Centred) -> bool:
    """Return True if the density falls between two ends, which are then two modes."""
    first, last = (mode.target.centre for mode in (end, known))
    if min(np.linalg.norm(known.target.places(first)), np.linalg.norm(end.target.places(last))) < NEAR:
        return False
    # On the straight line between the ends: a dip shows two modes. A curved ridge may be taken for two, which costs a
    # chain.
    parts = np.linspace(0.0, 1.0, BETWEEN + 2)[:, None]
    density = end.target.evaluate(end.target.places(first + parts * (last - first)))
    return bool(np.min(density) < min(density[0], density[-1]) - DIP)


def over_prior(parameters: Parameters, count: int, seed: int) -> np.ndarray:
    """Return vectors (count, parameters): a Latin hypercube of the priors, of the search coordinates without them."""
    unit = latin_hypercube(len(parameters), count, np.random.default_rng((seed, 2)))
    search = SearchCoordinates(parameters)
    vectors = search.vectors(search.lower + (search.upper - search.lower) * unit)
    jointly = [k for k, item in enumerate(parameters) if isinstance(item.prior, CorrelatedNormal)]
    for k, item in enumerate(parameters):
        if item.prior is not None or item.deviation is not None:
            vectors[:, k] = item.distribution.within(unit[:, k], item.lower, item.upper)
    if jointly:
        vectors[:, jointly] = PriorDensity(parameters).draws(count, seed)[:, jointly]
    return vectors


def with_guessed_noise(likelihood: Likelihood, vectors: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return vectors with noise by their residuals, and their log-likelihoods (batch,); −∞ where a simulation failed.

    ``vectors`` (batch, parameters of the model).
    """
    noise, problem = likelihood.noise_parameters, likelihood.problem
    responses = problem.responses(vectors)
    failed = ~np.all(np.isfinite(responses), axis=(1, 2))
    sizes = np.tile(noise.start, (len(vectors), 1))
    for k in np.flatnonzero(~failed) if len(noise) else ():
        sizes[k] = guessed(likelihood.channels, noise, problem, responses[k])
    complete = np.concatenate([vectors, sizes], axis=1)
    values = np.sum(likelihood.of_responses(complete, responses), axis=1)
    return complete, np.where(failed | np.isnan(values), -np.inf, values)


def local_maxima(target: Target, count: int, seed: int) -> np.ndarray:
    """Return the local maxima of the posterior among points over the prior, the largest first, (n, parameters). A point
    is a local maximum where its nearest neighbours have smaller densities. Source: A. Törn and S. Viitanen,
    Topographical global optimization, in Recent Advances in Global Optimization, 1992.
    """
    parameters = target.problem.model.parameters
    vectors, likelihoods = with_guessed_noise(target.likelihood, over_prior(parameters, count, seed))
    density = target.density(target.coordinates.points(vectors), vectors, likelihoods)
    search = SearchCoordinates(parameters)
    positions = search.points(vectors[:, : len(parameters)]) / (search.upper - search.lower)
    near = min(count - 1, 2 * NEIGHBOURS * len(parameters))
    # Törn & Viitanen (1992): a point of the graph of nearest neighbours without a higher neighbour is a local maximum.
    _, neighbours = KDTree(positions).query(positions, k=near + 1)
    largest = np.isfinite(density) & np.all(density[:, None] >= density[neighbours], axis=1)
    # Highest first, as only the first few are climbed from.
    order = np.argsort(-density, kind="stable")
    return vectors[order[largest[order]]]
