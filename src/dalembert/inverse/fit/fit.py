"""The result of an identification."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Annotated, Any, ClassVar

import numpy as np
from scipy.special import ndtri, stdtrit  # quantiles; scipy.stats takes long to load

from dalembert.arguments import is_number
from dalembert.contents import Contents
from dalembert.errors import InputError, shown
from dalembert.findings import Finding
from dalembert.inverse.diagnostics.residual_diagnostics import ResidualDiagnostics, residual_diagnostics
from dalembert.inverse.events import SearchIteration, StartEnd
from dalembert.inverse.experiments.experiment import ExperimentFit, ExperimentPart, experiment_fit
from dalembert.inverse.fit.fit_tables import fit_facts, fit_tables
from dalembert.inverse.fit.integration import IntegrationBias
from dalembert.inverse.fit.stored_data import StoredData, StoredParts
from dalembert.inverse.fit.stored_search import History, Starts
from dalembert.inverse.least_squares.estimate import Estimate, Identifiability
from dalembert.inverse.least_squares.identifiable import identifiability_findings
from dalembert.inverse.misfit.halves import Halves
from dalembert.inverse.noise.correlation.correlated_residuals import CorrelatedResiduals
from dalembert.inverse.noise.likelihood.estimated_noise import EstimatedNoise
from dalembert.inverse.problem.nodes import Nodes
from dalembert.inverse.validation.validation import Validation
from dalembert.results import EndedResult
from dalembert.stored_fields import Over, StoredParameters, Table
from dalembert.tables import Table as ResultTable
from dalembert.tables import few_values, with_deviation


@dataclass(frozen=True, eq=False)
class Fit(EndedResult):
    """Identified parameters, how well they are known, and how they were found.

    Parameters
    ----------
    parameters : Parameters
    values, deviations : array, shape (parameters,)
        Identified values and their standard deviations: from given deviations of the data if there are any and no
        weights were given, else from the variance of the residuals. They allow for correlated residuals. NaN where they
        could not be computed.
    correlation : array, shape (parameters, parameters)
    singular_values : array, shape (parameters,)
        Of W^½ ∂R/∂p · scale, with a row scale/deviation a prior; largest first.
    directions : array, shape (parameters, parameters)
        A row a singular value: the combination of p/scale that it belongs to.
    misfit : float
        Σ W (R − data)² over samples and channels, or the sum of the losses; + Σ ((p − start)/deviation)² over priors.
    response, residuals : array, shape (samples, channels)
        R at ``values``, and R − data: NaN where a value is missing, modulo a turn in wrapping channels.
    data : Measurements
        Those of several experiments in one table, NaN where one has no sample in a row; see :attr:`experiments`.
    weights : array, shape (samples, channels)
        W, 0 where a value was not fitted.
    history : tuple of SearchIteration
        Best misfit along each start, where all samples were compared.
    starts : tuple of StartEnd
    success : bool
    outcome : tuple of Finding
        How the search ended; ``status`` is their text.
    method : str
    simulations : int
        A response with its sensitivities counts as 1 + parameters.
    provenance : mapping
        Versions, seed, hashes of model and data, method and settings.
    parts : tuple of ExperimentPart
        Where each of several experiments stands in the response; empty for a model with its data.
    validation : Validation, optional
        How what was not fitted is predicted.
    nodes : Nodes, optional
        Where the segments of multiple shooting meet.
    findings : tuple of Finding
        What the method concludes about the result.
    correlated : CorrelatedResiduals, optional
        Noise processes of channels with correlated residuals; None where residuals are taken for independent.
    integration : IntegrationBias, optional
        How far the integrator's error moves the values; None for a model that cannot be simulated more exactly.
    halves : Halves, optional
        Parameters of the first and of the second half of the records; None where that is not known.
    jacobian : array, shape (samples, channels, parameters), optional
        ∂R/∂p at ``values``, NaN where the response was not linearised. None where the model gives none, and for
        segments.
    noise : EstimatedNoise, optional
        Noise that was estimated with the parameters. The weights are then 1/σ² with the estimated deviation σ of each
        value, and ``deviations`` allow for the unknown noise and its correlation.
    """

    FORMAT: ClassVar[str] = "dalembert fit 1"
    TITLE: ClassVar[str] = "Identified parameters"
    VERDICTS: ClassVar[tuple[str, str]] = ("identified", "not identified")

    parameters: StoredParameters
    values: Annotated[np.ndarray, Over("parameter")]
    deviations: Annotated[np.ndarray, Over("parameter")]
    correlation: Annotated[np.ndarray, Over("parameter", "parameter_")]
    singular_values: Annotated[np.ndarray, Over("combination")]
    directions: Annotated[np.ndarray, Over("combination", "parameter")]
    misfit: float
    response: Table
    data: StoredData
    weights: Table
    history: Annotated[tuple[SearchIteration, ...], History("parameter")]
    starts: Annotated[tuple[StartEnd, ...], Starts("parameter")]
    success: bool
    outcome: tuple[Finding, ...]
    method: str
    simulations: int
    provenance: Mapping[str, Any]
    parts: Annotated[tuple[ExperimentPart, ...], StoredParts()] = ()
    validation: Validation | None = None
    nodes: Nodes | None = None
    findings: tuple[Finding, ...] = ()
    correlated: CorrelatedResiduals | None = None
    integration: IntegrationBias | None = None
    halves: Halves | None = None
    jacobian: Annotated[np.ndarray | None, Over("sample", "channel", "parameter")] = None
    noise: EstimatedNoise | None = None

    @property
    def plain_deviations(self) -> np.ndarray:
        """Standard deviations for independent residuals (parameters,), whether they are or not."""
        return self.deviations if self.correlated is None else self.correlated.deviations

    @property
    def integration_bias(self) -> np.ndarray:
        """Error of the values that the integrator causes (parameters,), to first order; NaN where it is not known."""
        return np.full(len(self.values), np.nan) if self.integration is None else self.integration.bias

    @property
    def experiments(self) -> tuple[ExperimentFit, ...]:
        """Each of several experiments with its response, data and residuals."""
        return tuple(experiment_fit(part, self.data, self.response, self.weights) for part in self.parts)

    @property
    def residuals(self) -> np.ndarray:
        return self.data.difference(self.response)

    @property
    def estimates(self) -> dict[str, float]:
        """Identified values by name."""
        return self.parameters.mapping(self.values)

    def needs_one_run(self, what: str) -> None:
        """Refuse ``what`` where the response is that of segments, which one run does not follow.

        Raises
        ------
        InputError
        """
        if self.nodes is not None and self.nodes.segments > 1:
            raise InputError(
                f"{what}: the fit is of {self.nodes.segments} segments that did not merge into one run, which {what} "
                "would simulate; fit fewer samples"
            )

    def identifiability(self) -> Identifiability:
        """What the data can identify: singular values, combinations, and findings on what they cannot."""
        known = Estimate(self.deviations, self.correlation, self.singular_values, self.directions)
        plain = (
            known
            if self.correlated is None
            else replace(known, deviations=self.correlated.deviations, correlation=self.correlated.correlation)
        )
        bias = None if self.integration is None else self.integration.bias
        findings = tuple(identifiability_findings(self.parameters, self.values, known, plain, bias))
        return Identifiability(self.singular_values, self.directions, findings, self.deviations, self.correlation)

    def diagnostics(self) -> ResidualDiagnostics:
        """Return tests of the residuals, outliers by channel and time, and the influence of single samples.

        Fits without a Jacobian have leverages of NaN.

        Examples
        --------
        >>> from dalembert import Measurements, PythonModel, identify
        >>> times = np.linspace(0.0, 1.0, 101)
        >>> line = PythonModel(lambda slope: slope * times, {"slope": (0.0, 3.0)}, ["x"], times)
        >>> noisy = 2 * times + 0.1 * np.random.default_rng(0).standard_normal(101)
        >>> noisy[70] += 1.0
        >>> found = identify(line, Measurements.of(times, {"x": noisy})).diagnostics()
        >>> print(found.outliers[0], round(found.outliers[0].size, 1))
        'x' at 0.7 s -10.2
        >>> lags, correlations, limits = found.series[0].autocorrelation()
        """
        return residual_diagnostics(self)

    @property
    def conclusions(self) -> tuple[Finding, ...]:
        """How the search ended, what the data cannot identify, and what else the method concludes."""
        return (*self.outcome, *self.identifiability().findings, *self.findings)

    def intervals(self, level: float = 0.95) -> dict[str, tuple[float, float]]:
        """Interval of each parameter that holds its true value with a probability, by name: value ∓ q × deviation.

        q is the quantile of the normal distribution where the noise is known, else of Student's t. Right where the
        response is nearly linear within the interval; :func:`dalembert.profile` asks the response itself.
        """
        check_level(level, "intervals")
        radius = self.quantile(level) * self.deviations
        ends = zip(self.parameters.names, (self.values - radius).tolist(), (self.values + radius).tolist(), strict=True)
        return {name: (lower, upper) for name, lower, upper in ends}

    @property
    def noise_is_known(self) -> bool:
        """Return True if the standard deviations follow from those of the data, not from the residuals."""
        if self.noise is not None:
            return self.noise.known
        from_data = self.data.deviations is not None and self.provenance.get("weights") == "data"
        return from_data or len(self.parameters.square_priors) > 0

    @property
    def degrees_of_freedom(self) -> int:
        """Return the number of fitted values and priors, less that of parameters."""
        return int(np.count_nonzero(self.weights)) + len(self.parameters.square_priors) - len(self.parameters)

    @property
    def effective_degrees_of_freedom(self) -> float:
        """Return the degrees of freedom of the standard deviations: fewer than those of independent residuals.

        Of channels with correlated residuals those of their processes count in place of the number of values.
        """
        freedom = float(self.degrees_of_freedom)
        if self.correlated is None:
            return freedom
        values = dict(zip(self.data.channels, np.count_nonzero(self.weights, axis=0), strict=True))
        lost = sum(values[process.channel] - process.degrees for process in self.correlated.processes)
        return min(freedom, float(np.count_nonzero(self.weights)) - lost)

    def quantile(self, level: float) -> float:
        """Return the standard deviations on either side of a value that contain the true one with a probability.

        Of the normal distribution where the noise is known, else of Student's t with
        :attr:`effective_degrees_of_freedom`.
        """
        if self.noise_is_known:
            return float(ndtri((1 + level) / 2))
        freedom = self.effective_degrees_of_freedom
        return float(stdtrit(freedom, (1 + level) / 2)) if freedom > 0 else np.nan

    @property
    def residual_variance(self) -> float:
        """Return the variance of a weighted residual: 1 where the noise is known, else estimated from the residuals."""
        if self.noise_is_known or self.noise is not None:
            return 1.0
        return self.misfit / self.degrees_of_freedom if self.degrees_of_freedom > 0 else np.nan

    def key_values(self) -> dict[str, str]:
        return few_values(self.parameters, map(with_deviation, self.values, self.deviations))

    def facts(self) -> dict[str, str]:
        return fit_facts(self)

    def tables(self) -> tuple[ResultTable, ...]:
        """Return the parameters, their noise, the halves of the records, the residuals, the nodes and the starts."""
        return tuple(fit_tables(self))

    def summary(self) -> str:
        """Return tables, facts, status, findings, and how what was not fitted is predicted, as text."""
        return "\n".join([super().summary(), *([] if self.validation is None else [str(self.validation)])])

    def contents(self) -> Contents:
        contents = super().contents()
        return replace(contents, variables={**contents.variables, "residuals": (("sample", "channel"), self.residuals)})


def check_level(level: float, where: str) -> None:
    """Check that a level is a probability."""
    if not is_number(level) or np.iscomplexobj(level) or not 0 < level < 1:
        raise InputError(f"{where}: level is {shown(level)}; expected a number between 0 and 1, such as 0.95")
