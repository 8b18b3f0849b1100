"""A set of consistent parameters as text."""

from dalembert.inverse.fit.summary import table
from dalembert.inverse.sets.parameter_set import ParameterSet
from dalembert.results import fixed_lines


def summary(found: ParameterSet) -> str:
    """Table of outer and inner intervals with unit and bounds; then volume, boxes, effort and status."""
    rows: list[tuple[str, ...]] = [("parameter", "outer", "inner", "unit", "bounds")]
    for item in found.parameters:
        outer, inner = ("none" if box is None else str(box[item.name]) for box in (found.outer, found.inner))
        rows.append((item.name, outer, inner, item.unit, f"{item.lower:.6g} to {item.upper:.6g}"))
    smallest, largest = found.volume
    facts = [
        f"volume       {smallest:.6g} to {largest:.6g}",
        f"boxes        {len(found.inside)} inside, {len(found.boundary)} on the boundary",
        f"simulations  {found.runs}",
        f"seconds      {found.seconds:.2g}",
        *fixed_lines(found),
    ]
    return "\n".join([*table(rows), "", *facts, "", found.status, *map(str, found.findings)])
