"""The result of a cross-validation, its text and its file."""

from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np

from dalembert.data import Measurements
from dalembert.findings import Finding
from dalembert.inverse.experiments.residual_table import residual_table
from dalembert.inverse.fit.fit import Fit
from dalembert.results import Result
from dalembert.stored_fields import Over
from dalembert.tables import Table, cells, counted, noted, shown, unless


@dataclass(frozen=True, eq=False)
class CrossValidation(Result):
    """How a model predicts groups of its data that it was not fitted to, as :func:`cross_validate` returns it.

    Parameters
    ----------
    fit : Fit
        Of all data.
    left_out : {"values", "blocks", "experiments"}
    groups : array, shape (samples, channels)
        Number of the group of each value; −1 where it was not fitted.
    errors : array, shape (samples, channels)
        Predicted minus measured values, each predicted by the fit without its group; NaN where it was not fitted.
    log_densities : array, shape (groups,)
        Logarithm of the predictive density of each group.
    values : array, shape (groups, parameters)
        Identified values without each group.
    converged : array of bool, shape (groups,)
        Whether each of these fits converged.
    """

    FORMAT: ClassVar[str] = "dalembert cross-validation 1"
    TITLE: ClassVar[str] = "Cross-validation"

    fit: Fit
    left_out: str
    groups: Annotated[np.ndarray, Over("sample", "channel")]
    errors: Annotated[np.ndarray, Over("sample", "channel")]
    log_densities: Annotated[np.ndarray, Over("group")]
    values: Annotated[np.ndarray, Over("group", "parameter", name="values_without_group")]
    converged: Annotated[np.ndarray, Over("group", name="converged_without_group")]

    @property
    def data(self) -> Measurements:
        """The data of the fit."""
        return self.fit.data

    @property
    def residuals(self) -> np.ndarray:
        """The prediction errors, (samples, channels)."""
        return self.errors

    @property
    def response(self) -> np.ndarray:
        """The predicted values, (samples, channels)."""
        return self.data.values + self.errors

    @property
    def rms(self) -> float:
        """Root mean square of the weighted prediction errors W^½ (R − data)."""
        return self._rms(self.groups >= 0)

    @property
    def rms_of_groups(self) -> np.ndarray:
        """The same of each group, (groups,)."""
        return np.array([self._rms(self.groups == number) for number in range(len(self.log_densities))])

    @property
    def findings(self) -> tuple[Finding, ...]:  # type: ignore[override]
        """A finding on fits that did not converge."""
        missing = int(np.count_nonzero(~self.converged))
        if not missing:
            return ()
        message = f"{missing} of {len(self.converged)} fits without a group did not converge."
        advice = "Do not compare their densities; leave out smaller groups."
        return (Finding("unconverged-groups", "warning", {"groups": missing}, message, advice),)

    def facts(self) -> dict[str, str]:
        return {
            "groups": counted(len(self.log_densities)),
            "left out": self.left_out,
            "rms of the prediction errors": shown(self.rms),
            "elpd": shown(float(self.log_densities.sum())),
        }

    def tables(self) -> tuple[Table, ...]:
        """Return the groups in the order of the data; of a single record the residuals too."""
        columns = {
            "group": range(1, 1 + len(self.log_densities)),
            "rms error": cells(self.rms_of_groups, 4),
            "log density": cells(self.log_densities, 4),
            **{name: cells(column) for name, column in zip(self.fit.parameters.names, self.values.T, strict=True)},
            "note": unless(self.converged, "not converged"),
        }
        groups = noted(Table.of("cross-validation", "Groups in the order of the data", columns))
        return (groups,) if self.fit.experiments else (groups, residual_table(self))

    def _rms(self, kept: np.ndarray) -> float:
        return float(np.sqrt(np.mean(self.fit.weights[kept] * self.errors[kept] ** 2)))
