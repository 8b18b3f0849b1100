"""Columns of the lines of a text file, or of what can be written as one."""

import math
from abc import abstractmethod
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from dalembert.data.clock_times import clock_seconds, is_clock
from dalembert.data.columns import Columns, Trial, of_trial, times_as_channel, trial_label
from dalembert.data.format import Format, Request
from dalembert.data.text_layout import AUTO, GAPS, Layout, Line, Row, gaps_of, is_number, is_plain, layout, value
from dalembert.data.text_numbers import HEAD, lines_of_numbers, quick_table
from dalembert.data.unit_suffixes import sure_suffix
from dalembert.errors import DataError, unknown


class LinesFormat(Format):
    """A format whose files are lines of cells: its subclasses give these lines."""

    trials = True

    @abstractmethod
    def lines(self, path: Path) -> list[Line]:
        """Return the lines that are not blank, with their numbers."""

    def columns(self, path: Path, request: Request) -> Columns:
        request_here = request
        marks = request_here.separator, request_here.decimal
        return columns_of(
            path,
            self.lines(path),
            request_here.time,
            request_here.names,
            request_here.missing,
            *marks,
            request_here.trial,
            request_here.absent,
        )

    def trial_labels(self, path: Path, column: str | int, separator: str, decimal: str) -> list[str]:
        return labels_of(path, self.lines(path), column, separator, decimal)


def columns_of(
    path: Path,
    lines: Sequence[Line],
    time: str | int | None,
    names: Iterable[str | int] | None,
    missing: str,
    separator: str = AUTO,
    decimal: str = AUTO,
    trial: Trial | None = None,
    absent: Iterable[str] = (),
) -> Columns:
    """Return times and columns by their names in the file, or by their numbers from 1.

    ``lines``: (line number, text). ``time``: column of the times, which must grow or be times of day; the first of a
    file without a header if it is ``"t"``. None numbers the samples. ``names``: columns wanted; all but the times if
    None. ``missing``: ``"refuse"`` an empty cell, NA or NaN, or ``"leave-out"``, which makes it a NaN. ``separator``:
    ``"auto"``, or the character; a blank stands for any number of blanks and tabs. ``decimal``: ``"auto"``, or the mark
    before the decimals. ``trial``: the one trial whose lines are read. ``absent``: further words for a cell without a
    value.
    """
    _refuse_marks(path, separator, decimal)
    if not lines:
        raise DataError(f"{path}: the file holds nothing; expected a line of column names and then lines of numbers")
    text, rows, numbers = _laid_out(lines, time, separator, decimal, quick=trial is None)
    if (separator, decimal) != (AUTO, AUTO):
        _refuse_wrong_marks(path, lines[:HEAD], time, text)
    _refuse_rows(path, text)
    if trial is not None:
        mask = of_trial(path, _labels(path, text, _places(path, text)(trial.column)), trial)
        text = replace(text, rows=[row for row, belongs in zip(text.rows, mask, strict=True) if belongs])
    if time == "t" and text.named is None:
        time = 1
    first, labels, wanted = _choice(path, text, time, names, trial)
    places: list[int] = list(dict.fromkeys([*([] if first is None else [first]), *wanted]))
    if numbers is None:
        gaps = gaps_of(absent) if missing == "leave-out" else frozenset()
        table = _numbers(path, text, places, gaps, first)
    else:
        table = {k: np.ascontiguousarray(numbers[:, k]) for k in places}
    units = {label: text.units[k] or sure_suffix(text.header[k]) for label, k in zip(labels, wanted, strict=True)}
    columns = dict(zip(labels, (table[k] for k in wanted), strict=True))
    if first is None:
        samples = len(text.rows) if numbers is None else len(numbers)
        return Columns(path, "sample", np.arange(samples, dtype=float), columns, units, layout=str(text))
    _refuse_order(path, rows or text.rows, text.header[first], table[first])
    of_times = text.units[first] or sure_suffix(text.header[first], "s")
    units[str(time)] = "s" if is_clock(text.rows[0][1][first]) else of_times
    return Columns(path, str(time), table[first], columns, units, layout=str(text))


def _choice(
    path: Path, text: Layout, time: str | int | None, names: Iterable[str | int] | None, trial: Trial | None
) -> tuple[int | None, list[str], list[int]]:
    """The place of the times, the labels of the other columns that are read, and their places."""
    place = _places(path, text)
    first = None if time is None else place(time)
    if names is None:
        left_out = (first, None if trial is None else place(trial.column))
        names = [header for number, header in enumerate(text.header) if number not in left_out]
    else:
        names = list(names)
    labels, wanted = [str(name) for name in names], [place(name) for name in names]
    _refuse_twice(path, labels, wanted, first)
    return first, labels, wanted


def _laid_out(
    lines: Sequence[Line], time: str | int | None, separator: str, decimal: str, *, quick: bool
) -> tuple[Layout, list[Line], np.ndarray | None]:
    """The layout of lines and, of many lines of nothing but numbers, all lines and their numbers."""
    if quick and len(lines) > HEAD:
        text = layout(lines[:HEAD], time, separator, decimal)
        rows = lines_of_numbers(lines, text) if text.rows else []
        numbers = quick_table(rows, text)
        if numbers is not None:
            return text, rows, numbers
    return layout(lines, time, separator, decimal), [], None


def labels_of(
    path: Path, lines: Sequence[Line], column: str | int, separator: str = AUTO, decimal: str = AUTO
) -> list[str]:
    """Label of the trial that each line belongs to, by the column that numbers them."""
    _refuse_marks(path, separator, decimal)
    text = layout(lines, column, separator, decimal)
    _refuse_rows(path, text)
    return _labels(path, text, _places(path, text)(column))


