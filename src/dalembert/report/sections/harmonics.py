"""The harmonics of the motion, and whether enough of them are kept."""

from dataclasses import dataclass
from typing import ClassVar

from dalembert.report import charts
from dalembert.report.charts.harmonic_content import by_order
from dalembert.report.digits import shown
from dalembert.report.focus import Look, unit_of
from dalembert.report.plot import Plot
from dalembert.report.quantities import labelled
from dalembert.report.sections.findings import Findings
from dalembert.report.table import Table, cell

ENOUGH = 1e-2
"""Size of the last harmonics at the peak, as part of the largest, above which more of them should be kept."""


@dataclass(frozen=True)
class Harmonics(Findings):
    """Amplitude of each harmonic over frequency, and at the peak."""

    heading: ClassVar[str] = "Harmonics"
    look: Look

    @property
    def _peak(self) -> dict[int, float]:
        sizes = by_order(self.look.curve, self.look.dof)
        return {order: float(size[self.look.point]) for order, size in sizes.items()}

    @property
    def sentences(self) -> tuple[str, ...]:
        sizes = self._peak
        most, higher = max(sizes.values()), [size for order, size in sizes.items() if order > 1]
        if most <= 0 or not higher:
            return ()
        last = max(higher[-2:])
        part = f"{shown(100 * last / most, digits=2)} % of the largest one"
        if last > ENOUGH * most:
            return (f"At the peak the last two harmonics kept still reach {part}; keep more harmonics.",)
        return (f"At the peak the last two harmonics kept are at most {part}.",)

    @property
    def wide(self) -> tuple[Plot, ...]:
        how = "Harmonics that stay below a millionth of the largest are left out."
        return (Plot("harmonic-content", charts.harmonic_content(self.look.curve, self.look.dof), how),)

    @property
    def tables(self) -> tuple[Table, ...]:
        sizes = self._peak
        whole = max(sizes.values())
        rows = [
            (
                cell("mean" if order == 0 else f"harmonic {order}"),
                cell(size),
                cell(100 * size / whole if whole else 0.0, digits=3),
            )
            for order, size in sizes.items()
        ]
        columns = ("part of the motion", labelled("amplitude", unit_of(self.look.dof)), "of the largest (%)")
        return (Table("harmonics", f"Harmonics of {self.look.dof} at its peak", columns, rows),)
