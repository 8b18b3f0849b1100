"""The result of a global sensitivity analysis."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np

from dalembert.findings import Finding
from dalembert.forward.stored_coordinate import StoredCoordinate
from dalembert.results import Result, fact_lines, text_table
from dalembert.stored_fields import Labels, Over, StoredBox, Table


@dataclass(frozen=True, eq=False)
class SensitivityIndices(Result):
    """Sobol indices of a response, as :func:`global_sensitivity` returns them.

    Parameters
    ----------
    coordinate : Coordinate
    channels, units : tuple of str
    box : Box
        The intervals of the parameters, which are independent.
    distributions : tuple of str, length parameters
        Distribution of each parameter within its interval.
    mean, deviations : array, shape (samples, channels)
        Of the response over the box.
    first, total : array, shape (samples, channels, parameters)
        First-order and total indices at each sample; NaN where the response does not vary.
    whole_first, whole_total : array, shape (channels, parameters)
        Indices of the whole channel: parts of the variance summed over the samples.
    uncertainty : array, shape (channels,)
        Largest error of an index of the whole channel that the error of the surrogate, and tails of distributions that
        are cut off, allow.
    runs : int
        All simulations, checks and failed ones included.
    checks : int
        Random runs that the surrogate was compared with.
    failures : tuple of str
        Reasons of the runs that failed.
    provenance : mapping
    findings : tuple of Finding
    parameter_units : tuple of str, length parameters
        Of the parameters, in the order of ``box``; empty in results of former versions.
    """

    FORMAT: ClassVar[str] = "dalembert sensitivity indices 1"

    coordinate: StoredCoordinate
    channels: Annotated[tuple[str, ...], Labels("channel")]
    units: Annotated[tuple[str, ...], Labels("channel", name="unit")]
    box: StoredBox
    distributions: Annotated[tuple[str, ...], Labels("parameter", name="distribution")]
    mean: Table
    deviations: Table
    first: Annotated[np.ndarray, Over("sample", "channel", "parameter")]
    total: Annotated[np.ndarray, Over("sample", "channel", "parameter")]
    whole_first: Annotated[np.ndarray, Over("channel", "parameter")]
    whole_total: Annotated[np.ndarray, Over("channel", "parameter")]
    uncertainty: Annotated[np.ndarray, Over("channel")]
    runs: int
    checks: int
    failures: tuple[str, ...]
    provenance: Mapping[str, Any]
    findings: tuple[Finding, ...] = ()
    parameter_units: tuple[str, ...] = ()

    @property
    def success(self) -> bool:
        """Whether all runs succeeded."""
        return not self.failures

    @property
    def status(self) -> str:
        """How exact the indices are."""
        worst = float(np.nan_to_num(self.uncertainty).max())
        return f"The indices of whole channels are uncertain by at most {worst:.1g}, from {self.runs} simulations."

    def summary(self) -> str:
        """Return a table of the indices of whole channels, then the effort."""
        rows = [("channel", "parameter", "first-order index", "total index", "± at most")]
        for c, channel in enumerate(self.channels):
            for p, name in enumerate(self.box.names):
                indices = f"{self.whole_first[c, p]:.4f}", f"{self.whole_total[c, p]:.4f}"
                rows.append((channel if p == 0 else "", name, *indices, f"{self.uncertainty[c]:.1g}"))
        return "\n".join(
            [*text_table(rows), "", *fact_lines(runs=self.runs, checks=self.checks), *map(str, self.findings)]
        )
