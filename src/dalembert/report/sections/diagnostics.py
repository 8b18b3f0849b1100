"""How far a simulated motion can be trusted."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import plotly.graph_objects as go

from dalembert.multibody import Trajectory
from dalembert.report import charts
from dalembert.report.charts.violations import LEVELS
from dalembert.report.each import numbered
from dalembert.report.look import plain
from dalembert.report.plot import Plot
from dalembert.report.sections.headline import largest
from dalembert.report.sections.section import Section
from dalembert.report.table import Table, cell


@dataclass(frozen=True)
class Diagnostics(Section):
    """Energy balance, constraint violations and Newton iterations, of each experiment's motion."""

    name: ClassVar[str] = "diagnostics"
    heading: ClassVar[str] = "Diagnostics of the simulation"
    trajectories: Mapping[str, Trajectory]

    @property
    def plots(self) -> tuple[Plot, ...]:
        """Three for each motion."""
        found = []
        for place, experiment, one in numbered("", self.trajectories):
            drawn = (
                ("energies", charts.energies(one), "Below, what the energy balance leaves over."),
                ("violations", charts.violations(one), "Largest violation of any constraint."),
                ("newton", charts.newton(one), "A rise shows where the motion is hard to follow."),
            )
            found += [Plot(f"{name}{place}", _named(experiment, figure), how) for name, figure, how in drawn]
        return tuple(found)

    @property
    def table(self) -> Table:
        several = [] if "" in self.trajectories else ["experiment"]
        rows = [
            tuple(cell(entry, digits=3) for entry in ([experiment] if several else []) + list(row))
            for experiment, one in self.trajectories.items()
            for row in _rows(one)
        ]
        return Table("diagnostics", "Diagnostics", (*several, "quantity", "value", "unit"), rows)


def _named(experiment: str, figure: go.Figure) -> go.Figure:
    """A figure whose title says the experiment first, if there are several."""
    title = figure.layout.title.text  # pyright: ignore[reportAttributeAccessIssue]
    return figure.update_layout(title_text=f"{plain(experiment)}: {title}") if experiment else figure


def _rows(trajectory: Trajectory) -> list[tuple[str, float, str]]:
    """Quantities, values and units."""
    counts = np.asarray(trajectory.newton_iterations)
    return [
        ("largest energy balance", largest(trajectory.energies, "balance"), "J"),
        *(
            (f"largest violation, {level}", largest(trajectory.violations, level), label.partition("(")[2][:-1])
            for level, label in LEVELS.items()
        ),
        ("steps", len(counts), ""),
        ("Newton iterations a step, mean", float(counts.mean()) if len(counts) else float("nan"), ""),
        ("Newton iterations a step, most", int(counts.max(initial=0)), ""),
    ]
