"""Free vibrations of a structure."""

from dataclasses import dataclass
from typing import ClassVar

from dalembert.report import charts
from dalembert.report.charts.mode_shapes import MOST
from dalembert.report.plot import Plot
from dalembert.report.sections.findings import Findings
from dalembert.report.table import Table, cell
from dalembert.structure import ModeShapes


@dataclass(frozen=True)
class Modes(Findings):
    """Pictures of the modes and a table of their frequencies."""

    heading: ClassVar[str] = "Mode shapes"
    modes: ModeShapes

    @property
    def wide(self) -> tuple[Plot, ...]:
        how = "The slider goes through the modes; thin lines: at rest; dark: nodal lines."
        if len(self.modes.frequencies) > MOST:
            how += f" Drawn are the first {MOST}."
        return (Plot("mode-shapes", charts.mode_shapes(self.modes), how),)

    @property
    def tables(self) -> tuple[Table, ...]:
        rows = [(cell(number), cell(float(value))) for number, value in enumerate(self.modes.frequencies, 1)]
        return (Table("modes", "Natural frequencies", ("mode", "frequency (Hz)"), rows),)
