"""How far a curve over frequency can be trusted."""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from dalembert.report import charts
from dalembert.report.digits import shown
from dalembert.report.plot import Plot
from dalembert.report.sections.findings import Findings
from dalembert.report.table import Table, cell
from dalembert.vibration import FrequencyCurve


@dataclass(frozen=True)
class Balance(Findings):
    """Newton iterations, residuals and samples of the points."""

    heading: ClassVar[str] = "Diagnostics of the balance"
    curve: FrequencyCurve

    @property
    def sentences(self) -> tuple[str, ...]:
        found = self.curve.converged
        if not found.any():
            return ()
        error = float(np.nanmax(np.asarray(self.curve.sampling_errors)[found], initial=0.0))
        allowed: Any = self.curve.provenance.get("method", {}).get("sampling")
        told = f"Twice as many samples of a period would change the forces by at most {shown(error, digits=2)} of them."
        if allowed is not None and error > allowed:
            told += f" That is more than the {shown(float(allowed), digits=2)} allowed: give more samples."
        return (told,)

    @property
    def wide(self) -> tuple[Plot, ...]:
        how = "A rise shows where the motion is hard to find: where contacts begin to slip or to lift off."
        return (Plot("points-found", charts.points_found(self.curve), how),)

    @property
    def tables(self) -> tuple[Table, ...]:
        curve = self.curve
        found = curve.converged
        counts = np.asarray(curve.iterations)
        settings = curve.provenance.get("method", {})
        rows = [
            ("points", len(found)),
            ("points found", int(found.sum())),
            ("Newton iterations a point, mean", float(counts.mean())),
            ("Newton iterations a point, most", int(counts.max(initial=0))),
            ("largest unbalanced part of the forces, of points found", _most(curve.residuals, found)),
            ("samples of a period, most", int(np.max(np.asarray(curve.samples), initial=0))),
            ("change of the forces with twice the samples, most", _most(curve.sampling_errors, found)),
            *((f"setting: {name}", settings[name]) for name in ("tolerance", "sampling") if name in settings),
        ]
        cells = [tuple(cell(entry, digits=3) for entry in row) for row in rows]
        return (Table("balance", "Diagnostics", ("quantity", "value"), cells),)


def _most(values: np.ndarray, found: np.ndarray) -> float:
    own = np.asarray(values, dtype=float)[found]
    return float(np.nanmax(own)) if np.isfinite(own).any() else float("nan")
