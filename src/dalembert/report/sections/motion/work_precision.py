"""Integrators compared on one motion."""

import numpy as np

from dalembert.multibody import WorkPrecision
from dalembert.report import charts
from dalembert.report.headline import Headline
from dalembert.report.options import ReportOptions
from dalembert.report.registry import sections_of
from dalembert.report.section import Plot, Section
from dalembert.tables import Table, cells, counted, marks, shown

ERRORS = (1e-4, 1e-8)
"""Errors that the fastest integrator is named for."""
VIOLATIONS = {"|Φ|": "position", "|Φ̇|": "velocity", "|Φ̈|": "acceleration", "energy": "energy"}


@sections_of(WorkPrecision)
def work_precision(found: WorkPrecision, options: ReportOptions) -> list[Section]:
    """Error, run time and constraint violations of each integrator with each of its settings."""
    fastest = {f"fastest to {error:.0e}": row.method for error in ERRORS if (row := found.fastest(error))}
    facts = {
        "simulated": shown(found.end) + " s",
        "integrators": counted(len(found.methods)),
        "runs": counted(len(found.rows)),
        **fastest,
    }
    headline = Headline.of("Work and precision", found.success, ("compared", "not compared"), found.status, facts)
    known = f"to about {found.apart:.1e}" if np.isfinite(found.apart) and found.apart > 0 else "to rounding"
    trusted = f"The reference is {found.reference}; beside a second one it is known {known}."
    how = "Further down is more exact, further left is faster. Below the dotted line nothing is known."
    plot = Plot("work-precision", charts.work_precision(found), how)
    return [headline, Section("Integrators", (trusted, plot, _table(found)))]


def _table(found: WorkPrecision) -> Table:
    rows = found.rows
    columns = {
        "integrator": [row.method for row in rows],
        "settings": [row.settings for row in rows],
        "error": cells((row.error for row in rows), 3),
        "run time (s)": cells((row.seconds for row in rows), 3),
        "steps": [row.steps for row in rows],
        **{word: cells((getattr(row, key) for row in rows), 2) for word, key in VIOLATIONS.items()},
        "note": marks(row.failure for row in rows),
    }
    caption = "Errors relative to the channels' ranges, constraint violations, energy relative to the kinetic energy's"
    return Table.of("integrators", caption, columns)
