"""Residuals channel by channel, as a table of results."""

from typing import Protocol

import numpy as np

from dalembert.data import Measurements
from dalembert.quantities import unit
from dalembert.tables import Table, cells, labelled, noted

COLUMNS = ("channel", "rms residual", "largest residual", "largest at", "deviation of the data", "unit")


class Compared(Protocol):
    """Data and the residuals (samples, channels) of a response."""

    @property
    def data(self) -> Measurements: ...
    @property
    def residuals(self) -> np.ndarray: ...


def residual_columns(compared: Compared) -> list[list]:
    """Return the entries of ``COLUMNS``, one for each channel."""
    data = compared.data
    residuals = np.where(np.isfinite(compared.residuals), compared.residuals, 0.0)  # 0 where a value is missing
    counts, largest = np.count_nonzero(np.isfinite(data.values), axis=0), np.abs(residuals)
    return [
        list(data.channels),
        cells([np.sqrt(np.sum(column**2) / count) for column, count in zip(residuals.T, counts, strict=True)], 4),
        cells(largest.max(axis=0), 4),
        list(data.coordinate.values[largest.argmax(axis=0)]),
        list(np.full(len(data.channels), np.nan) if data.deviations is None else data.deviations),
        [unit(channel) for channel in data.channels],
    ]


def residual_table(compared: Compared) -> Table:
    """Return how large the residuals of one record are."""
    along = compared.data.coordinate
    at = labelled(f"largest at {along.name}", along.unit)
    names = [at if name == "largest at" else name for name in COLUMNS]
    return noted(Table.of("residuals", "Residuals", dict(zip(names, residual_columns(compared), strict=True))))
