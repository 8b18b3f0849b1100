"""The result of several specimens: the mean of their parameters, and how much these vary."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np
from scipy.special import stdtrit

from dalembert.findings import Finding
from dalembert.results import Result, fact_lines, text_table
from dalembert.stored_fields import Labels, Over


@dataclass(frozen=True, eq=False)
class Population(Result):
    """Mean and spread of the parameters of specimens, as :func:`population` returns them.

    Parameters
    ----------
    names, units : tuple of str, length parameters
    specimens : tuple of str
    values, deviations : array, shape (specimens, parameters)
        Identified values of each specimen and their standard deviations.
    mean, mean_deviations : array, shape (parameters,)
        Mean of all specimens that there could be, and its standard deviation.
    spread : array, shape (parameters,)
        Standard deviation between specimens.
    spread_lower, spread_upper : array, shape (parameters,)
        Interval of it by the profile of the restricted likelihood; the upper end may be infinite.
    new_lower, new_upper : array, shape (parameters,)
        Interval that contains the value of the parameter in a new specimen.
    correlation : array, shape (parameters, parameters)
        Of the parameters between specimens; the unit matrix where it was not estimated.
    adjusted, adjusted_deviations : array, shape (specimens, parameters)
        Values of the specimens with what is known of the others, and their standard deviations.
    heterogeneity, p_value : array, shape (parameters,)
        Cochran's Q of the parameter, and the probability of a larger one if all specimens were equal.
    level : float
        Probability of the intervals.
    provenance : mapping
    findings : tuple of Finding
    """

    FORMAT: ClassVar[str] = "dalembert population 1"

    names: Annotated[tuple[str, ...], Labels("parameter")]
    units: tuple[str, ...]
    specimens: Annotated[tuple[str, ...], Labels("specimen")]
    values: Annotated[np.ndarray, Over("specimen", "parameter")]
    deviations: Annotated[np.ndarray, Over("specimen", "parameter")]
    mean: Annotated[np.ndarray, Over("parameter")]
    mean_deviations: Annotated[np.ndarray, Over("parameter")]
    spread: Annotated[np.ndarray, Over("parameter")]
    spread_lower: Annotated[np.ndarray, Over("parameter")]
    spread_upper: Annotated[np.ndarray, Over("parameter")]
    new_lower: Annotated[np.ndarray, Over("parameter")]
    new_upper: Annotated[np.ndarray, Over("parameter")]
    correlation: Annotated[np.ndarray, Over("parameter", "parameter_")]
    adjusted: Annotated[np.ndarray, Over("specimen", "parameter")]
    adjusted_deviations: Annotated[np.ndarray, Over("specimen", "parameter")]
    heterogeneity: Annotated[np.ndarray, Over("parameter")]
    p_value: Annotated[np.ndarray, Over("parameter")]
    level: float
    provenance: Mapping[str, Any]
    findings: tuple[Finding, ...] = ()

    @property
    def intervals(self) -> dict[str, tuple[float, float]]:
        """Interval of the mean of each parameter, by Student's t with a degree of freedom less than specimens."""
        radius = stdtrit(len(self.specimens) - 1, (1 + self.level) / 2) * self.mean_deviations
        return self._named(self.mean - radius, self.mean + radius)

    @property
    def prediction(self) -> dict[str, tuple[float, float]]:
        """Interval that contains the value of each parameter in a new specimen."""
        return self._named(self.new_lower, self.new_upper)

    def _named(self, lower: np.ndarray, upper: np.ndarray) -> dict[str, tuple[float, float]]:
        return dict(zip(self.names, zip(lower.tolist(), upper.tolist(), strict=True), strict=True))

    def summary(self) -> str:
        """Return a table of means and spreads, then the findings."""
        part = f"{100 * self.level:g} %"
        rows = [("parameter", "mean", "± deviation", "spread", f"spread, {part}", f"new specimen, {part}", "unit")]
        for k, (name, unit) in enumerate(zip(self.names, self.units, strict=True)):
            lower, upper = self.prediction[name]
            spread = f"{self.spread_lower[k]:.3g} to {self.spread_upper[k]:.3g}"
            facts = f"{self.mean[k]:.6g}", f"{self.mean_deviations[k]:.2g}", f"{self.spread[k]:.3g}"
            rows.append((name, *facts, spread, f"{lower:.5g} to {upper:.5g}", unit))
        facts = fact_lines(specimens=len(self.specimens))
        return "\n".join([*text_table(rows), "", *facts, *map(str, self.findings)])
