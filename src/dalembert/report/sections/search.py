"""How the search went."""

from dataclasses import dataclass
from typing import ClassVar

from dalembert.report import charts
from dalembert.report.charts.correlation import unknowns
from dalembert.report.charts.starts import ranked
from dalembert.report.needs import BandFitLike, FitLike
from dalembert.report.plot import Plot
from dalembert.report.sections.section import Section
from dalembert.report.table import Table, cell


@dataclass(frozen=True)
class Search(Section):
    """Convergence of every start or swarm, and where each start ended."""

    name: ClassVar[str] = "search"
    heading: ClassVar[str] = "Search"
    fit: FitLike | BandFitLike

    @property
    def plots(self) -> tuple[Plot, ...]:
        come = Plot("convergence", charts.convergence(self.fit), "One line a start; the winning one in colour.")
        if len(self.fit.starts) < 2:
            return (come,)
        ends = "Starts in order of their final fitness; a flat step is a minimum that many starts lead to."
        return (come, Plot("starts", charts.starts(self.fit), ends))

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
