"""All samples of some series, for download."""

from collections.abc import Mapping, Sequence

import numpy as np

from dalembert.forward import Coordinate
from dalembert.report.quantities import labelled
from dalembert.report.table import Table, cell

MOST_ROWS = 5000
"""Numbers of a series up to which a page holds them."""


def samples(name: str, along: Coordinate, channels: Sequence[str], series: Mapping[str, np.ndarray]) -> Table | None:
    """Table of series (samples, channels), each with its word; None where they are too many for a page."""
    if max(values.size for values in series.values()) > MOST_ROWS:
        return None
    columns = [labelled(along.name, along.unit)]
    columns += [f"{channel} {word}" for channel in channels for word in series]
    beside = np.stack(list(series.values()), axis=2).reshape(len(along.values), -1)
    rows = [[cell(float(number)) for number in (at, *row)] for at, row in zip(along.values, beside, strict=True)]
    return Table(name, "", columns, rows)
