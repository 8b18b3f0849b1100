"""The step of an identification in which the noise is estimated with the parameters."""

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from dalembert.data import Measurements
from dalembert.errors import InputError, SolveError, listed
from dalembert.findings import Finding
from dalembert.inverse.experiments.validation import Split
from dalembert.inverse.least_squares.descent import End
from dalembert.inverse.noise.likelihood.estimate_noise import NoiseFit, estimate_noise
from dalembert.inverse.noise.likelihood.estimated_noise import EstimatedNoise
from dalembert.inverse.noise.likelihood.noise_model_findings import noise_model_findings
from dalembert.inverse.noise.likelihood.placing import Noise, picked_models
from dalembert.inverse.noise.models.correlated_noise import AutoregressiveNoise
from dalembert.inverse.noise.models.noise_model import NoiseModel
from dalembert.inverse.problem.matching import weights_of
from dalembert.inverse.problem.prior import prior_residual
from dalembert.inverse.problem.problem import MisfitProblem


def counted_values(weights: ArrayLike | None, data: Measurements) -> np.ndarray | None:
    """Return which values count, 1 or 0, beside a noise model, from which all other weights follow.

    Raises
    ------
    InputError
        For other weights.
    """
    if weights is None:
        return None
    found = weights_of(weights, data.values.shape)
    other = found[(found != 0) & (found != 1)]
    if len(other):
        raise InputError(
            f"weights: {other[0]:.6g} was given beside a noise model, from which the weights follow; expected 1, or 0 "
            "for a value to leave out"
        )
    return found


def check_noise(noise: Noise | None, *, loss: str, shooting: object) -> None:
    """Refuse what cannot be combined with a noise model.

    Raises
    ------
    InputError
    """
    if noise is None:
        return
    if loss != "linear":
        raise InputError(
            f"loss: a noise model was given, whose likelihood is that of normal noise; leave the loss {loss!r} or the "
            "noise out"
        )
    if shooting is not None:
        raise InputError(
            "shooting: a noise model was given, but segments that must meet leave no likelihood of one run; leave one "
            "of the two out"
        )


def with_noise(problem: MisfitProblem, noise: Noise, best: End, *, known: bool) -> tuple[MisfitProblem, End, NoiseFit]:
    """Return the problem with the weights of the estimated noise, the end of the search with it, and the noise.

    Parameters
    ----------
    problem : Problem
    noise : NoiseModel, its name, or mapping of channel to NoiseModel
    best : End
        Of the search without noise.
    known : bool
        Whether the weights of the problem are 1/variance.

    Raises
    ------
    InputError
        For noise models that the data do not allow.
    SolveError
        Where the model has no sensitivities.
    """
    picked_models(problem, noise, known=known)
    try:
        at = best.linearisation or problem.linearise(problem.search.vectors(best.point))
    except SolveError as error:
        raise SolveError(
            f"noise: the noise is estimated by the sensitivities of the response, which has none: {error}; leave the "
            "noise out"
        ) from error
    found = estimate_noise(problem, noise, at, known=known)
    weighted = replace(problem, weights=found.weights)
    squares = float(np.sum(weighted.squares(found.at.response)))
    prior = prior_residual(problem.model.parameters, found.values)
    end = replace(
        best,
        point=problem.search.points(found.values),
        misfit=squares + float(prior @ prior),
        success=best.success and found.maximum.success,
        message=best.message if found.maximum.success else found.maximum.message,
        linearisation=found.at,
    )
    return weighted, end, found


def whole_weights(parted: Split, problem: MisfitProblem) -> np.ndarray:
    """Return the weights of a fitted part among those of the whole problem, (samples, channels); 0 elsewhere."""
    return np.where(parted.fitted, _whole(parted, problem, problem.weights, 0.0), 0.0)


def whole_noise(parted: Split, problem: MisfitProblem, noise: EstimatedNoise) -> EstimatedNoise:
    """Return the noise of a fitted part with its residuals among those of the whole problem; NaN elsewhere."""
    return replace(noise, whitened=_whole(parted, problem, noise.whitened, np.nan))


def _whole(parted: Split, problem: MisfitProblem, table: np.ndarray, missing: float) -> np.ndarray:
    whole = np.full(parted.whole.weights.shape, missing)
    columns = [parted.whole.data.channels.index(name) for name in problem.data.channels]
    whole[: problem.samples, columns] = table
    return whole


def noise_findings(found: NoiseFit) -> tuple[Finding, ...]:
    """Return what was estimated of the noise, and what speaks against the noise model."""
    against = tuple(noise_model_findings(found))
    models = {name: _in_words(model) for name, model in found.noise.models.items()}
    words = [
        f"of {listed([repr(name) for name, one in models.items() if one == kind])}: {kind}"
        for kind in dict.fromkeys(models.values())
    ]
    white = not any(item.code == "noise-model-too-simple" for item in against)
    message = f"The noise is estimated with the parameters, {'; '.join(words)}."
    message += " Whitened by it, the residuals are not correlated." if white else ""
    values = {"log_likelihood": found.noise.log_likelihood, "parameters": len(found.noise.parameters)}
    return (Finding("noise-estimated", "note", values, message), *against)


def _in_words(model: NoiseModel) -> str:
    """Return a noise model in words, such as "autoregressive of order 2, mixed"."""
    order = f" of order {model.order}" if isinstance(model, AutoregressiveNoise) else ""
    inner = getattr(model, "deviation", None)
    return f"{model.name}{order}" + (f", {inner.name}" if isinstance(inner, NoiseModel) else "")
