"""Estimate the noise together with the parameters, from the minimum of a search."""

from dataclasses import replace

import numpy as np

from dalembert.errors import SolveError
from dalembert.inverse.identification.pose import PosedIdentification
from dalembert.inverse.identification.search import MisfitMinimum
from dalembert.inverse.noise.likelihood.estimate_noise import estimate_noise
from dalembert.inverse.noise.likelihood.placing import picked_models
from dalembert.inverse.noise.noise_floor import noise_floor
from dalembert.inverse.problem.prior import prior_residual


def with_noise(posed: PosedIdentification, minimum: MisfitMinimum) -> MisfitMinimum:
    """Return the minimum with the weights of the estimated noise; the same minimum without a noise model."""
    if posed.noise is None:
        return minimum
    problem, best, known = minimum.problem, minimum.end, posed.noise_is_given
    picked_models(problem, posed.noise, known=known)
    try:
        at = best.linearisation or problem.linearise(problem.search.vectors(best.point))
    except SolveError as error:
        raise SolveError(
            f"noise: the noise is estimated by the sensitivities of the response, which has none: {error}; leave the "
            "noise out"
        ) from error
    fit = estimate_noise(problem, posed.noise, at, known=known)
    weighted = replace(problem, weights=fit.weights)
    squares = float(np.sum(weighted.squares(fit.at.response)))
    prior = prior_residual(problem.model.parameters, fit.values)
    end = replace(
        best,
        point=problem.search.points(fit.values),
        misfit=squares + float(prior @ prior),
        success=best.success and fit.maximum.success,
        message=best.message if fit.maximum.success else fit.maximum.message,
        linearisation=fit.at,
    )
    return MisfitMinimum(weighted, end, noise_floor(weighted), minimum.ends, fit)
