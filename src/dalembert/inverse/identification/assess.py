"""Assess a minimum: accuracy of its values, error of the integrator, causes of its residuals, validation."""

from dataclasses import dataclass, replace

import numpy as np

from dalembert.inverse.fit.integration import IntegrationBias, integration_bias
from dalembert.inverse.identification.pose import PosedIdentification
from dalembert.inverse.identification.search import MisfitMinimum, SearchSettings
from dalembert.inverse.least_squares.descent import End
from dalembert.inverse.least_squares.estimate import Estimate, estimate, estimate_of, unknown_estimate
from dalembert.inverse.misfit.delays import SuspectDelay, suspect_delays
from dalembert.inverse.misfit.halves import Halves, halves
from dalembert.inverse.misfit.residuals import Residuals
from dalembert.inverse.noise.correlation.correlated_residuals import CorrelatedResiduals
from dalembert.inverse.noise.correlation.correlation import correlation
from dalembert.inverse.noise.noise_floor import NoiseFloor
from dalembert.inverse.problem.problem import Linearisation, MisfitProblem
from dalembert.inverse.validation.validation import Validation
from dalembert.optimize import Squares


@dataclass(frozen=True, eq=False)
class ResidualCauses:
    """Suspected delays, the residuals without them, and the parameters of the halves, each if it is known."""

    delays: tuple[SuspectDelay, ...] = ()
    residuals: Residuals | None = None
    halves: Halves | None = None


def residual_causes(problem: MisfitProblem, at: Linearisation | None, *, known: bool) -> ResidualCauses:
    """Return causes of the residuals at identified values; none away from a minimum. Data that a delay explains are not
    halved: the other parameters make up for the delay. ``known``: whether the noise is.
    """
    if at is None or problem.compared <= len(at.vector) + 1:
        return ResidualCauses()
    residuals = Residuals.of(problem, at, known=known)
    if not np.any(residuals.free) or not np.any(residuals.values) or not residuals.stationary:
        return ResidualCauses()
    delays, left = suspect_delays(residuals)
    return ResidualCauses(delays, left, None if delays else halves(residuals))


@dataclass(frozen=True, eq=False)
class Optimum:
    """Identified values and what is known of them: the record that checks examine."""

    posed: PosedIdentification
    settings: SearchSettings
    search: MisfitMinimum  # before the noise was estimated
    minimum: MisfitMinimum  # with the noise
    vector: np.ndarray  # (parameters,)
    linearisation: Linearisation | None
    response: np.ndarray  # (samples, channels) of the fitted part of the data
    full_response: np.ndarray  # (samples, channels) of all data
    noise_is_known: bool  # whether the deviations follow from those of the data, not from the residuals
    estimate: Estimate
    correlated: CorrelatedResiduals | None
    integration: IntegrationBias | None
    causes: ResidualCauses
    validation: Validation | None

    @property
    def problem(self) -> MisfitProblem:
        return self.minimum.problem

    @property
    def end(self) -> End:
        return self.minimum.end

    @property
    def floor(self) -> NoiseFloor:
        return self.minimum.floor

    @property
    def by_squares(self) -> bool:
        """Whether the search was by least squares."""
        return isinstance(self.settings.method, Squares)

    @property
    def correlation_is_detected(self) -> bool:
        """Whether the tests take residuals for correlated; weaker signs only enter the standard deviations."""
        return self.correlated is not None and len(self.correlated.detected) > 0


def assess(
    posed: PosedIdentification, settings: SearchSettings, search: MisfitMinimum, minimum: MisfitMinimum
) -> Optimum:
    """Return what is known of the values at a minimum, before (``search``) and after the noise was estimated."""
    problem, end, noise = minimum.problem, minimum.end, minimum.noise
    vector = problem.search.vectors(end.point)
    at = end.linearisation or problem.linearised(vector)
    response = problem.responses(vector[None])[0] if at is None else at.response
    if noise is None:
        known = posed.noise_is_given or problem.priors > 0
        estimated, correlated = _estimated(minimum, response, at, known=known)
    else:
        known, estimated, correlated = noise.noise.known, noise.estimate, None
    full_response = response if problem is posed.whole else posed.whole.responses(vector[None])[0]
    return Optimum(
        posed=posed,
        settings=settings,
        search=search,
        minimum=minimum,
        vector=vector,
        linearisation=at,
        response=response,
        full_response=full_response,
        noise_is_known=known,
        estimate=estimated,
        correlated=correlated,
        integration=integration_bias(problem, at, end.nodes),
        causes=residual_causes(problem, at if minimum.shows_model else None, known=known),
        validation=posed.split.validation(full_response),
    )


def _estimated(
    minimum: MisfitMinimum, response: np.ndarray, at: Linearisation | None, *, known: bool
) -> tuple[Estimate, CorrelatedResiduals | None]:
    """Deviations and correlations, NaN without a jacobian; the noise is known, or estimated from the residuals.

    Residuals of data that are exact to rounding are not tested for correlation.
    """
    problem, end = minimum.problem, minimum.end
    scale, plain = problem.model.parameters.scale, replace(problem, loss=None)
    freedom = problem.compared - len(scale)
    variance = 1.0 if known else end.misfit / freedom if freedom > 0 else np.nan
    residual, slopes = plain.residual(response), None if at is None else plain.slopes(at, scale)
    if problem.loss is not None:
        counted = problem.weights.ravel() > 0
        variance, known = problem.loss.variance(residual[counted], freedom), False
        residual[counted] = problem.loss.influence(residual[counted])
    exact = minimum.explained_by == "arithmetic"
    correlated = None if exact else correlation(problem, response, slopes, residual, variance, known=known)
    if slopes is None:
        return unknown_estimate(len(scale)), correlated
    noise = variance if correlated is None else correlated.noise
    if end.spread is not None:
        return estimate_of(end.spread, scale, noise), correlated
    return estimate(slopes, scale, noise), correlated
