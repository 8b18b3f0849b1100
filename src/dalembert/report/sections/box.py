"""Table of the intervals of a box."""

from collections.abc import Sequence

from dalembert.intervals import Box
from dalembert.report.table import Table


def box_table(box: Box, caption: str, name: str = "box", **more: Sequence[str]) -> Table:
    """Ends, middle and radius of each interval of a box, and more columns."""
    middle, radius = (box.lower + box.upper) / 2, (box.upper - box.lower) / 2
    columns = {"parameter": box.names, "lower": box.lower, "upper": box.upper, "middle": middle, "radius": radius}
    return Table.of(name, caption, {**columns, **more})
