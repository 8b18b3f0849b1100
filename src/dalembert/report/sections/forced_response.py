"""Amplitudes over frequency, their peaks, and what happens along the path."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from dalembert.report import charts
from dalembert.report.digits import shown
from dalembert.report.focus import Look, marked, movers, size_label, unit_of, unstable
from dalembert.report.plot import Plot
from dalembert.report.quantities import labelled
from dalembert.report.sections.findings import Findings
from dalembert.report.table import Table, cell
from dalembert.vibration import Backbone

MOST_NAMED = 4
MOST_ROWS = 20


@dataclass(frozen=True)
class ForcedResponse(Findings):
    """The curve of the degrees of freedom looked at, and a table of the peaks of all."""

    heading: ClassVar[str] = "Forced response"
    look: Look
    mode: Backbone | None = None

    @property
    def sentences(self) -> tuple[str, ...]:
        curve = self.look.curve
        folds = [shown(float(curve.frequencies[point])) for point in marked(curve).get("fold", [])]
        told = []
        if folds:
            many = "The path turns back in frequency at"
            told.append(
                f"{many} {_listed(folds)} Hz: between folds several motions are possible at the same frequency, and a "
                "slow sweep jumps from one to another."
            )
        bad = unstable(curve)
        if bad.any():
            between = curve.frequencies[bad]
            told.append(
                f"{int(bad.sum())} of {len(bad)} points, between {shown(float(between.min()))} and "
                f"{shown(float(between.max()))} Hz, are unstable: the structure does not stay in these motions."
            )
        if len(self.look.dofs) < len(curve.dofs):
            observed = f"of the {len(curve.dofs)} observed"
            told.append(
                f"Drawn are {len(self.look.dofs)} degrees of freedom {observed}, in the table those that move most."
            )
        return tuple(told)

    @property
    def wide(self) -> tuple[Plot, ...]:
        how = "Each point is a periodic motion."
        how += " Symbols: where the path turns back or changes its stability." if marked(self.look.curve) else ""
        how += " Dashed: unstable motions." if unstable(self.look.curve).any() else ""
        how += " Crosses: not found." if not self.look.curve.converged.all() else ""
        how += " Dotted: the nonlinear mode without force." if self.mode is not None else ""
        figure = charts.frequency_curve(self.look.curve, self.look.dofs, kind=self.look.kind, mode=self.mode)
        return (Plot("frequency-curve", figure, how),)

    @property
    def tables(self) -> tuple[Table, ...]:
        return (_peaks(self.look), *_events(self.look))


def _peaks(look: Look) -> Table:
    curve, kind, rows = look.curve, look.kind, []
    tabled = {*look.dofs, *(curve.dofs if len(curve.dofs) <= MOST_ROWS else movers(curve, MOST_ROWS))}
    for dof in filter(tabled.__contains__, curve.dofs):
        peak, point = curve.peak(dof, kind), Look.of(curve, [dof], kind).point
        first = curve.amplitude(dof, f"harmonic {curve.orders[int(curve.orders[0] == 0)]}")[point]
        rows.append(
            (
                cell(dof),
                cell(peak.amplitude),
                cell(peak.frequency),
                cell(float(curve.amplitude(dof, "rms")[point])),
                cell(float(first)),
                cell(unit_of(dof)),
            )
        )
    size = f"largest {size_label(kind)}"
    columns = ("degree of freedom", size, "at frequency (Hz)", "its rms", "its first harmonic", "unit")
    return Table("peaks", "Resonance peaks", columns, rows)


def _events(look: Look) -> tuple[Table, ...]:
    """Tables of marked points and of those that were not found, where there are any."""
    curve, dofs, found = look.curve, look.dofs[:MOST_NAMED], []
    sizes = {dof: curve.amplitude(dof, look.kind) for dof in dofs}
    rows = [
        (
            cell(kind),
            cell(float(curve.frequencies[point])),
            *(cell(float(size[point])) for size in sizes.values()),
        )
        for kind, points in marked(curve).items()
        for point in points
    ]
    if rows:
        columns = ("what", "frequency (Hz)", *(labelled(f"{size_label(look.kind)} of {d}", unit_of(d)) for d in dofs))
        found.append(Table("marked-points", "Folds and changes of stability", columns, rows))
    lost = np.flatnonzero(~curve.converged)
    rows = [(cell(float(curve.frequencies[k])), cell(float(curve.residuals[k]), digits=2)) for k in lost]
    if rows:
        columns = ("frequency (Hz)", "left unbalanced, part of the forces")
        found.append(Table("not-found", "Points that were not found", columns, rows))
    return tuple(found)


def _listed(words: list[str]) -> str:
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"
