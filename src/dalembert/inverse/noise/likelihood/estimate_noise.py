"""Estimate the noise together with the parameters of a model."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from dalembert.errors import InputError, counted
from dalembert.inverse.least_squares.estimate import Estimate, estimate
from dalembert.inverse.noise.correlation.series import Series
from dalembert.inverse.noise.likelihood.estimated_noise import EstimatedNoise
from dalembert.inverse.noise.likelihood.expansion import Expansion, expanded
from dalembert.inverse.noise.likelihood.guesses import guessed
from dalembert.inverse.noise.likelihood.likelihood import Likelihood, placed_likelihood
from dalembert.inverse.noise.likelihood.maximum import Maximum, Objective, maximum
from dalembert.inverse.noise.likelihood.orders import ordered
from dalembert.inverse.noise.likelihood.placing import Noise, base_of, picked_models
from dalembert.inverse.noise.models.correlated_noise import CorrelatedNoise
from dalembert.inverse.noise.models.independent_noise import ProportionalNoise
from dalembert.inverse.noise.models.noise_model import NoiseModel
from dalembert.inverse.problem.prior import prior_slopes
from dalembert.inverse.problem.problem import Linearisation, MisfitProblem

STEP = 1e-4
"""Step of differences of the gradient, in standard deviations of a noise parameter."""


ZERO = 1e-12
"""Part of a channel's largest response below which a response is 0."""


@dataclass(frozen=True, eq=False)
class NoiseFit:
    """Model and noise at the maximum of their restricted likelihood."""

    likelihood: Likelihood
    maximum: Maximum
    noise: EstimatedNoise
    estimate: Estimate  # of the model's parameters, at unit variance
    weights: np.ndarray  # (samples, channels): 1/σ² with the deviation σ of each fitted value, else 0
    # slopes: (values + priors, parameters): whitened jacobian times the parameters' scale; one row each of (samples,
    # channels), then one a prior
    slopes: np.ndarray

    @property
    def values(self) -> np.ndarray:
        """Values of the model's parameters."""
        return self.at.vector

    @property
    def at(self) -> Linearisation:
        return self.maximum.expansion.at


def estimate_noise(problem: MisfitProblem, noise: Noise, at: Linearisation, *, known: bool) -> NoiseFit:
    """Return model and noise at the maximum of the restricted likelihood, from a plain minimum.

    ``at``: at the plain minimum. ``known``: whether the weights of the problem are 1/variance.
    """
    count = len(problem.model.parameters)
    if problem.compared < count:
        values, parameters = counted(problem.compared, "value"), counted(count, "parameter")
        raise InputError(
            f"identify: {values} cannot determine {parameters} and the noise; "
            "measure more samples, fix parameters, or leave noise out"
        )
    noise_by_name, _ = picked_models(problem, noise, known=known)
    picked = ordered(problem, noise_by_name, at, known=known)
    likelihood, optimum = _largest(problem, picked, at, known=known)
    again = ordered(problem, noise_by_name, optimum.expansion.at, known=known)
    if again != picked:  # the residuals of the better fit have another order
        picked = again
        likelihood, optimum = _largest(problem, picked, optimum.expansion.at, known=known)
    model = problem.model.parameters
    few = problem.compared + len(model.square_priors) <= len(model)  # no residual is left to estimate the noise from
    variance = np.nan if few and len(likelihood.noise_parameters) else 1.0
    return NoiseFit(
        likelihood,
        optimum,
        _noise(likelihood, optimum, picked),
        estimate(_slopes(likelihood, optimum), model.scale, variance),
        _weights(likelihood, optimum),
        _table_of(likelihood, optimum),
    )


def _largest(
    problem: MisfitProblem, picked: Mapping[Series, NoiseModel], at: Linearisation, *, known: bool
) -> tuple[Likelihood, Maximum]:
    """Return the likelihood with these noise models, and its maximum near a linearised response."""
    likelihood = placed_likelihood(
        problem, picked, {signal.name: model for signal, model in picked.items()}, known=known
    )
    _check_response(likelihood, at)
    start = guessed(likelihood.channels, likelihood.noise_parameters, problem, at.response)
    return likelihood, maximum(likelihood, np.concatenate([at.vector, start]), at=at)


def _check_response(likelihood: Likelihood, at: Linearisation) -> None:
    """Refuse noise that is proportional to a response of zero."""
    for channel in likelihood.channels:
        series, response = channel.series, at.response.ravel()[channel.series.rows]
        model = channel.model.deviation if isinstance(channel.model, CorrelatedNoise) else channel.model
        zero = np.flatnonzero(np.abs(response) <= ZERO * np.max(np.abs(response)))
        if isinstance(model, ProportionalNoise) and len(zero):
            where = f"{series.along[zero[0]]:.6g} {series.unit}".rstrip()
            raise InputError(
                f"noise of channel {series.name!r}: ProportionalNoise was given, but the response is 0 at {where}, "
                "where it allows no noise; take MixedNoise()"
            )


def _slopes(likelihood: Likelihood, optimum: Maximum) -> np.ndarray:
    """Return slopes S with the information SᵀS on p/scale that is left where the noise parameters are unknown too."""
    model = likelihood.problem.model.parameters
    count = len(model)
    rows = _expected_rows(optimum.expansion, count)
    of_model, noise = rows[:, :count] * model.scale, rows[:, count:]
    size = np.linalg.norm(noise, axis=0)
    noise = noise[:, size > 0] / size[size > 0]
    left = of_model - noise @ np.linalg.lstsq(noise, of_model, rcond=None)[0] if noise.size else of_model
    return np.concatenate([left, prior_slopes(model, optimum.expansion.at.vector, model.scale)])


