"""Methods compared on the same box."""

import numpy as np

from dalembert.report import charts
from dalembert.report.asked import Asked
from dalembert.report.charts.bounds.methods import reference
from dalembert.report.digits import counted
from dalembert.report.headline import Headline
from dalembert.report.registry import sections_of
from dalembert.report.section import Plot, Row, Section
from dalembert.report.sections.bounds.propagation import bounds
from dalembert.report.table import Table, cell, cells
from dalembert.uncertainty import Comparison


@sections_of(Comparison)
def comparison(result: Comparison, asked: Asked) -> list[Section]:
    """Methods, and the bounds of the one that the others are measured by."""
    known = reference(result)
    facts = {
        "methods": counted(len(result.results) + len(result.refused)),
        "reference": known.method,
        "its runs": counted(known.runs),
        "runs altogether": counted(sum(one.runs for one in result.results)),
    }
    headline = Headline.of("Methods compared", result.success, ("compared", "incomplete"), result.status, facts)
    against = "Further down is closer to the reference, further left is cheaper."
    where = f"Largest distance of any bound from that of {result.reference}, sample by sample; none in a gap."
    plots = [Plot("methods", charts.methods(result), against), Plot("differences", charts.differences(result), where)]
    return [headline, Section("Methods", (_table(result), Row(plots))), bounds(known)]


def _table(result: Comparison) -> Table:
    """What each method found, how far from the reference, and what it cost."""
    known = reference(result)
    rows = []
    for row, one in zip(result.rows, result.results, strict=True):
        errors = (np.nan, np.nan) if one is known else (row.largest, row.rms)
        note = "the reference" if one is known else "" if one.success else one.status
        cost = (row.runs, cell(row.seconds, digits=3), cell(note, mark=not one.success))
        rows.append((row.method, row.kind, row.width, *cells(errors, 3), *cost))
    rows += [(method, "none", *[np.nan] * 5, cell(reason, mark=True)) for method, reason in result.refused]
    names = ("method", "kind", "mean width", "largest error", "rms error", "runs", "time (s)", "note")
    return Table.of_rows("methods", "Methods on the same box; errors are distances from the reference", names, rows)
