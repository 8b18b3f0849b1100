"""Responses against data."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from dalembert.report import charts
from dalembert.report.look import plain
from dalembert.report.needs import FitLike
from dalembert.report.plot import Plot
from dalembert.report.quantities import by_quantity, labelled
from dalembert.report.sections.samples import samples
from dalembert.report.sections.section import Section
from dalembert.report.table import Table, cell


@dataclass(frozen=True)
class Comparison(Section):
    """Computed and measured responses, a figure for each quantity, and how large the residuals are."""

    name: ClassVar[str] = "comparison"
    heading: ClassVar[str] = "Response and data"
    fit: FitLike

    @property
    def plots(self) -> tuple[Plot, ...]:
        channels = self.fit.data.channels
        chosen = [[channels[number] for number in group] for group in by_quantity(channels)]
        return tuple(
            Plot(
                f"responses-{place}",
                charts.responses(self.fit, group, title=", ".join(plain(name) for name in group)),
                "Lines are computed with the identified values, circles are data; below, computed minus measured.",
            )
            for place, group in enumerate(chosen, start=1)
        )

    @property
    def table(self) -> Table:
        data = self.fit.data
        residuals = np.where(np.isfinite(self.fit.residuals), self.fit.residuals, 0.0)  # 0 where a value is missing
        counts = np.count_nonzero(np.isfinite(data.values), axis=0)
        deviations = np.full(len(data.channels), np.nan) if data.deviations is None else data.deviations
        rows = [
            (
                cell(channel),
                cell(float(np.sqrt(np.sum(residuals[:, column] ** 2) / counts[column])), digits=4),
                cell(float(np.abs(residuals[:, column]).max()), digits=4),
                cell(float(data.coordinate.values[np.abs(residuals[:, column]).argmax()])),
                cell(float(deviations[column])),
            )
            for column, channel in enumerate(data.channels)
        ]
        at = labelled(f"largest at {data.coordinate.name}", data.coordinate.unit)
        columns = ("channel", "rms residual", "largest residual", at, "deviation of the data")
        return Table("residuals", "Residuals, in the units of their channels", columns, rows)

    @property
    def samples(self) -> Table | None:
        """All samples, for download, unless they are too many for a page."""
        data = self.fit.data
        series = {"measured": data.values, "computed": self.fit.response}
        return samples("responses", "Measured and computed samples", data.coordinate, data.channels, series)
