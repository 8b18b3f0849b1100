"""Points all over the prior, and those of them near which a mode may be."""

import numpy as np
from scipy.spatial import KDTree

from dalembert.inverse.likelihood.guesses import guessed
from dalembert.inverse.likelihood.likelihood import Likelihood
from dalembert.inverse.posterior.prior_density import PriorDensity
from dalembert.inverse.posterior.target import Target
from dalembert.inverse.problem.search_coordinates import SearchCoordinates
from dalembert.latin_hypercube import latin_hypercube
from dalembert.parameters import Parameters
from dalembert.priors import CorrelatedNormal

# Neighbours on each side, for each parameter, that a point must exceed to be a local maximum of the points.
NEIGHBOURS = 2


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

    Parameters
    ----------
    vectors : array, shape (batch, parameters of the model)
    """
    noise, problem = likelihood.noise_parameters, likelihood.problem
    responses = problem.responses(vectors)
    failed = ~np.all(np.isfinite(responses), axis=(1, 2))
    sizes = np.tile(noise.start, (len(vectors), 1))
    for k in np.flatnonzero(~failed) if len(noise) else ():
        sizes[k] = guessed(likelihood.channels, noise, problem, responses[k])
    whole = np.concatenate([vectors, sizes], axis=1)
    values = np.sum(likelihood.of_responses(whole, responses), axis=1)
    return whole, np.where(failed | np.isnan(values), -np.inf, values)


def hopeful(target: Target, count: int, seed: int) -> np.ndarray:
    """Return the local maxima of the posterior among points over the prior, the largest first, (n, parameters).

    A point is a local maximum where its nearest neighbours have smaller densities.

    Source: A. Törn and S. Viitanen, Topographical global optimization, in Recent Advances in Global Optimization, 1992.
    """
    own = target.problem.model.parameters
    vectors, likelihoods = with_guessed_noise(target.likelihood, over_prior(own, count, seed))
    density = target.density(target.coordinates.points(vectors), vectors, likelihoods)
    search = SearchCoordinates(own)
    positions = search.points(vectors[:, : len(own)]) / (search.upper - search.lower)
    near = min(count - 1, 2 * NEIGHBOURS * len(own))
    _, neighbours = KDTree(positions).query(positions, k=near + 1)
    largest = np.isfinite(density) & np.all(density[:, None] >= density[neighbours], axis=1)
    order = np.argsort(-density, kind="stable")
    return vectors[order[largest[order]]]