def _expected_rows(expansion: Expansion, count: int) -> np.ndarray:
    """Return rows G with the information GᵀG, without what the mean of model and noise share. That is zero in
    expectation: a change of the noise changes the mean of a value in proportion to residuals before it. ``count``:
    number of the model's parameters.
    """
    of_model, noise = expansion.means.copy(), expansion.means.copy()
    of_model[:, count:], noise[:, :count] = 0.0, 0.0
    return np.concatenate([of_model, noise, np.sqrt(2) * expansion.spreads])


def _noise(likelihood: Likelihood, optimum: Maximum, picked: Mapping[Series, NoiseModel]) -> EstimatedNoise:
    parameters, count = likelihood.noise_parameters, len(likelihood.problem.model.parameters)
    covariance = _noise_covariance(likelihood, optimum)
    deviations = np.sqrt(np.diag(covariance))
    width = len(likelihood.problem.data.channels)
    whitened = np.full(likelihood.problem.weights.size, np.nan)
    whitened[np.concatenate([channel.series.rows for channel in likelihood.channels])] = optimum.expansion.white
    return EstimatedNoise(
        models={signal.name: model for signal, model in picked.items()},
        bases={signal.name: base_of(signal, model) for signal, model in picked.items()},
        parameters=parameters,
        values=optimum.vector[count:],
        deviations=deviations,
        correlation=covariance / (deviations[:, None] * deviations),
        log_likelihood=optimum.expansion.value,
        whitened=whitened.reshape(-1, width),
    )


def _noise_covariance(likelihood: Likelihood, optimum: Maximum) -> np.ndarray:
    """Return the covariance of the noise parameters, from the curvature of the restricted likelihood:
    −∂²ℓ/∂ν² − Cᵀ I⁻¹ C for the noise parameters ν, with C = −∂²ℓ/∂θ∂ν and the information I on the model's parameters
    θ, which follow the noise. Where that is not positive, as at a bound, the expected information takes its place.
    """
    model = likelihood.problem.model.parameters
    count = len(model)
    rows = _expected_rows(optimum.expansion, count)
    prior = prior_slopes(model, optimum.vector[:count], np.ones(count))
    rows = np.concatenate([rows, np.pad(prior, ((0, 0), (0, rows.shape[1] - count)))])
    expected = rows.T @ rows
    observed = _curvature(likelihood, optimum)
    for cross, diagonal_block in (
        (observed[:count], observed[count:]),
        (expected[:count, count:], expected[count:, count:]),
    ):
        if not np.all(np.isfinite(cross)):
            continue
        information = diagonal_block - cross.T @ np.linalg.lstsq(expected[:count, :count], cross, rcond=1e-12)[0]
        if not np.all(np.diag(information) > 0):
            continue
        size = np.sqrt(np.diag(information))
        scaled = information / (size[:, None] * size)
        if np.all(np.linalg.eigvalsh(scaled) > 1e-12):
            return np.linalg.inv(scaled) / (size[:, None] * size)
    return np.full(diagonal_block.shape, np.nan)


def _curvature(likelihood: Likelihood, optimum: Maximum) -> np.ndarray:
    """Return negative second derivatives of the restricted likelihood by all and by the noise parameters.

    Shape (parameters, noise parameters).
    """
    problem, count = likelihood.problem, len(optimum.expansion.at.vector)
    objective = Objective(likelihood.parameters, problem.model.parameters, optimum.restriction)
    ones = np.ones(len(optimum.vector))
    columns = np.zeros((len(optimum.vector), len(optimum.vector) - count))
    for place in range(count, len(optimum.vector)):
        step = np.zeros(len(optimum.vector))
        item = likelihood.parameters.items[place]
        step[place] = STEP * (abs(optimum.vector[place]) if item.log else item.upper - abs(optimum.vector[place]))
        ends = [
            objective.slopes(
                expanded(
                    problem,
                    likelihood.channels,
                    likelihood.parameters,
                    optimum.expansion.at,
                    optimum.vector + way * step,
                ),
                ones,
            )[0]
            for way in (1, -1)
        ]
        with np.errstate(invalid="ignore", divide="ignore"):  # at a bound the step is zero
            columns[:, place - count] = (ends[1] - ends[0]) / (2 * step[place])
    columns[count:] = (columns[count:] + columns[count:].T) / 2
    return columns


def _weights(likelihood: Likelihood, optimum: Maximum) -> np.ndarray:
    flat, response = np.zeros(likelihood.problem.weights.size), optimum.expansion.at.response.ravel()
    known = likelihood.parameters.arguments(optimum.vector)
    for channel in likelihood.channels:
        places = channel.series.rows
        sizes = channel.model.deviations(response[places], channel.given, channel.values(known))
        flat[places] = np.asarray(sizes, dtype=float) ** -2
    return flat.reshape(likelihood.problem.weights.shape)


def _table_of(likelihood: Likelihood, optimum: Maximum) -> np.ndarray:
    """Return whitened slopes of the mean, one row for each of (samples, channels), then one a prior."""
    model = likelihood.problem.model.parameters
    table = np.zeros((likelihood.problem.weights.size, len(model)))
    rows = np.concatenate([channel.series.rows for channel in likelihood.channels])
    table[rows] = optimum.expansion.means[:, : len(model)] * model.scale
    return np.concatenate([table, prior_slopes(model, optimum.expansion.at.vector, model.scale)])
