"""The result of several specimens: the mean of their parameters, and how much these vary."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np
from scipy.special import stdtrit

from dalembert.findings import Finding
from dalembert.results import Result
from dalembert.stored_fields import Labels, Over
from dalembert.tables import MOST_FACTS, Table, cell, cells, counted, interval, labelled, shown


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
    TITLE: ClassVar[str] = "Several specimens"
    VERDICTS: ClassVar[tuple[str, str]] = ("estimated", "")

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

    def key_values(self) -> dict[str, str]:
        pairs = zip(self.labels, self.mean.tolist(), self.spread.tolist(), strict=True)
        texts = {label: f"{shown(mean)}, spread {shown(spread)}" for label, mean, spread in pairs}
        return texts if len(texts) <= MOST_FACTS else {}

    def facts(self) -> dict[str, str]:
        return {"specimens": counted(len(self.specimens))}

    @property
    def labels(self) -> tuple[str, ...]:
        """Names of the parameters with their units."""
        return tuple(map(labelled, self.names, self.units))

    def tables(self) -> tuple[Table, ...]:
        """Return the means and spreads, then the values of the specimens."""
        level = f"{100 * self.level:g} %"
        means = {
            "parameter": self.labels,
            "mean": map(cell, self.mean, self.mean_deviations),
            "standard deviation": cells(self.mean_deviations, 2),
            "spread": cells(self.spread, 3),
            f"spread, {level}": map(interval, self.spread_lower, self.spread_upper),
            f"new specimen, {level}": map(interval, self.new_lower, self.new_upper),
            "Q": cells(self.heterogeneity, 3),
            "p-value of Q": cells(self.p_value, 2),
        }
        values: dict[str, Iterable[object]] = {"specimen": self.specimens}
        for k, label in enumerate(self.labels):
            for suffix, columns, deviations in (
                ("", self.values, self.deviations),
                (", adjusted", self.adjusted, self.adjusted_deviations),
            ):
                values[f"{label}{suffix}"] = map(cell, columns[:, k], deviations[:, k])
                values[f"± {label}{suffix}"] = cells(deviations[:, k], 2)
        caption = "Values of the specimens, and adjusted by what is known of the others"
        return (
            Table.of("population", "Mean over specimens, and standard deviation between them", means),
            Table.of("specimens", caption, values, detail=True),
        )
