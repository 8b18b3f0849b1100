"""The result of a propagation."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np

from dalembert.data import Bands
from dalembert.findings import Finding
from dalembert.forward.stored_coordinate import StoredCoordinate
from dalembert.parameters import Parameter
from dalembert.results import EndedResult, fact_lines, fixed_lines, text_table
from dalembert.stored_fields import Labels, OptionalTable, Over, StoredBox, Table


@dataclass(frozen=True, eq=False)
class Propagation(Bands, EndedResult):
    """Bounds of a response over a box of parameters, how they were found, and how far they can be trusted.

    Parameters
    ----------
    coordinate, channels, lower, upper
        As of :class:`~dalembert.data.Bands`.
    units : tuple of str
        Of the channels.
    box : Box
        An interval for each parameter, in the model's order.
    method : str
        Its name, and the settings that are not the usual ones.
    kind : {"inner bound", "estimate", "enclosure of the surrogate"}
        An inner bound is taken by runs of the model, and the true bounds can only be wider. An estimate may lie on
        either side. An enclosure of the surrogate holds all values of the polynomial, widened by the estimated error of
        the polynomial; it encloses the model as far as this estimate holds.
    runs : int
        Runs of the model; a response with its sensitivities counts as 1 + parameters.
    error : array, shape (samples, channels), or None
        Estimated error of the worse of both bounds, not guaranteed. None where it is unknown; the finding
        "unknown-error" has the reason.
    at_lower, at_upper : array, shape (samples, channels, parameters), or None
        Where in the box the bounds are taken; None where the method does not know.
    failures : tuple of str
        The reason of each run that failed.
    success : bool
        Whether every run succeeded and the method came to its end.
    outcome : tuple of Finding
        How reliable the bounds are; ``status`` is their text.
    seconds : float
        Time taken.
    provenance : mapping
        Versions, seed, hash of the model, method and settings.
    findings : tuple of Finding
        What the method concludes about the result.
    fixed : tuple of Parameter
        Parameters of the model that equal bounds fix; they are not in ``box``.
    parameter_units : tuple of str, length parameters
        Of the parameters, in the order of ``box``; empty in results of former versions.
    """

    FORMAT: ClassVar[str] = "dalembert propagation 1"

    coordinate: StoredCoordinate
    channels: Annotated[tuple[str, ...], Labels("channel")]
    lower: Table
    upper: Table
    units: Annotated[tuple[str, ...], Labels("channel", name="unit")]
    box: StoredBox
    method: str
    kind: str
    runs: int
    error: OptionalTable
    at_lower: Annotated[np.ndarray | None, Over("sample", "channel", "parameter")]
    at_upper: Annotated[np.ndarray | None, Over("sample", "channel", "parameter")]
    failures: tuple[str, ...]
    success: bool
    outcome: tuple[Finding, ...]
    seconds: float
    provenance: Mapping[str, Any]
    findings: tuple[Finding, ...] = ()
    fixed: tuple[Parameter, ...] = ()
    parameter_units: tuple[str, ...] = ()

    def summary(self) -> str:
        """Return a table of channels with their widths and one of intervals, then kind, effort and findings."""
        widths = [("channel", "unit", "largest width", "mean width", "estimated error")]
        for column, name in enumerate(self.channels):
            width = self.width[:, column]
            error = "unknown" if self.error is None else f"{self.error[:, column].max():.2g}"
            widths.append((name, self.units[column], f"{width.max():.5g}", f"{width.mean():.5g}", error))
        box = [("parameter", "lower", "upper"), *((n, f"{i.lower:.7g}", f"{i.upper:.7g}") for n, i in self.box.items())]
        facts = [
            *fact_lines(
                8,
                method=self.method,
                kind=self.kind,
                runs=f"{self.runs}" + (f", {len(self.failures)} failed" if self.failures else ""),
                seconds=f"{self.seconds:.2f}",
            ),
            *fixed_lines(self, width=8),
        ]
        return "\n".join(
            [*text_table(widths), "", *text_table(box), "", *facts, "", self.status, *map(str, self.findings)]
        )
