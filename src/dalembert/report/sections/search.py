"""How the search went."""

from dataclasses import dataclass
from typing import ClassVar

from dalembert.report import charts
from dalembert.report.charts.correlation import unknowns
from dalembert.report.charts.l_curve import accounts
from dalembert.report.charts.starts import ranked
from dalembert.report.needs import IdentifiedLike
from dalembert.report.plot import Plot
from dalembert.report.sections.section import Section
from dalembert.report.table import Table, cell


@dataclass(frozen=True)
class Search(Section):
    """Convergence of every start or swarm, and where each start ended."""

    name: ClassVar[str] = "search"
    heading: ClassVar[str] = "Search"
    fit: IdentifiedLike

    @property
    def plots(self) -> tuple[Plot, ...]:
        come = Plot("convergence", charts.convergence(self.fit), "One line a start; the winning one in colour.")
        plots = [come]
        if len(self.fit.starts) > 1:
            ends = "Starts in order of their final fitness; a flat step is a minimum that many starts lead to."
            plots.append(Plot("starts", charts.starts(self.fit), ends))
        if accounts(self.fit):
            corner = "The weight is chosen at the corner, and raised until the step goes as the linear model foresees."
            went = "Agreement is the fall of the sum of squares over the fall foreseen; 1 is just as foreseen."
            plots.append(Plot("l-curve", charts.l_curve(self.fit), corner))
            plots.append(Plot("steps", charts.steps(self.fit), went))
        return tuple(plots)

    @property
    def table(self) -> Table:
        fit = self.fit
        columns = (
            "start",
            "fitness",
            "simulations",
            "ended",
            "message",
            *(f"{name} at end" for name in unknowns(fit)),
        )
        rows = [
            (
                cell(number + 1),
                cell(float(start.fitness), digits=4),
                cell(int(start.simulations)),
                cell("converged" if start.success else "not converged", mark=not start.success),
                cell(start.message),
                *(cell(float(value)) for value in start.end),
            )
            for number, start in ((number, fit.starts[number]) for number in ranked(fit))
        ]
        return Table("starts", "Where each start ended, best first", columns, rows)
