"""How far a simulated motion can be trusted."""

from collections.abc import Mapping

import numpy as np
import plotly.graph_objects as go

from dalembert.multibody import Trajectory
from dalembert.report import charts
from dalembert.report.charts.motion.diagnostics import LEVELS
from dalembert.report.look import plain
from dalembert.report.section import Block, Plot, Row, Section, numbered
from dalembert.report.table import Table, cells


def diagnostics(trajectories: Mapping[str, Trajectory]) -> Section:
    """Energy balance, constraint violations and Newton iterations, of each experiment's motion."""
    blocks: list[Block] = []
    for place, experiment, one in numbered("", trajectories):
        drawn = (
            ("energies", charts.energies(one), "Below, what the energy balance leaves over."),
            ("violations", charts.violations(one), "Largest violation of any constraint."),
            ("newton", charts.newton(one), "A rise shows where the motion is hard to follow."),
        )
        plots = [Plot(f"{name}{place}", _named(experiment, figure), how) for name, figure, how in drawn]
        blocks += [plots[0], Row(plots[1:])]
    return Section("Diagnostics of the simulation", (*blocks, _table(trajectories)))


def _table(trajectories: Mapping[str, Trajectory]) -> Table:
    rows = {experiment: [cells(row, 3) for row in _rows(one)] for experiment, one in trajectories.items()}
    return Table.of_experiments("diagnostics", "Diagnostics", ("quantity", "value", "unit"), rows)


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


def largest(series: Mapping[str, np.ndarray], key: str) -> float:
    """Largest magnitude in one of several series, NaN if it is not there."""
    return float(np.nanmax(np.abs(series[key]), initial=0.0)) if key in series else float("nan")
