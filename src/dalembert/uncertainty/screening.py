"""The result of a screening: mean and spread of elementary effects."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np

from dalembert.findings import Finding
from dalembert.forward.stored_coordinate import StoredCoordinate
from dalembert.results import Result, fact_lines, text_table
from dalembert.stored_fields import Labels, Over, StoredBox


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
    whole_effects, whole_spread : array, shape (channels, parameters)
        Of the whole channel: means over the trajectories of the root mean square of the effects over the samples, and
        the root mean square of σ.
    errors : array, shape (channels, parameters)
        Standard error of ``whole_effects``.
    trajectories : int
        Those without failed runs.
    runs : int
    failures : tuple of str
        Reasons of the runs that failed.
    provenance : mapping
    findings : tuple of Finding
    parameter_units : tuple of str, length parameters
        Of the parameters, in the order of ``box``; empty in results of former versions.
    """

    FORMAT: ClassVar[str] = "dalembert screening 1"

    coordinate: StoredCoordinate
    channels: Annotated[tuple[str, ...], Labels("channel")]
    units: Annotated[tuple[str, ...], Labels("channel", name="unit")]
    box: StoredBox
    distributions: Annotated[tuple[str, ...], Labels("parameter", name="distribution")]
    mean: Annotated[np.ndarray, Over("sample", "channel", "parameter")]
    effects: Annotated[np.ndarray, Over("sample", "channel", "parameter")]
    spread: Annotated[np.ndarray, Over("sample", "channel", "parameter")]
    whole_effects: Annotated[np.ndarray, Over("channel", "parameter")]
    whole_spread: Annotated[np.ndarray, Over("channel", "parameter")]
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
        order = np.argsort(-self.whole_effects[self.channels.index(channel)], kind="stable")
        return tuple(self.box.names[k] for k in order)

    def summary(self) -> str:
        """Return a table of the effects on whole channels, the largest first, then the effort."""
        rows = [("channel", "parameter", "mean absolute effect", "± standard error", "spread", "unit")]
        for c, channel in enumerate(self.channels):
            for place, name in enumerate(self.ranking(channel)):
                p = self.box.names.index(name)
                effect, error = f"{self.whole_effects[c, p]:.4g}", f"{self.errors[c, p]:.2g}"
                rows.append(
                    ("" if place else channel, name, effect, error, f"{self.whole_spread[c, p]:.3g}", self.units[c])
                )
        facts = fact_lines(runs=self.runs)
        return "\n".join([*text_table(rows), "", *facts, *map(str, self.findings)])
