"""Responses along one parameter at a time."""

from dataclasses import dataclass
from typing import Any, ClassVar

from dalembert.report import charts
from dalembert.report.plot import Plot
from dalembert.report.quantities import labelled
from dalembert.report.sections.section import Section
from dalembert.report.table import Table, cell


@dataclass(frozen=True)
class Sweeps(Section):
    """A figure and a table for each parameter."""

    name: ClassVar[str] = "sweeps"
    heading: ClassVar[str] = "Sweep"
    sweep: Any

    @property
    def plots(self) -> tuple[Plot, ...]:
        return tuple(
            Plot(
                f"sweep-{place}",
                charts.sweep(curve, self.sweep.at),
                "" if curve.sensitivities is None else "Below, its slope.",
            )
            for place, curve in enumerate(self.sweep.curves, start=1)
        )

    @property
    def tables(self) -> tuple[Table, ...]:
        return tuple(_table(place, curve) for place, curve in enumerate(self.sweep.curves, start=1))


def _table(place: int, curve: Any) -> Table:
    columns = [labelled(curve.parameter, curve.unit), *curve.channels]
    rows = [
        [cell(float(value)), *(cell(float(entry)) for entry in row)]
        for value, row in zip(curve.values, curve.responses, strict=True)
    ]
    if curve.sensitivities is not None:
        columns += [f"d {channel} / d {curve.parameter}" for channel in curve.channels]
        rows = [
            [*row, *(cell(float(entry)) for entry in slopes)]
            for row, slopes in zip(rows, curve.sensitivities, strict=True)
        ]
    return Table(f"sweep-{place}", f"Responses along {curve.parameter}", columns, rows)
