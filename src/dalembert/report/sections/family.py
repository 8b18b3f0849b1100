"""Responses over frequency for several values of a parameter: the best one, and what it gains."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from dalembert.report import charts
from dalembert.report.charts.resonance_peaks import value_text
from dalembert.report.digits import shown
from dalembert.report.focus import unit_of
from dalembert.report.plot import Plot
from dalembert.report.prefixes import in_words
from dalembert.report.quantities import labelled
from dalembert.report.sections.findings import Findings
from dalembert.report.table import Table, cell, noted
from dalembert.vibration import CurveFamily, FrequencyCurve


@dataclass(frozen=True)
class Family(Findings):
    """Curves with their envelope, peaks over the parameter, and a table of the peaks and what they gain."""

    heading: ClassVar[str] = "Responses over the parameter"
    family: CurveFamily
    dofs: tuple[str, ...]
    kind: str = "peak"

    @property
    def sentences(self) -> tuple[str, ...]:
        family, dof = self.family, self.dofs[0]
        peaks, values = family.peaks(dof, self.kind), np.asarray(family.values)
        best = int(np.flatnonzero(values == family.best(dof, self.kind))[0])
        gain = float(family.reduction(dof, self.kind)[best])
        told = f"The smallest peak of {dof} is at {family.parameter} = {value_text(family, values[best])}: "
        told += f"{in_words(peaks[best].amplitude, unit_of(dof), 4)} at {shown(peaks[best].frequency)} Hz"
        if best and np.isfinite(gain):
            told += f", {shown(100 * gain, digits=3)} % below that at {value_text(family, values[0])}"
        ends = [place for place in (0, len(values) - 1) if np.isfinite(peaks[place].frequency)]
        shift = ""
        if len(ends) == 2:
            first, last = (shown(peaks[place].frequency) for place in ends)
            shift = f"From {value_text(family, values[0])} to {value_text(family, values[-1])} "
            shift += f"the frequency of the peak goes from {first} to {last} Hz."
        told_all = [f"{told}.", shift]
        if len(values) > 1 and values[best] in (values.min(), values.max()):
            told_all.append("It lies at the end of the values: beyond them the peak may be smaller still.")
        return tuple(filter(None, told_all))

    @property
    def wide(self) -> tuple[Plot, ...]:
        how = "Dotted and dashed: what the best and the worst value would give at each frequency alone."
        return tuple(
            Plot(f"curve-family-{place}", charts.curve_family(self.family, dof, kind=self.kind), how)
            for place, dof in enumerate(self.dofs, start=1)
        )

    @property
    def pairs(self) -> tuple[Plot, ...]:
        return tuple(
            Plot(
                f"family-peaks-{place}",
                charts.family_peaks(self.family, dof, kind=self.kind),
                "Below, the frequency of the peak.",
            )
            for place, dof in enumerate(self.dofs, start=1)
        )

    @property
    def tables(self) -> tuple[Table, ...]:
        return tuple(self._table(place, dof) for place, dof in enumerate(self.dofs, start=1))

    def _table(self, place: int, dof: str) -> Table:
        family = self.family
        rows = [
            (
                cell(float(value)),
                cell(float(peak.amplitude)),
                cell(float(peak.frequency)),
                cell(float(-100 * gain), digits=4),
                cell("" if curve is None else f"{int(curve.converged.sum())} of {len(curve.converged)}"),
                cell(reason or "", mark=bool(reason)),
            )
            for value, peak, gain, curve, reason in zip(
                family.values,
                family.peaks(dof, self.kind),
                family.reduction(dof, self.kind),
                family.curves,
                family.failures,
                strict=True,
            )
        ]
        columns = (
            labelled(family.parameter, family.unit),
            labelled("peak", unit_of(dof)),
            "at frequency (Hz)",
            "change from the first (%)",
            "points found",
            "note",
        )
        return noted(Table(f"family-{place}", f"Peaks of {dof}", columns, rows))


def best_curve(family: CurveFamily, dof: str, kind: str) -> FrequencyCurve:
    """The curve with the smallest peak."""
    best = int(np.flatnonzero(np.asarray(family.values) == family.best(dof, kind))[0])
    curve = family.curves[best]
    assert curve is not None
    return curve
