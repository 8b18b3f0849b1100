"""Integrators compared on one motion."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from dalembert.multibody import WorkPrecision
from dalembert.report import charts
from dalembert.report.plot import Plot
from dalembert.report.sections.section import Section
from dalembert.report.table import Table, cell


@dataclass(frozen=True)
class Integrators(Section):
    """Error, run time and constraint violations of each integrator with each of its settings."""

    name: ClassVar[str] = "integrators"
    heading: ClassVar[str] = "Integrators"
    found: WorkPrecision

    @property
    def plots(self) -> tuple[Plot, ...]:
        how = "Further down is more exact, further left is faster. Below the dotted line nothing is known."
        return (Plot("work-precision", charts.work_precision(self.found), how),)

    @property
    def table(self) -> Table:
        rows = [
            (
                cell(row.method),
                cell(row.settings),
                cell(row.error, digits=3),
                cell(row.seconds, digits=3),
                cell(row.steps),
                *(cell(level, digits=2) for level in (row.position, row.velocity, row.acceleration)),
                cell(row.energy, digits=2),
                cell(row.failure, mark=True) if row.failure else cell(""),
            )
            for row in self.found.rows
        ]
        violated = ("|Φ|", "|Φ̇|", "|Φ̈|")
        columns = ("integrator", "settings", "error", "run time (s)", "steps", *violated, "energy", "note")
        caption = (
            "Errors relative to the channels' ranges, constraint violations, energy relative to the kinetic energy's"
        )
        return Table("integrators", caption, columns, rows)

    @property
    def trusted(self) -> str:
        """How well the reference is known, in a sentence."""
        apart = self.found.apart
        known = f"to about {apart:.1e}" if np.isfinite(apart) and apart > 0 else "to rounding"
        return f"The reference is {self.found.reference}; beside a second one it is known {known}."
