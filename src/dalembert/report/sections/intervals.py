"""Table of the identified intervals."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from dalembert.inverse import BandFit
from dalembert.report import charts
from dalembert.report.plot import Plot
from dalembert.report.sections.section import Section
from dalembert.report.table import Table, cell

NONE = 1e-6
"""Radii below this part of the way between the search bounds are none."""


@dataclass(frozen=True)
class Intervals(Section):
    """Middles and radii with standard deviations, the intervals that they make, and the true ones if known."""

    name: ClassVar[str] = "intervals"
    heading: ClassVar[str] = "Parameters"
    fit: BandFit
    truth: Mapping[str, tuple[float, float]] = field(default_factory=dict)

    @property
    def table(self) -> Table:
        fit = self.fit
        rows = [
            (
                cell(item.name),
                cell(float(fit.box.lower[k])),
                cell(float(fit.box.upper[k])),
                *self._known(item.name),
                cell(float(fit.middle[k]), fit.middle_deviations[k]),
                cell(float(fit.middle_deviations[k]), digits=2),
                cell(float(fit.radius[k]), fit.radius_deviations[k]),
                cell(float(fit.radius_deviations[k]), digits=2),
                cell(item.unit),
                cell(note(fit, k), mark=bool(note(fit, k))),
            )
            for k, item in enumerate(fit.parameters)
        ]
        columns = ["parameter", "lower", "upper"]
        columns += ["true lower", "true upper"] if self.truth else []
        columns += ["middle", "its deviation", "radius", "its deviation", "unit", "note"]
        return Table("intervals", "Identified intervals", columns, rows)

    def _known(self, name: str) -> list:
        """Cells of the true interval, where any is given."""
        return [cell(float(end)) for end in self.truth.get(name, (np.nan, np.nan))] if self.truth else []

    @property
    def plots(self) -> tuple[Plot, ...]:
        caption = (
            "Each interval where it lies between its search bounds; whiskers are two standard deviations of its ends"
        )
        caption += ", diamonds the true ends." if self.truth else "."
        return (Plot("intervals", charts.intervals(self.fit, self.truth), caption),)


def note(fit: BandFit, k: int) -> str:
    """Whether an interval is one, or a single number as far as the bands tell."""
    if fit.radius[k] <= NONE * (fit.parameters.upper[k] - fit.parameters.lower[k]):
        return "a single number"
    return "hardly told from a single number" if fit.radius[k] <= 2 * fit.radius_deviations[k] else ""
