"""Tables that sections of several results have: intervals of a box, and series to download."""

from collections.abc import Mapping, Sequence

import numpy as np

from dalembert.forward import Coordinate
from dalembert.intervals import Box
from dalembert.report.quantities import labelled
from dalembert.report.section import Download
from dalembert.report.table import Table


def box_table(box: Box, caption: str, name: str = "box", *, units: Sequence[str] = (), **more: Sequence[str]) -> Table:
    """Ends, middle and radius of each interval of a box, the units that are known, and more columns."""
    middle, radius = (box.lower + box.upper) / 2, (box.upper - box.lower) / 2
    columns = {"parameter": box.names, "lower": box.lower, "upper": box.upper, "middle": middle, "radius": radius}
    if any(units):
        columns["unit"] = units
    return Table.of(name, caption, {**columns, **more})


MOST_ROWS = 5000
"""Numbers of a series up to which a page holds them."""


def samples(
    name: str, along: Coordinate, channels: Sequence[str], series: Mapping[str, np.ndarray], words: str
) -> Download:
    """Download of series (samples, channels), each with its word; of nothing where they are too many for a page."""
    if max(values.size for values in series.values()) > MOST_ROWS:
        return Download(None, words)
    columns = {labelled(along.name, along.unit): along.values}
    columns |= {
        f"{channel} {word}".rstrip(): values[:, column]
        for column, channel in enumerate(channels)
        for word, values in series.items()
    }
    return Download(Table.of(name, "", columns), words)
