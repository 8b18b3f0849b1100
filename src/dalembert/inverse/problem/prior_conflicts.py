"""Priors that contradict the data, as findings."""

from collections.abc import Iterator

import numpy as np
from scipy.special import ndtr, ndtri

from dalembert.findings import Finding
from dalembert.inverse.problem.prior import prior_residual, prior_slopes
from dalembert.inverse.problem.search_coordinates import off_bounds
from dalembert.parameters import Parameters
from dalembert.priors import SquarePrior

CONFLICT = 3.0
"""Standard deviations between data and a single prior from which they contradict each other: 0.3 % by chance.

Several priors share this probability.
"""

SEEN, BLIND = 1e-10, 1e-3
"""Part of the largest information that the data see, and of a parameter that may lie in directions they do not see."""


def prior_conflicts(
    parameters: Parameters, values: np.ndarray, unit: np.ndarray, information: np.ndarray, gradient: np.ndarray
) -> Iterator[Finding]:
    """Yield findings on priors that contradict the data, by the linearised likelihood. ``values`` (parameters,).
    ``unit`` (parameters,): ∂p/∂z of the coordinates z. ``information`` (parameters, parameters): of the data alone
    about z. ``gradient`` (parameters,): of the log-likelihood of the data by z.

    With the residual r of a prior, its change Δr up to the maximum of the likelihood alone and the standard deviation s
    that the data leave in it, (r + Δr)/√(1 + s²) is standard normal if prior and data agree.
    """
    known, directions = np.linalg.eigh(information)
    seen = known > SEEN * known[-1] if len(known) and known[-1] > 0 else np.zeros(len(known), dtype=bool)
    if not np.any(seen):
        return
    rows = directions[:, seen]
    covariance = rows / known[seen] @ rows.T
    blind = np.sqrt(np.sum(directions[:, ~seen] ** 2, axis=1))
    step = covariance @ gradient
    number = sum(isinstance(item.distribution, SquarePrior) for item in parameters)
    limit = CONFLICT if number < 2 else -float(ndtri(ndtr(-CONFLICT) / number))
    for k, item in enumerate(parameters):
        prior = item.distribution
        if not isinstance(prior, SquarePrior) or blind[k] > BLIND:
            continue
        rate = float(prior.residual_slope(values[k])) * unit[k]
        residual = float(prior.residual(values[k])) + rate * step[k]
        apart = abs(residual) / np.sqrt(1 + rate**2 * covariance[k, k])
        if apart > limit:
            yield Finding(
                "prior-conflict",
                "warning",
                {"parameter": item.name, "deviations": float(apart)},
                f"The prior of {item.name!r} excludes what the data show: they are {apart:.1f} standard deviations "
                "apart.",
                "Correct the prior, or look for what the model lacks.",
            )


def conflicts_of_minimum(
    parameters: Parameters, values: np.ndarray, deviations: np.ndarray, correlation: np.ndarray
) -> Iterator[Finding]:
    """Yield the same at the minimum of a fit, where the gradients of data and priors cancel. ``values``, ``deviations``
    (parameters,): identified values and their standard deviations with the priors. ``correlation`` (parameters,
    parameters).
    """
    free = off_bounds(parameters, values)
    if not len(parameters.square_priors) or not np.all(np.isfinite(deviations)) or not np.all(free):
        return
    slopes = prior_slopes(parameters, values, deviations)
    information = np.linalg.pinv(correlation, hermitian=True) - slopes.T @ slopes
    gradient = slopes.T @ prior_residual(parameters, values)
    yield from prior_conflicts(parameters, values, deviations, information, gradient)
