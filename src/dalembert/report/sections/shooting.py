"""The segments of multiple shooting: how they came together, and where they meet."""

from dataclasses import dataclass
from typing import ClassVar

from dalembert.report import charts
from dalembert.report.needs import FitLike, NodesLike
from dalembert.report.plot import Plot
from dalembert.report.sections.section import Section
from dalembert.report.table import Table, cell


@dataclass(frozen=True)
class Shooting(Section):
    """Gaps over the steps, and the states at which the segments meet."""

    name: ClassVar[str] = "shooting"
    heading: ClassVar[str] = "Multiple shooting"
    fit: FitLike
    nodes: NodesLike

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
        nodes, along = self.nodes, self.fit.data.coordinate
        units = {item.name: item.unit for item in self.fit.parameters}
        states = [f"{name} ({units[name]})" if units.get(name) else name for name in nodes.states]
        columns = ("sample", f"{along.name} ({along.unit})" if along.unit else along.name, *states, "largest gap")
        apart = abs(nodes.ends - nodes.begins).max(axis=1)
        rows = [
            (
                cell(int(sample)),
                cell(float(along.values[sample])),
                *(cell(float(value)) for value in begins),
                cell(float(gap), digits=2),
            )
            for sample, begins, gap in zip(nodes.samples, nodes.begins, apart, strict=True)
        ]
        return Table("nodes", "States found where segments meet", columns, rows)
