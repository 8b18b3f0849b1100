"""The set of parameters that are consistent with bounded-error data."""

import numpy as np

from dalembert.inverse import ParameterSet
from dalembert.report import charts
from dalembert.report.charts.identification.paving import planes
from dalembert.report.headline import Headline
from dalembert.report.options import ReportOptions
from dalembert.report.registry import sections_of
from dalembert.report.section import Plot, Row, Section
from dalembert.tables import box_table, counted, few_values, interval, shown

BOXES = (
    ("outer", "Outer box: all consistent parameters lie in it"),
    ("inner", "Inner box: all parameters in it are consistent"),
)


@sections_of(ParameterSet)
def parameter_set(found: ParameterSet, options: ReportOptions) -> list[Section]:
    """Outer and inner box, and the paving in the planes of the parameters."""
    boxes = [(getattr(found, name), caption, f"{name}-box") for name, caption in BOXES]
    tables = [box_table(*box, units=found.parameters.units(box[0].names)) for box in boxes if box[0] is not None]
    caption = "Every point of a consistent box explains all data within their errors; an undecided box may hold some."
    plots = [
        Plot(f"paving-{place}", charts.paving(found, plane, truth=options.truth), caption)
        for place, plane in enumerate(planes(found.parameters.names), start=1)
    ]
    return [_headline(found), Section("Consistent set", (*tables, Row(plots)))]


def _headline(found: ParameterSet) -> Headline:
    box = found.outer
    whole = float(np.prod(found.parameters.upper - found.parameters.lower))
    least, most = (shown(100 * volume / whole, digits=3) for volume in found.volume)
    ends = [] if box is None else [f"in {interval(*pair)}" for pair in zip(box.lower, box.upper, strict=True)]
    return Headline(
        title="Consistent parameters",
        verdict="empty" if box is None else "found" if found.success else "not settled",
        success=found.success and box is not None,
        status=found.status,
        facts={
            **(few_values(found.parameters, ends) if ends else {}),
            "part of what was searched": f"{least} to {most} %",
            "boxes": counted(len(found.inside) + len(found.boundary)),
            "runs of the model": counted(found.runs),
        },
    )
