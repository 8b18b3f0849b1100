"""The formats that data are read from, each with a function that gives columns."""

from collections.abc import Collection, Iterable
from pathlib import Path

from dalembert.data.columns import Columns, Trial
from dalembert.data.csv_columns import csv_columns, csv_labels
from dalembert.data.json_file import json_columns, json_labels
from dalembert.data.mat_file import mat_columns
from dalembert.data.netcdf_file import netcdf_columns
from dalembert.data.parquet_file import parquet_columns
from dalembert.data.text_layout import AUTO
from dalembert.data.uff_file import uff_columns
from dalembert.errors import DataError, unknown

SUFFIXES = {
    "csv": (".csv", ".txt", ".dat", ".tsv", ".asc", ".log"),
    "json": (".json",),
    "parquet": (".parquet", ".pq"),
    "mat": (".mat",),
    "uff": (".uff", ".unv", ".uf", ".bunv"),
    "netcdf": (".nc", ".nc4", ".cdf"),
}
"""Suffixes of the files of each format."""

_COMPRESSED = ("csv", "json")  # may end in .gz


def columns_in(
    path: Path,
    time: str | int,
    names: Iterable[str | int] | None,
    *,
    missing: str = "refuse",
    separator: str = AUTO,
    decimal: str = AUTO,
    units: Collection[str] = (),
    format: str | None = None,  # noqa: A002
    trial: Trial | None = None,
) -> Columns:
    """Columns of a file by their names in it, as the format says or else the suffix.

    ``units`` are the columns of which the unit is known whatever the file says of it.

    Raises
    ------
    DataError
        For a format or a suffix that is unknown, and whatever is wrong with the file.
    """
    kind = format_of(path) if format is None else format
    if kind == "csv":
        return csv_columns(path, time, names, missing, separator, decimal, trial)
    if kind == "json":
        return json_columns(path, time, names, missing, trial)
    time, names = str(time), None if names is None else [str(name) for name in names]
    if trial is not None:
        raise _no_trials(path)
    if kind == "uff":
        return uff_columns(path, names, missing, units)
    readers = {"parquet": parquet_columns, "mat": mat_columns, "netcdf": netcdf_columns}
    if kind not in readers:
        raise DataError(unknown("format", kind, SUFFIXES, str(path)))
    return readers[kind](path, time, names, missing)


def trial_labels(
    path: Path,
    column: str | int,
    *,
    separator: str = AUTO,
    decimal: str = AUTO,
    format: str | None = None,  # noqa: A002
) -> list[str]:
    """Labels of the trials that a column of a text or JSON file numbers, in the order in which they begin.

    Raises
    ------
    DataError
    """
    kind = format_of(path) if format is None else format
    if kind not in _COMPRESSED:
        raise _no_trials(path)
    labels = csv_labels(path, column, separator, decimal) if kind == "csv" else json_labels(path, column)
    return list(dict.fromkeys(labels))


def _no_trials(path: Path) -> DataError:
    return DataError(f"{path}: trials are read from text and JSON files only; write one file a trial")


def format_of(path: Path) -> str:
    """Name of the format that a suffix stands for.

    >>> format_of(Path("motion.MAT"))
    'mat'
    """
    compressed = path.suffix.lower() == ".gz"
    suffix = Path(path.stem).suffix if compressed else path.suffix
    for name, suffixes in SUFFIXES.items():
        if suffix.lower() in suffixes and (name in _COMPRESSED or not compressed):
            return name
    if compressed:
        raise DataError(f"{path}: only text and JSON are read from .gz files; decompress the file")
    known = ", ".join(suffix for suffixes in SUFFIXES.values() for suffix in suffixes)
    raise DataError(
        f"{path}: the suffix {path.suffix!r} stands for no format; expected one of {known}; rename the file, or say "
        f"which format it has: {', '.join(SUFFIXES)}"
    )
