"""Columns of numbers from a text file with a header line."""

import csv
import math
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from dalembert.data.columns import Columns
from dalembert.data.opening import absent
from dalembert.errors import DataError, unknown

GAPS = ("", "na")
"""What stands, beside ``nan`` in any spelling, in the cell of a value that was not measured."""


def csv_columns(path: Path, time: str, names: Iterable[str] | None, missing: str, separator: str) -> Columns:
    """Times and columns by their names in the file.

    Parameters
    ----------
    path : Path
    time : str
        Column of the times, which must grow.
    names : iterable of str, optional
        Columns wanted; all but the times if not given.
    missing : {"refuse", "leave-out"}
        Whether an empty cell, NA or NaN is a defect, or becomes a NaN.
    separator : str

    Raises
    ------
    DataError
        Naming file, line and column: no such file, empty file, missing column (with the nearest names) or one that is
        there twice, a cell that is empty, NaN or not a number, a line too short or too long, a time that does not grow.
    """
    header, rows = _read(path, separator)
    wanted = [name for name in header if name != time] if names is None else list(dict.fromkeys(names))
    for column in (time, *wanted):
        if column not in header:
            raise DataError(unknown("column", column, header, str(path)))
        if header.count(column) > 1:
            raise DataError(
                f"{path}: {header.count(column)} columns are called {column!r}; expected one; rename the others"
            )

    def number(line: int, place: int, cell: str) -> float:
        gap = missing == "leave-out" and header[place] != time and cell.lower() in (*GAPS, "nan")
        return math.nan if gap else _number(path, line, header[place], cell)

    places = [header.index(column) for column in (time, *wanted)]
    table = np.array([[number(line, place, cells[place]) for place in places] for line, cells in rows])
    for (line, _), before, now in zip(rows[1:], table[:-1, 0], table[1:, 0], strict=True):
        if now <= before:
            raise DataError(
                f"{path}, line {line}, column {time!r}: {now:.10g} comes after {before:.10g}; expected growing values; "
                "sort the lines or remove the repeated one"
            )
    return Columns(path, time, table[:, 0], dict(zip(wanted, table[:, 1:].T, strict=True)))


def _read(path: Path, separator: str) -> tuple[list[str], list[tuple[int, list[str]]]]:
    """Header, and the other lines with their numbers in the file; blank lines are passed over."""
    try:
        with path.open(newline="", encoding="utf-8-sig") as file:
            reader = csv.reader(file, delimiter=separator)
            lines = [
                (reader.line_num, [cell.strip() for cell in cells]) for cells in reader if any(map(str.strip, cells))
            ]
    except FileNotFoundError:
        raise absent(path) from None
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise DataError(f"{path}: cannot be read as text with columns ({error})") from error
    if len(lines) < 2:
        what = "only a header line" if lines else "nothing"
        raise DataError(f"{path}: the file holds {what}; expected a line of column names and then lines of numbers")
    header = lines[0][1]
    for line, cells in lines[1:]:
        if len(cells) != len(header):
            raise DataError(f"{path}, line {line}: {len(cells)} cells; expected {len(header)}, as the header has")
    return header, lines[1:]


def _number(path: Path, line: int, column: str, cell: str) -> float:
    where = f"{path}, line {line}, column {column!r}"
    if not cell:
        raise DataError(f"{where}: the cell is empty; expected a number; fill it or remove the line")
    try:
        value = float(cell)
    except ValueError:
        raise DataError(f"{where}: {cell!r} is not a number") from None
    if not math.isfinite(value):
        raise DataError(f"{where}: {cell}; expected a finite number; remove the line or the column")
    return value