def _refuse_marks(path: Path, separator: str, decimal: str) -> None:
    if separator != AUTO and (len(separator) != 1 or separator in '\r\n"'):
        raise DataError(f"{path}: separator is {separator!r}; expected 'auto', or one character, such as ';'")
    if decimal not in (AUTO, ".", ","):
        raise DataError(f"{path}: decimal is {decimal!r}; expected 'auto', '.' or ','")
    if decimal == separator != AUTO:
        raise DataError(
            f"{path}: {decimal!r} stands between the cells and before the decimals; give separator the character that "
            "stands between the cells, such as ';'"
        )


def _refuse_wrong_marks(path: Path, lines: Sequence[Line], time: str | int | None, text: Layout) -> None:
    """Refuse a separator or decimal mark with which the times are not there, and without which they are."""
    if time is None:
        return
    other = layout(lines, time)
    if time not in text.header and time in other.header:
        raise DataError(
            f"{path}: there is no column {time!r} with the separator or decimal mark that was given; the file seems to "
            f"have {other}; leave separator and decimal out"
        )


def _refuse_rows(path: Path, text: Layout) -> None:
    if not text.rows:
        raise DataError(f"{path}: the file holds no line of numbers; expected column names and then lines of numbers")
    width = len(text.header)
    source = "as most lines have" if text.named is None else "as the header has"
    for line_number, cells in text.rows:
        if len(cells) != width:
            raise DataError(f"{path}, line {line_number}: {len(cells)} cells; expected {width}, {source}")


def _places(path: Path, text: Layout) -> Callable[[str | int], int]:
    header = text.header

    def place(column: str | int) -> int:
        if isinstance(column, int):
            if not 1 <= column <= len(header):
                raise DataError(f"{path}: there is no column {column}; expected a number from 1 to {len(header)}")
            return column - 1
        if column not in header:
            more = "" if text.named else "; the file has no header, and its columns are numbers from 1"
            raise DataError(unknown("column", column, header, str(path)) + more)
        if header.count(column) > 1:
            raise DataError(
                f"{path}: {header.count(column)} columns are called {column!r}; expected one; name the column by its "
                f"number, such as {header.index(column) + 1}"
            )
        return header.index(column)

    return place


def _refuse_twice(path: Path, labels: Sequence[str], wanted: Sequence[int], time: int | None) -> None:
    for label, place in zip(labels, wanted, strict=True):
        same = [
            other
            for other, place_of_other in zip(labels, wanted, strict=True)
            if place_of_other == place and other != label
        ]
        if same:
            raise DataError(f"{path}: {label!r} and {same[0]!r} are one column; expected one channel for a column")
        if place == time:
            raise times_as_channel(path, label)


def _labels(path: Path, text: Layout, place: int) -> list[str]:
    for line, cells in text.rows:
        if cells[place].lower() in GAPS:
            where = f"{path}, line {line}, column {text.header[place]!r}"
            raise DataError(f"{where}: no trial; expected its number or name in each line")
    return [trial_label(cells[place]) for _, cells in text.rows]


def _numbers(
    path: Path, text: Layout, places: Iterable[int], gaps: frozenset[str], time: int | None
) -> dict[int, np.ndarray]:
    """Columns (samples,) by their places; times of day are seconds since the first."""
    table = {}
    for k in places:
        cells = [row[k] for _, row in text.rows]
        if k == time and is_clock(cells[0]) and (clock := clock_seconds(cells)) is not None:
            table[k] = clock
            continue
        try:
            plain = [cell.replace(",", ".") for cell in cells] if text.decimal == "," else cells
            column = np.array(plain, dtype=float)
            quick = bool(np.all(np.isfinite(column))) and all(map(is_plain, cells))
            quick = quick and not (text.decimal == "," and any("." in text_here for text_here in cells))
        except ValueError:
            quick = False
        table[k] = column if quick else _slowly(path, text, k, frozenset() if k == time else gaps)
    return table


def _slowly(path: Path, text: Layout, column: int, gaps: frozenset[str]) -> np.ndarray:
    """A column in which some cell is no finite number; NaN where a cell is one of the gaps."""
    return np.array(
        [
            math.nan if cells[column].lower() in gaps else _number(path, (line, cells), column, text)
            for line, cells in text.rows
        ]
    )


def _number(path: Path, row: Row, column: int, text: Layout) -> float:
    line, cell = row[0], row[1][column]
    where = f"{path}, line {line}, column {text.header[column]!r}"
    if not cell:
        raise DataError(f"{where}: the cell is empty; expected a number; fill it or remove the line")
    try:
        number = value(cell, text.decimal)
    except ValueError:
        comma = text.decimal == "." and is_number(cell, ",")
        hint = '; for numbers with decimal commas give decimal = ","' if comma else ""
        raise DataError(f"{where}: {cell!r} is not a number{hint}") from None
    if not math.isfinite(number):
        raise DataError(f"{where}: {cell}; expected a finite number; remove the line or the column")
    return number


def _refuse_order(path: Path, rows: Sequence[tuple[int, object]], time: str, along: np.ndarray) -> None:
    back: Sequence[int] = np.flatnonzero(np.diff(along) <= 0).tolist()
    if back:
        before, now = along[back[0]], along[back[0] + 1]
        raise DataError(
            f"{path}, line {rows[back[0] + 1][0]}, column {time!r}: {now:.10g} comes after "
            f"{before:.10g}; expected growing values; sort the lines or remove the repeated one"
        )
