"""Table of the intervals of a box."""

from collections.abc import Sequence

from dalembert.intervals import Box
from dalembert.report.table import Table


def box_table(box: Box, caption: str, name: str = "box", *, units: Sequence[str] = (), **more: Sequence[str]) -> Table:
    """Ends, middle and radius of each interval of a box, the units that are known, and more columns."""
    middle, radius = (box.lower + box.upper) / 2, (box.upper - box.lower) / 2
    columns = {"parameter": box.names, "lower": box.lower, "upper": box.upper, "middle": middle, "radius": radius}
    if any(units):
        columns["unit"] = units
    return Table.of(name, caption, {**columns, **more})
