"""How far a simulated motion can be trusted."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from dalembert.report import charts
from dalembert.report.charts.violations import LEVELS
from dalembert.report.needs import TrajectoryLike
from dalembert.report.plot import Plot
from dalembert.report.sections.headline import largest
from dalembert.report.sections.section import Section
from dalembert.report.table import Table, cell


@dataclass(frozen=True)
class Diagnostics(Section):
    """Energy balance, constraint violations and Newton iterations."""

    name: ClassVar[str] = "diagnostics"
    heading: ClassVar[str] = "Diagnostics of the simulation"
    trajectory: TrajectoryLike

    @property
    def plots(self) -> tuple[Plot, ...]:
        return (
            Plot("energies", charts.energies(self.trajectory), "Below, what the energy balance leaves over."),
            Plot("violations", charts.violations(self.trajectory), "Largest violation of any constraint."),
            Plot("newton", charts.newton(self.trajectory), "A rise shows where the motion is hard to follow."),
        )

    @property
    def table(self) -> Table:
        counts = np.asarray(self.trajectory.newton_iterations)
        rows = [
            ("largest energy balance", largest(self.trajectory.energies, "balance"), "J"),
            *(
                (
                    f"largest violation, {level}",
                    largest(self.trajectory.violations, level),
                    label.partition("(")[2][:-1],
                )
                for level, label in LEVELS.items()
            ),
            ("steps", len(counts), ""),
            ("Newton iterations a step, mean", float(counts.mean()) if len(counts) else float("nan"), ""),
            ("Newton iterations a step, most", int(counts.max(initial=0)), ""),
        ]
        return Table(
            "diagnostics",
            "Diagnostics",
            ("quantity", "value", "unit"),
            [tuple(cell(entry, digits=3) for entry in row) for row in rows],
        )
