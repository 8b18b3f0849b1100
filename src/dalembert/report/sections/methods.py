"""Methods compared on the same box."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from dalembert.report import charts
from dalembert.report.charts.methods import reference
from dalembert.report.plot import Plot
from dalembert.report.sections.section import Section
from dalembert.report.table import Table, cell
from dalembert.uncertainty import Comparison


@dataclass(frozen=True)
class Methods(Section):
    """What each method found, how far from the reference, and what it cost."""

    name: ClassVar[str] = "methods"
    heading: ClassVar[str] = "Methods"
    comparison: Comparison

    @property
    def plots(self) -> tuple[Plot, ...]:
        against = "Further down is closer to the reference, further left is cheaper."
        where = (
            f"Largest distance of any bound from that of {self.comparison.reference}, sample by sample; none in a gap."
        )
        return (
            Plot("methods", charts.methods(self.comparison), against),
            Plot("differences", charts.differences(self.comparison), where),
        )

    @property
    def table(self) -> Table:
        known, results = reference(self.comparison), self.comparison.results
        rows = [
            (
                cell(row.method),
                cell(row.kind),
                cell(row.width),
                *(cell(np.nan if one is known else error, digits=3) for error in (row.largest, row.rms)),
                cell(row.runs),
                cell(row.seconds, digits=3),
                cell("the reference" if one is known else "" if one.success else one.status, mark=not one.success),
            )
            for row, one in zip(self.comparison.rows, results, strict=True)
        ]
        none = [cell(np.nan)] * 5
        rows += [
            (cell(method), cell("none"), *none, cell(reason, mark=True)) for method, reason in self.comparison.refused
        ]
        columns = ("method", "kind", "mean width", "largest error", "rms error", "runs", "time (s)", "note")
        return Table("methods", "Methods on the same box; errors are distances from the reference", columns, rows)
