"""How the search went."""

from dataclasses import dataclass
from typing import ClassVar

from dalembert.inverse import BandFit, Fit
from dalembert.report import charts
from dalembert.report.charts.correlation import unknowns
from dalembert.report.charts.l_curve import accounts
from dalembert.report.charts.starts import ranked
from dalembert.report.plot import Plot
from dalembert.report.sections.section import Section
from dalembert.report.table import Table, cell

GREW = "Fewer samples were fitted first: a line begins where all are compared, its simulations counting those before."
LEAST_SQUARES = ("LeastSquares", "ResponseSensitivity")
"""Methods whose horizon may grow."""


@dataclass(frozen=True)
class Search(Section):
    """Convergence of every start or swarm, and where each start ended."""

    name: ClassVar[str] = "search"
    heading: ClassVar[str] = "Search"
    fit: Fit | BandFit

    @property
    def plots(self) -> tuple[Plot, ...]:
        lines = "One line a start; the winning one in colour."
        come = f"{lines} {GREW}" if grew(self.fit) else lines
        plots = [Plot("convergence", charts.convergence(self.fit), come)]
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


def grew(fit: Fit | BandFit) -> bool:
    """Whether the horizon of the first start grew: more was simulated than the one linearised run of a first step."""
    facts = fit.provenance
    asked = facts.get("horizon") == "growing" and facts.get("method", {}).get("name") in LEAST_SQUARES
    first = next((step.simulations for step in fit.history if step.start == 0), 0)
    return asked and getattr(fit, "nodes", None) is None and first > 1 + len(fit.parameters)
