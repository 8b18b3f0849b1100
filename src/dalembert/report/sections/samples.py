"""All samples of some series, for download."""

from collections.abc import Mapping, Sequence

import numpy as np

from dalembert.forward import Coordinate
from dalembert.report.quantities import labelled
from dalembert.report.section import Download
from dalembert.report.table import Table

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
