"""The result of a global sensitivity analysis."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np

from dalembert.findings import Finding
from dalembert.forward.stored_coordinate import StoredCoordinate
from dalembert.results import Result
from dalembert.stored_fields import Labels, Over, StoredBox, Table
from dalembert.tables import Table as ResultTable
from dalembert.tables import box_table, cell, cells, counted


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
    aggregated_first, aggregated_total : array, shape (channels, parameters)
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
        Of the parameters, in the order of ``box``.
    """

    FORMAT: ClassVar[str] = "dalembert sensitivity indices 1"
    TITLE: ClassVar[str] = "Global sensitivity"
    VERDICTS: ClassVar[tuple[str, str]] = ("estimated", "estimated")

    coordinate: StoredCoordinate
    channels: Annotated[tuple[str, ...], Labels("channel")]
    units: Annotated[tuple[str, ...], Labels("channel", name="unit")]
    box: StoredBox
    distributions: Annotated[tuple[str, ...], Labels("parameter", name="distribution")]
    mean: Table
    deviations: Table
    first: Annotated[np.ndarray, Over("sample", "channel", "parameter")]
    total: Annotated[np.ndarray, Over("sample", "channel", "parameter")]
    aggregated_first: Annotated[np.ndarray, Over("channel", "parameter")]
    aggregated_total: Annotated[np.ndarray, Over("channel", "parameter")]
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

    def facts(self) -> dict[str, str]:
        return {
            "parameters": counted(len(self.box.names)),
            "simulations": counted(self.runs),
            "random checks": counted(self.checks),
        }

    def tables(self) -> tuple[ResultTable, ...]:
        """Return the indices of whole channels, and the parameters."""
        columns = {
            "channel": [channel for channel in self.channels for _ in self.box.names],
            "parameter": [name for _ in self.channels for name in self.box.names],
            "first-order index": [cell(float(value), digits=4) for value in self.aggregated_first.ravel()],
            "total index": [cell(float(value), digits=4) for value in self.aggregated_total.ravel()],
            "± at most": cells(self.uncertainty.repeat(len(self.box.names)), 2),
        }
        indices = ResultTable.of("sobol-indices", "Parts of the variance of whole channels", columns)
        return indices, box_table(
            self.box,
            "Intervals and distributions of the parameters",
            units=self.parameter_units,
            distribution=self.distributions,
        )
