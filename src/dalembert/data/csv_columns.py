"""Columns of numbers from a text file with a header line."""

import csv
import io
import json
import math
import re
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from dalembert.data.columns import Columns
from dalembert.data.opening import absent
from dalembert.errors import DataError, no_text, unknown

GAPS = ("", "na")
"""What stands, beside ``nan`` in any spelling, in the cell of a value that was not measured."""

_SEPARATORS = {";": "semicolons", "\t": "tabs", ",": "commas"}


def csv_columns(
    path: Path, time: str, names: Iterable[str] | None, missing: str, separator: str, decimal: str
) -> Columns:
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
    decimal : {".", ","}
        What stands before the decimals of a number.

    Raises
    ------
    DataError
        Naming file, line and column: no such file, empty file, no UTF-8 text, another separator, no header line,
        missing column (with the nearest names) or one that is there twice, a line of units, a cell that is empty, NaN
        or not a number, a line too short or too long, a time that does not grow.
    """
    _refuse_marks(path, separator, decimal)
    header, rows = _read(path, time, separator)
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
        return math.nan if gap else _number(path, line, header[place], cell, decimal)

    places = [header.index(column) for column in (time, *wanted)]
    table = np.array([[number(line, place, cells[place]) for place in places] for line, cells in rows])
    for (line, _), before, now in zip(rows[1:], table[:-1, 0], table[1:, 0], strict=True):
        if now <= before:
            raise DataError(
                f"{path}, line {line}, column {time!r}: {now:.10g} comes after {before:.10g}; expected growing values; "
                "sort the lines or remove the repeated one"
            )
    return Columns(path, time, table[:, 0], dict(zip(wanted, table[:, 1:].T, strict=True)))


def _refuse_marks(path: Path, separator: str, decimal: str) -> None:
    if len(separator) != 1 or separator in '\r\n"':
        raise DataError(f"{path}: separator is {separator!r}; expected one character, such as ';'")
    if decimal not in (".", ","):
        raise DataError(f"{path}: decimal is {decimal!r}; expected '.' or ','")
    if decimal == separator:
        raise DataError(
            f"{path}: {decimal!r} stands between the cells and before the decimals; give separator the character that "
            "stands between the cells, such as ';'"
        )


def _read(path: Path, time: str, separator: str) -> tuple[list[str], list[tuple[int, list[str]]]]:
    """Header, and the other lines with their numbers in the file; blank lines are passed over."""
    try:
        text = path.read_bytes().decode("utf-8-sig")
        reader = csv.reader(io.StringIO(text, newline=""), delimiter=separator)
        lines = [(reader.line_num, [cell.strip() for cell in cells]) for cells in reader if any(map(str.strip, cells))]
    except FileNotFoundError:
        raise absent(path) from None
    except UnicodeDecodeError as error:
        raise DataError(no_text(path, error)) from None
    except (OSError, csv.Error) as error:
        raise DataError(f"{path}: cannot be read as text with columns ({error})") from error
    if not lines:
        raise DataError(f"{path}: the file holds nothing; expected a line of column names and then lines of numbers")
    (first, header), rows = lines[0], lines[1:]
    if time not in header:
        _refuse_header(f"{path}, line {first}", header, separator, rows[0][1] if rows else [])
    if not rows:
        raise DataError(
            f"{path}: the file holds only a header line; expected a line of column names and then lines of numbers"
        )
    for line, cells in rows:
        if len(cells) != len(header):
            raise DataError(f"{path}, line {line}: {len(cells)} cells; expected {len(header)}, as the header has")
    _refuse_units(f"{path}, line {rows[0][0]}", header, rows[0][1])
    return header, rows


def _refuse_header(where: str, header: Sequence[str], separator: str, below: Sequence[str]) -> None:
    """Refuse a first line without the column of the times that is no header, or that another separator divides."""
    line = separator.join(header)
    if all(_is_number(part) for part in re.split("[;,\t]", line)):
        raise DataError(
            f"{where}: the first line holds numbers only ({line}); expected the names of the columns; "
            "put a line with them above it"
        )
    for mark, name in _SEPARATORS.items():
        if len(header) == 1 and mark in line:
            # cells that were divided at commas, below names that were not, had decimal commas
            more = ' and decimal = ","' if mark != separator == "," and len(below) > 1 else ""
            raise DataError(
                f"{where}: {line!r} is read as the name of one column; the cells seem to be separated by {name}; "
                f"give separator = {json.dumps(mark)}{more}"
            )


def _refuse_units(where: str, header: Sequence[str], cells: Sequence[str]) -> None:
    """Refuse a line of words below the names."""
    words = {name: cell for name, cell in zip(header, cells, strict=True) if cell and cell.lower() not in GAPS}
    if len(words) > 1 and not any(_is_number(cell.replace(",", ".")) for cell in words.values()):
        told = ", ".join(f"{name!r} is {cell!r}" for name, cell in words.items())
        raise DataError(
            f"{where}: no cell holds a number ({told}); expected numbers below the names; if these are the units of "
            "the columns, delete the line and give them by units"
        )


def _value(cell: str, decimal: str) -> float:
    """Number in a cell; a point beside decimal commas may divide thousands, and is refused."""
    return float("" if decimal == "," and "." in cell else cell.replace(decimal, "."))


def _is_number(cell: str, decimal: str = ".") -> bool:
    try:
        _value(cell, decimal)
    except ValueError:
        return False
    return True


def _number(path: Path, line: int, column: str, cell: str, decimal: str) -> float:
    where = f"{path}, line {line}, column {column!r}"
    if not cell:
        raise DataError(f"{where}: the cell is empty; expected a number; fill it or remove the line")
    try:
        value = _value(cell, decimal)
    except ValueError:
        comma = decimal == "." and _is_number(cell, ",")
        hint = '; for numbers with decimal commas give decimal = ","' if comma else ""
        raise DataError(f"{where}: {cell!r} is not a number{hint}") from None
    if not math.isfinite(value):
        raise DataError(f"{where}: {cell}; expected a finite number; remove the line or the column")
    return value
