"""The segments of multiple shooting: how they came together, and where they meet."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from dalembert.inverse import Fit
from dalembert.inverse.shooting.nodes import Nodes
from dalembert.report import charts
from dalembert.report.plot import Plot
from dalembert.report.sections.section import Section
from dalembert.report.table import Table, cell


@dataclass(frozen=True)
class Shooting(Section):
    """Gaps over the steps, and the states at which the segments meet."""

    name: ClassVar[str] = "shooting"
    heading: ClassVar[str] = "Multiple shooting"
    fit: Fit
    nodes: Nodes

    @property
    def plots(self) -> tuple[Plot, ...]:
        come = "The gaps weigh ever more until they are closed; where two segments merge, a gap opens once more."
        return (Plot("gaps", charts.gaps(self.fit), come),)

    @property
    def growth(self) -> str:
        """What the motion makes of a small change, in a sentence."""
        return (
            f"By the last of these states a small change of the initial state has grown {self.nodes.growth:.2g} times."
        )

    @property
    def table(self) -> Table:
        nodes, named = self.nodes, any(self.nodes.experiments)
        records = [self.fit, *self.fit.experiments]
        along = records[-1].data.coordinate
        states = [f"{name} ({unit})" if unit else name for name, unit in zip(nodes.states, nodes.units, strict=True)]
        columns = ("sample", f"{along.name} ({along.unit})" if along.unit else along.name, *states, "largest gap")
        apart = np.nanmax(abs(nodes.ends - nodes.begins), axis=1)
        rows = [
            (
                *([cell(name)] if named else []),
                cell(int(sample)),
                cell(float(time)),
                *(cell("" if np.isnan(value) else float(value)) for value in begins),
                cell(float(gap), digits=2),
            )
            for name, sample, time, begins, gap in zip(
                nodes.experiments, nodes.samples, nodes.times, nodes.begins, apart, strict=True
            )
        ]
        columns = ("experiment", *columns) if named else columns
        return Table("nodes", "States found where segments meet", columns, rows)
