"""The result of a propagation."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np

from dalembert.data import Bands
from dalembert.findings import Finding
from dalembert.forward.stored_coordinate import StoredCoordinate
from dalembert.parameter import Parameter
from dalembert.quantities import unit
from dalembert.results import EndedResult
from dalembert.stored_fields import Labels, OptionalTable, Over, StoredBox, Table
from dalembert.tables import Cell, box_table, cells, counted, labelled, noted, shown
from dalembert.tables import Table as ResultTable


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
        Of the parameters, in the order of ``box``.
    """

    FORMAT: ClassVar[str] = "dalembert propagation 1"
    TITLE: ClassVar[str] = "Bounds of the response"
    VERDICTS: ClassVar[tuple[str, str]] = ("bounded", "not bounded")

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

    def facts(self) -> dict[str, str]:
        error = self.error
        return {
            "method": self.method,
            "the bounds are": self.kind,
            "largest estimated error": "unknown" if error is None else shown(float(error.max()), digits=2),
            "runs of the model": counted(self.runs),
            "time": f"{shown(self.seconds, digits=3)} s",
        }

    def tables(self) -> tuple[ResultTable, ...]:
        """Return the intervals of the parameters, and the widths of the bands."""
        width, along, corners = self.upper - self.lower, self.coordinate, self._at_corners()
        errors = ["unknown"] * len(self.channels) if self.error is None else self.error.max(axis=0)
        columns = {
            "channel": self.channels,
            "largest width": width.max(axis=0),
            labelled(f"at {along.name}", along.unit): along.values[width.argmax(axis=0)],
            "mean width": [column.mean() for column in width.T],
            "estimated error": cells(errors, 2),
        }
        if corners is not None:
            columns["taken at corners of the box"] = [Cell(float(part), f"{100 * part:.0f} %") for part in corners]
        columns["unit"] = [unit(channel, known) for channel, known in zip(self.channels, self.units, strict=True)]
        box = box_table(self.box, "Intervals of the parameters", units=self.parameter_units)
        return box, noted(ResultTable.of("widths", "Widths", columns))

    def _at_corners(self) -> np.ndarray | None:
        """Share of each channel's bounds that are taken at a corner of the box, (channels,)."""
        if self.at_lower is None or self.at_upper is None:
            return None
        at = np.stack([self.at_lower, self.at_upper])
        near = 1e-6 * (self.box.upper - self.box.lower)
        on_end = (at <= self.box.lower + near) | (at >= self.box.upper - near)
        return on_end.all(axis=-1).mean(axis=(0, 1))
