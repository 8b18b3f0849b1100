"""Each of several experiments against its data."""

import re
from dataclasses import dataclass
from typing import ClassVar

from dalembert.inverse import ExperimentFit, Fit
from dalembert.report.look import plain
from dalembert.report.plot import Plot
from dalembert.report.sections.comparison import all_samples, misfits, plots, residual_cells, validation
from dalembert.report.sections.section import Section
from dalembert.report.table import Table, cell, noted


@dataclass(frozen=True)
class Experiments(Section):
    """Computed and measured responses of each experiment, and how large the residuals are."""

    name: ClassVar[str] = "experiments"
    heading: ClassVar[str] = "Experiments"
    fit: Fit
    experiments: tuple[ExperimentFit, ...]

    @property
    def validation(self) -> str:
        """How what was not fitted is predicted, in a sentence; empty if all was fitted."""
        return validation(self.fit)

    @property
    def plots(self) -> tuple[Plot, ...]:
        numbered = enumerate(self.experiments, start=1)
        return tuple(plot for number, item in numbered for plot in self._plots(item, number))

    @property
    def table(self) -> Table:
        rows = [
            (cell(item.name), *cells, cell("" if item.fitted else "predicted", mark=not item.fitted))
            for item in self.experiments
            for cells in residual_cells(item)
        ]
        columns = (
            "experiment",
            "channel",
            "rms residual",
            "largest residual",
            "largest at",
            "deviation of the data",
            "unit",
            "note",
        )
        return noted(Table("residuals", "Residuals", columns, rows))

    @property
    def samples(self) -> list[tuple[str, Table]]:
        """All samples of each experiment, for download, unless they are too many for a page."""
        found = []
        for number, item in enumerate(self.experiments, start=1):
            file = re.sub(r"[^\w-]", "-", item.name)
            table = all_samples(item, f"responses-{number}-{file}")
            if table is not None:
                found.append((f"Download all samples of {item.name} as CSV", table))
        return found

    def _plots(self, item: ExperimentFit, number: int) -> tuple[Plot, ...]:
        lead = f"{plain(item.name)}{'' if item.fitted else ' (predicted)'}: "
        return plots(item, f"experiment-{number}", lead, misfits(self.fit, item.name))
