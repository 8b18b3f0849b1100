"""Table of the identified parameters."""

from dataclasses import dataclass
from typing import ClassVar

from dalembert.report import charts
from dalembert.report.charts.parameters import on_bound
from dalembert.report.needs import FitLike
from dalembert.report.plot import Plot
from dalembert.report.sections.section import Section
from dalembert.report.table import Table, cell, noted


@dataclass(frozen=True)
class Estimates(Section):
    """Values with standard deviations and bounds; a value on a bound is marked."""

    name: ClassVar[str] = "estimates"
    heading: ClassVar[str] = "Parameters"
    fit: FitLike

    @property
    def table(self) -> Table:
        fit = self.fit
        rows = [
            (
                cell(item.name),
                cell(float(value), deviation, mark=bool(stuck)),
                cell(float(deviation), digits=2),
                cell(item.unit),
                cell(float(item.lower)),
                cell(float(item.upper)),
                cell("on its bound" if stuck else "", mark=bool(stuck)),
            )
            for item, value, deviation, stuck in zip(
                fit.parameters, fit.values, fit.deviations, on_bound(fit), strict=True
            )
        ]
        columns = ("parameter", "value", "standard deviation", "unit", "lower bound", "upper bound", "note")
        return noted(Table("parameters", "Identified values", columns, rows))

    @property
    def plots(self) -> tuple[Plot, ...]:
        caption = "Each value where it lies between its bounds; bars are two standard deviations."
        return (Plot("parameters", charts.parameters(self.fit), caption),)
