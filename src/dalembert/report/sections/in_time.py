"""A response over frequency beside integration in time."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from dalembert.report import charts
from dalembert.report.charts.time_comparison import compared_dofs
from dalembert.report.digits import shown
from dalembert.report.focus import unit_of
from dalembert.report.plot import Plot
from dalembert.report.quantities import labelled
from dalembert.report.sections.findings import Findings
from dalembert.report.table import Table, cell, noted
from dalembert.vibration import FrequencyCurve, TimeComparison


@dataclass(frozen=True)
class InTime(Findings):
    """Points of the curve that were integrated in time, and how far harmonic balance is from them."""

    heading: ClassVar[str] = "Beside time integration"
    comparison: TimeComparison
    curve: FrequencyCurve | None = None

    @property
    def sentences(self) -> tuple[str, ...]:
        compared = self.comparison
        found = np.asarray(compared.converged)
        settings = compared.provenance
        told = f"{len(found)} points were integrated in time with {settings['method']['steps_per_period']} steps a "
        told += f"period ({settings['way']}), {compared.periods.min()} to {compared.periods.max()} periods each."
        late = [shown(float(frequency)) for frequency in compared.frequencies[~found]]
        lost = f"Not periodic yet in time, so not to be compared: {', '.join(late)} Hz." if late else ""
        if not found.any():
            return (told, lost)
        sizes = np.abs(compared.differences[found])
        row, column = np.unravel_index(int(np.nanargmax(sizes)), sizes.shape)
        worst = f"Harmonic balance differs by at most {shown(100 * float(sizes[row, column]), digits=2)} % of the "
        worst += f"largest motion, for {compared.dofs[column]} at {shown(float(compared.frequencies[found][row]))} Hz."
        return tuple(filter(None, (told, worst, lost)))

    @property
    def wide(self) -> tuple[Plot, ...]:
        how = "Crosses: in time; circles: harmonic balance at the same frequencies."
        return (Plot("time-comparison", charts.time_comparison(self.comparison, self.curve), how),)

    @property
    def tables(self) -> tuple[Table, ...]:
        compared = self.comparison
        rows = [
            (
                cell(float(frequency)),
                cell(dof),
                cell(float(compared.balance[row, column])),
                cell(float(compared.time[row, column])),
                cell(100 * float(compared.differences[row, column]), digits=3),
                cell(int(compared.periods[row])),
                cell("" if compared.converged[row] else "not periodic yet", mark=not compared.converged[row]),
            )
            for dof in compared_dofs(compared)
            for column in [compared.dofs.index(dof)]
            for row, frequency in enumerate(compared.frequencies)
        ]
        unit = unit_of(compared.dofs[0])
        columns = (
            "frequency (Hz)",
            "degree of freedom",
            labelled("harmonic balance", unit),
            labelled("in time", unit),
            "difference (% of the largest)",
            "periods",
            "note",
        )
        return (noted(Table("in-time", "Harmonic balance and time integration", columns, rows)),)
