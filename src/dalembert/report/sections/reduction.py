"""What a reduction changes."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from dalembert.report import charts
from dalembert.report.digits import shown
from dalembert.report.plot import Plot
from dalembert.report.sections.findings import Findings
from dalembert.report.table import Table, cell
from dalembert.structure import ReductionErrors


@dataclass(frozen=True)
class Reduction(Findings):
    """Frequencies and shapes of the reduced structure's modes beside those of the full one."""

    heading: ClassVar[str] = "Reduction"
    errors: ReductionErrors

    @property
    def sentences(self) -> tuple[str, ...]:
        worst = shown(100 * float(np.max(self.errors.relative)), digits=2)
        least = shown(float(np.min(self.errors.similarity)), digits=4)
        told = (
            f"The lowest {len(self.errors.full)} frequencies of the reduced structure are at most {worst} % too high, "
        )
        return (f"{told}and their shapes are similar by {least} and more.",)

    @property
    def wide(self) -> tuple[Plot, ...]:
        how = "What is zero to rounding is not drawn."
        return (Plot("reduction-errors", charts.reduction_errors(self.errors), how),)

    @property
    def tables(self) -> tuple[Table, ...]:
        errors = self.errors
        percent = 100 * np.asarray(errors.relative)
        rows = [
            (cell(number), cell(float(full)), cell(float(reduced)), cell(float(error), digits=3), cell(float(alike)))
            for number, (full, reduced, error, alike) in enumerate(
                zip(errors.full, errors.reduced, percent, errors.similarity, strict=True), 1
            )
        ]
        columns = ("mode", "full (Hz)", "reduced (Hz)", "error (%)", "similarity of the shapes")
        return (Table("reduction", "Modes of the full and the reduced structure", columns, rows),)
