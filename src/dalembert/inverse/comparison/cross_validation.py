"""The result of a cross-validation, its text and its file."""

from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np

from dalembert.data import Measurements
from dalembert.inverse.fit.fit import Fit
from dalembert.results import Result, fact_lines, text_table
from dalembert.stored_fields import Over


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

    def summary(self) -> str:
        """Return a table of the groups, in the order of the data, and the totals."""
        names = self.fit.parameters.names
        rows: list[tuple[str, ...]] = [("group", "rms error", "log density", *names, "")]
        for k, rms in enumerate(self.rms_of_groups):
            numbers = (rms, self.log_densities[k], *self.values[k])
            note = "" if self.converged[k] else "not converged"
            rows.append((str(k + 1), *(f"{number:.6g}" for number in numbers), note))
        facts = fact_lines(groups=self.left_out, rms=f"{self.rms:.6g}", elpd=f"{self.log_densities.sum():.6g}")
        return "\n".join([*text_table(rows), "", *facts])

    def _rms(self, kept: np.ndarray) -> float:
        return float(np.sqrt(np.mean(self.fit.weights[kept] * self.errors[kept] ** 2)))
