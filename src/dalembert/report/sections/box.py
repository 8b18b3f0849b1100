"""Table of the intervals of a box."""

from dalembert.intervals import Box
from dalembert.report.table import Table


def box_table(box: Box, caption: str, name: str = "box") -> Table:
    """Ends, middle and radius of each interval of a box."""
    middle, radius = (box.lower + box.upper) / 2, (box.upper - box.lower) / 2
    columns = {"parameter": box.names, "lower": box.lower, "upper": box.upper, "middle": middle, "radius": radius}
    return Table.of(name, caption, columns)
