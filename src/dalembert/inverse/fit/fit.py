"""The result of an identification."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from dalembert.contents import Contents
from dalembert.data import Measurements
from dalembert.errors import InputError
from dalembert.findings import Finding
from dalembert.inverse.correlation.correlated import CorrelatedResiduals
from dalembert.inverse.events import StartEnd, Step
from dalembert.inverse.experiments.experiment_fit import ExperimentFit, experiment_fit
from dalembert.inverse.experiments.experiments import Part
from dalembert.inverse.experiments.validation import Validation
from dalembert.inverse.fit.doubts import doubts
from dalembert.inverse.fit.integration import IntegrationBias
from dalembert.inverse.fit.sentences import sentences
from dalembert.inverse.least_squares.estimate import Estimate, Identifiability
from dalembert.inverse.misfit.halves import Halves
from dalembert.inverse.shooting.nodes import Nodes
from dalembert.parameters import Parameters
from dalembert.results import Result


@dataclass(frozen=True, eq=False)
class Fit(Result):
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
    fitness : float
        Σ W (R − data)² over samples and channels, or the sum of the losses; + Σ ((p − start)/deviation)² over priors.
    response, residuals : array, shape (samples, channels)
        R at ``values``, and R − data: NaN where a value is missing, modulo a turn in wrapping channels.
    data : Measurements
        Those of several experiments in one table, NaN where one has no sample in a row; see :attr:`experiments`.
    weights : array, shape (samples, channels)
        W, 0 where a value was not fitted.
    history : tuple of Step
        Best fitness along each start, where all samples were compared.
    starts : tuple of StartEnd
    success : bool
    status : str
        How it went and what to do, in full sentences.
    method : str
    simulations : int
        A response with its sensitivities counts as 1 + parameters.
    provenance : mapping
        Versions, seed, hashes of model and data, method and settings.
    parts : tuple of Part
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
    """

    FORMAT: ClassVar[str] = "dalembert fit 1"

    parameters: Parameters
    values: np.ndarray
    deviations: np.ndarray
    correlation: np.ndarray
    singular_values: np.ndarray
    directions: np.ndarray
    fitness: float
    response: np.ndarray
    data: Measurements
    weights: np.ndarray
    history: tuple[Step, ...]
    starts: tuple[StartEnd, ...]
    success: bool
    status: str
    method: str
    simulations: int
    provenance: Mapping[str, Any]
    parts: tuple[Part, ...] = ()
    validation: Validation | None = None
    nodes: Nodes | None = None
    findings: tuple[Finding, ...] = ()
    correlated: CorrelatedResiduals | None = None
    integration: IntegrationBias | None = None
    halves: Halves | None = None

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
        """What the data can tell: singular values, combinations, and sentences on what they cannot."""
        told = Estimate(self.deviations, self.correlation, self.singular_values, self.directions)
        found = sentences(self.parameters, self.values, told)
        return Identifiability(self.singular_values, self.directions, found, self.deviations, self.correlation)

    @property
    def doubts(self) -> tuple[str, ...]:
        """Why the values are to be doubted although the search ended well, each reason in a few words.

        The residuals are too large for the given deviations, another minimum explains the data as
        well, parameters sit on a bound or are not told, or not apart, or a finding is a warning or an error; empty
        where nothing speaks against them.
        """
        return (*doubts(self.status, self.identifiability()), *super().doubts)

    def intervals(self, level: float = 0.95) -> dict[str, tuple[float, float]]:
        """Interval of each parameter that holds its true value with a probability, by name: value ∓ q × deviation.

        q is the quantile of the normal distribution where the noise is known, else of Student's t. Right where the
        response is nearly linear within the interval; :func:`dalembert.profile` asks the response itself.
        """
        from dalembert.inverse.fit.confidence import intervals

        return intervals(self, level)

    def summary(self) -> str:
        """The result as a text table with its status."""
        from dalembert.inverse.fit.summary import summary

        return summary(self)

    def contents(self) -> Contents:
        from dalembert.inverse.fit.storage import contents_of

        return contents_of(self)

    @classmethod
    def from_xarray(cls, dataset: Any) -> "Fit":
        """The result that :meth:`to_xarray` turned into a dataset."""
        from dalembert.inverse.fit.storage import from_xarray

        return from_xarray(dataset)
