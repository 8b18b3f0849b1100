"""Columns of a Parquet file."""

from collections.abc import Iterable
from pathlib import Path

import numpy as np

from dalembert.data.columns import Columns, chosen, of_numbers
from dalembert.data.format import Format, Request
from dalembert.data.opening import library, reading


class Parquet(Format):
    """Parquet."""

    name = "parquet"
    suffixes = (".parquet", ".pq")

    def columns(self, path: Path, request: Request) -> Columns:
        return parquet_columns(path, request.along, request.labels, request.missing)

    def all_columns(self, path: Path) -> dict[str, tuple[np.ndarray, str]]:
        return {name: (array, "") for name, array in of_numbers(_columns(path)).items()}


def parquet_columns(path: Path, time: str | None, names: Iterable[str] | None, missing: str) -> Columns:
    """Times and columns; a null is a NaN."""
    return Columns(path, time or "sample", *chosen(path, _columns(path), time, names, missing))


def _columns(path: Path) -> dict[str, np.ndarray]:
    with reading(path, "Parquet"):
        parquet = library("pyarrow.parquet", path, "Parquet files")
        table = parquet.read_table(path)
        return {name: np.asarray(table.column(place).to_numpy()) for place, name in enumerate(table.column_names)}
