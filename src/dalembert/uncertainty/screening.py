"""The result of a screening: mean and spread of elementary effects."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np

from dalembert.findings import Finding
from dalembert.forward.stored_coordinate import StoredCoordinate
from dalembert.results import Result
from dalembert.stored_fields import Labels, Over, StoredBox
from dalembert.tables import Table, box_table, cell, cells, counted


@dataclass(frozen=True, eq=False)
class Screening(Result):
    """Elementary effects of the parameters on a response, as :func:`screen` returns them.

    All are differences of the response over the whole interval of a parameter, in units of the channel.

    Parameters
    ----------
    coordinate : Coordinate
    channels, units : tuple of str
    box : Box
        The intervals of the parameters.
    distributions : tuple of str, length parameters
        Distribution of each parameter within its interval.
    mean : array, shape (samples, channels, parameters)
        Mean effect, Morris's μ.
    effects : array, shape (samples, channels, parameters)
        Mean of the absolute effects, μ*.
    spread : array, shape (samples, channels, parameters)
        Standard deviation of the effects, σ: 0 for a linear response without interactions.
    aggregated_effects, aggregated_spread : array, shape (channels, parameters)
        Of the whole channel: means over the trajectories of the root mean square of the effects over the samples, and
        the root mean square of σ.
    errors : array, shape (channels, parameters)
        Standard error of ``aggregated_effects``.
    trajectories : int
        Those without failed runs.
    runs : int
    failures : tuple of str
        Reasons of the runs that failed.
    provenance : mapping
    findings : tuple of Finding
    parameter_units : tuple of str, length parameters
        Of the parameters, in the order of ``box``.
    """

    FORMAT: ClassVar[str] = "dalembert screening 1"
    TITLE: ClassVar[str] = "Screening of parameters"
    VERDICTS: ClassVar[tuple[str, str]] = ("ranked", "ranked")

    coordinate: StoredCoordinate
    channels: Annotated[tuple[str, ...], Labels("channel")]
    units: Annotated[tuple[str, ...], Labels("channel", name="unit")]
    box: StoredBox
    distributions: Annotated[tuple[str, ...], Labels("parameter", name="distribution")]
    mean: Annotated[np.ndarray, Over("sample", "channel", "parameter")]
    effects: Annotated[np.ndarray, Over("sample", "channel", "parameter")]
    spread: Annotated[np.ndarray, Over("sample", "channel", "parameter")]
    aggregated_effects: Annotated[np.ndarray, Over("channel", "parameter")]
    aggregated_spread: Annotated[np.ndarray, Over("channel", "parameter")]
    errors: Annotated[np.ndarray, Over("channel", "parameter")]
    trajectories: int
    runs: int
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
        """What the effects come from."""
        return f"The parameters are ranked by {self.trajectories} trajectories, {self.runs} simulations."

    def ranking(self, channel: str) -> tuple[str, ...]:
        """Return the names of the parameters, that with the largest effect on a whole channel first."""
        order = np.argsort(-self.aggregated_effects[self.channels.index(channel)], kind="stable")
        return tuple(self.box.names[k] for k in order)

    def facts(self) -> dict[str, str]:
        return {
            "parameters": counted(len(self.box.names)),
            "trajectories": counted(self.trajectories),
            "simulations": counted(self.runs),
        }

    def tables(self) -> tuple[Table, ...]:
        """Return the effects on whole channels, the largest first, and the parameters."""
        order = np.argsort(-self.aggregated_effects, axis=1, kind="stable")
        rows = [(channel, int(parameter)) for channel, ranked in enumerate(order) for parameter in ranked]
        at = tuple(np.array(rows).T)
        columns = {
            "channel": [self.channels[channel] for channel, _ in rows],
            "parameter": [self.box.names[parameter] for _, parameter in rows],
            "mean absolute effect": [cell(float(self.aggregated_effects[pair]), digits=4) for pair in rows],
            "standard error": cells(self.errors[at], 2),
            "spread": cells(self.aggregated_spread[at], 3),
            "unit": [self.units[channel] for channel, _ in rows],
        }
        caption = "Effects on whole channels, over the whole intervals"
        return Table.of("effects-of-parameters", caption, columns), box_table(
            self.box,
            "Intervals and distributions of the parameters",
            units=self.parameter_units,
            distribution=self.distributions,
        )
