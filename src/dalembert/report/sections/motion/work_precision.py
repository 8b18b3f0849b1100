"""Integrators compared on one motion."""

import numpy as np

from dalembert.multibody import WorkPrecision
from dalembert.report import charts
from dalembert.report.asked import Asked
from dalembert.report.digits import counted, shown
from dalembert.report.headline import Headline
from dalembert.report.plot import Plot
from dalembert.report.registry import sections_of
from dalembert.report.section import Section
from dalembert.report.table import Table, cells, marks

ERRORS = (1e-4, 1e-8)
"""Errors that the fastest integrator is named for."""


@sections_of(WorkPrecision)
def work_precision(found: WorkPrecision, asked: Asked) -> list[Section]:
    """Error, run time and constraint violations of each integrator with each of its settings."""
    fastest = {f"fastest to {error:.0e}": row.method for error in ERRORS if (row := found.fastest(error))}
    headline = Headline(
        title="Work and precision",
        verdict="compared" if found.success else "not compared",
        success=found.success,
        status=found.status,
        facts={
            "simulated": shown(found.end) + " s",
            "integrators": counted(len(found.methods)),
            "runs": counted(len(found.rows)),
            **fastest,
        },
    )
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
        "|Φ|": cells((row.position for row in rows), 2),
        "|Φ̇|": cells((row.velocity for row in rows), 2),
        "|Φ̈|": cells((row.acceleration for row in rows), 2),
        "energy": cells((row.energy for row in rows), 2),
        "note": marks(row.failure for row in rows),
    }
    caption = "Errors relative to the channels' ranges, constraint violations, energy relative to the kinetic energy's"
    return Table.of("integrators", caption, columns)
