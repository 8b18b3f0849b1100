"""Bounds of the response over a box of parameters, by one method or by several."""

import numpy as np

from dalembert.report import charts
from dalembert.report.charts.bounds.methods import reference
from dalembert.report.digits import counted, shown
from dalembert.report.headline import Headline
from dalembert.report.look import plain
from dalembert.report.options import ReportOptions
from dalembert.report.quantities import by_quantity, labelled, unit
from dalembert.report.registry import sections_of
from dalembert.report.section import Listed, Plot, Row, Section
from dalembert.report.sections.shared_tables import box_table, samples
from dalembert.report.table import Cell, Table, cell, cells, noted
from dalembert.uncertainty import Comparison, Propagation

MEANING = {
    "inner bound": "Runs of the model within the box reach both sides of the band; the true one may be wider",
    "estimate": "Whatever the parameters are within their intervals, the response lies about in the band",
    "enclosure of the surrogate": "Whatever the parameters are within their intervals, the surrogate lies in the band, "
    "and the response as far as the estimated error of the surrogate holds",
}


@sections_of(Propagation)
def propagation(result: Propagation, options: ReportOptions) -> list[Section]:
    """Bounds by one method."""
    error = result.error
    facts = {
        "method": result.method,
        "the bounds are": result.kind,
        "largest estimated error": "unknown" if error is None else shown(float(error.max()), digits=2),
        "runs of the model": counted(result.runs),
        "time": f"{shown(result.seconds, digits=3)} s",
    }
    verdicts = ("bounded", "not bounded")
    return [Headline.of("Bounds of the response", result.success, verdicts, result.status, facts), bounds(result)]


def bounds(result: Propagation) -> Section:
    """The box, a figure of the bounds for each quantity, and how wide they are."""
    how = f"{MEANING[result.kind]}; below, how wide the band is."
    plots = [
        Plot(f"bands-{place}", charts.bands(result, group, title=", ".join(map(plain, group))), how)
        for place, group in enumerate(by_quantity(result.channels), start=1)
    ]
    reasons = [finding.message for finding in result.findings if finding.code == "unknown-error"]
    series = {"lower": result.lower, "upper": result.upper}
    download = samples("bounds", result.coordinate, result.channels, series, "Download all bounds as CSV")
    box = box_table(result.box, "Intervals of the parameters", units=result.parameter_units)
    return Section("Bounds", (box, *plots, _widths(result), Listed(reasons), download))


def _widths(result: Propagation) -> Table:
    width, along, corners = result.upper - result.lower, result.coordinate, at_corners(result)
    errors = ["unknown"] * len(result.channels) if result.error is None else result.error.max(axis=0)
    columns = {
        "channel": result.channels,
        "largest width": width.max(axis=0),
        labelled(f"at {along.name}", along.unit): along.values[width.argmax(axis=0)],
        "mean width": [column.mean() for column in width.T],
        "estimated error": cells(errors, 2),
    }
    if corners is not None:
        columns["taken at corners of the box"] = [Cell(float(part), f"{100 * part:.0f} %") for part in corners]
    columns["unit"] = [unit(channel, known) for channel, known in zip(result.channels, result.units, strict=True)]
    return noted(Table.of("widths", "Widths", columns))


def at_corners(result: Propagation) -> np.ndarray | None:
    """Part of each channel's bounds that are taken at a corner of the box, (channels,); None where it is not known."""
    if result.at_lower is None or result.at_upper is None:
        return None
    at = np.stack([result.at_lower, result.at_upper])
    near = 1e-6 * (result.box.upper - result.box.lower)
    on_end = (at <= result.box.lower + near) | (at >= result.box.upper - near)
    return on_end.all(axis=-1).mean(axis=(0, 1))


@sections_of(Comparison)
def comparison(result: Comparison, options: ReportOptions) -> list[Section]:
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
