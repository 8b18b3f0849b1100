"""How far a curve over frequency can be trusted."""

import numpy as np

from dalembert.report import charts
from dalembert.report.digits import shown
from dalembert.report.section import Fold, Plot, Section
from dalembert.report.table import Table, cells
from dalembert.vibration import FrequencyCurve


def balance(curve: FrequencyCurve) -> Section:
    """Newton iterations, residuals and samples of the points."""
    found, counts, settings = curve.converged, np.asarray(curve.iterations), curve.provenance.get("method", {})
    rows = {
        "points": len(found),
        "points found": int(found.sum()),
        "Newton iterations a point, mean": float(counts.mean()),
        "Newton iterations a point, most": int(counts.max(initial=0)),
        "largest unbalanced part of the forces, of points found": _most(curve.residuals, found),
        "samples of a period, most": int(np.max(np.asarray(curve.samples), initial=0)),
        "change of the forces with twice the samples, most": _most(curve.sampling_errors, found),
        **{f"setting: {name}": settings[name] for name in ("tolerance", "sampling") if name in settings},
    }
    table = Table.of("balance", "Diagnostics", {"quantity": rows, "value": cells(rows.values(), 3)})
    how = "A rise shows where the motion is hard to find: where contacts begin to slip or to lift off."
    plot = Plot("points-found", charts.points_found(curve), how)
    return Section("Diagnostics of the balance", (_sampling(curve), plot, Fold(table)))


def _sampling(curve: FrequencyCurve) -> str:
    """What more samples would change; empty where no point was found."""
    if not curve.converged.any():
        return ""
    error = float(np.nanmax(np.asarray(curve.sampling_errors)[curve.converged], initial=0.0))
    allowed = curve.provenance.get("method", {}).get("sampling")
    told = f"Twice as many samples of a period would change the forces by at most {shown(error, digits=2)} of them."
    if allowed is not None and error > allowed:
        told += f" That is more than the {shown(float(allowed), digits=2)} allowed: give more samples."
    return told


def _most(values: np.ndarray, found: np.ndarray) -> float:
    own = np.asarray(values, dtype=float)[found]
    return float(np.nanmax(own)) if np.isfinite(own).any() else float("nan")
