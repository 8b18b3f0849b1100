"""What a data file is taken to hold, before its columns are chosen; nothing in it is refused that can be shown."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from dalembert.data.clock_times import clock_seconds, is_clock
from dalembert.data.known_formats import format_of, known_formats
from dalembert.data.lines_format import LinesFormat
from dalembert.data.text_layout import AUTO, Layout, Line, Row, gaps_of, is_number, layout, split, value
from dalembert.data.text_numbers import BLOCK, HEAD, lines_of_numbers, quick_numbers
from dalembert.errors import DataError

SHOWN = 5
"""First rows that are shown."""


@dataclass(frozen=True, eq=False)
class PreviewColumn:
    """A column of a file: its ``values`` (samples,) as they are in the file, NaN where a cell has no number. ``key``:
    what `[data]` calls it, its name, or its number from 1 where the file has no name that no other column has;
    ``unit``: named by the file, ``""`` if it names none; ``missing``: number of cells without a value; ``wrong``: line,
    or sample, and content of the first cell that is neither a number nor empty.
    """

    key: str | int
    unit: str
    values: np.ndarray
    missing: int = 0
    wrong: tuple[int, str] | None = None


@dataclass(frozen=True, eq=False)
class Preview:
    """What a file is taken to hold. ``first``: cells of the first rows; ``layout``: what a text file was taken to be,
    in words; ``separator``, ``decimal``: marks of a text file, as detected or given, ``""`` of another file;
    ``uneven``: line and number of cells of the first line of a text file that has another number of cells.
    """

    path: Path
    format: str
    columns: tuple[PreviewColumn, ...]
    first: tuple[tuple[str, ...], ...]
    layout: str = ""
    separator: str = ""
    decimal: str = ""
    uneven: tuple[int, int] | None = None

    @property
    def samples(self) -> int:
        """Number of rows."""
        return max((len(column.values) for column in self.columns), default=0)

    def column(self, key: str | int) -> PreviewColumn | None:
        """The column of a name or number; None if there is none."""
        return next((column for column in self.columns if column.key == key), None)


def preview(path: Path, separator: str = AUTO, decimal: str = AUTO, absent: Sequence[str] = ()) -> Preview:
    """Return what a file is taken to hold. ``separator``, ``decimal``: marks of a text file, ``"auto"`` to detect them
    from its lines; ``absent``: further words for a cell without a value in a text file.
    """
    name = format_of(path)
    form = known_formats()[name]()
    if isinstance(form, LinesFormat):
        return _text(path, name, form.lines(path), separator, decimal, gaps_of(absent))
    columns = [PreviewColumn(key, unit, *_real(array)) for key, (array, unit) in form.all_columns(path).items()]
    longest = Counter(len(column.values) for column in columns).most_common(1)
    columns = [column for column in columns if len(column.values) == longest[0][0]]
    if not columns:
        raise DataError(f"{path}: the file has no column of numbers; expected one of times and one of each channel")
    first = zip(*(map(str, column.values[:SHOWN].tolist()) for column in columns), strict=True)
    return Preview(path, name, tuple(columns), tuple(first))


def without(preview: Preview, numbers: Sequence[float], time: str | int | None) -> Preview:
    """Return the same without the numbers that stand for missing values in the columns that are not the times."""
    if not numbers:
        return preview
    columns = (column if column.key == time else _without(column, numbers) for column in preview.columns)
    return replace(preview, columns=tuple(columns))


def _without(column: PreviewColumn, numbers: Sequence[float]) -> PreviewColumn:
    absent = np.isin(column.values, numbers)
    values = np.where(absent, np.nan, column.values)
    return replace(column, values=values, missing=column.missing + int(np.sum(absent)))


def _text(path: Path, name: str, lines: Sequence[Line], separator: str, decimal: str, gaps: frozenset[str]) -> Preview:
    text_layout = layout(lines[:HEAD], 1, separator, decimal)
    if not text_layout.rows:
        raise DataError(f"{path}: the file has no line of numbers; expected column names and then lines of numbers")
    rest, width = lines_of_numbers(lines, text_layout), len(text_layout.header)
    blocks = [_block(rest[place : place + BLOCK], text_layout, width, gaps) for place in range(0, len(rest), BLOCK)]
    keys = [
        name if text_layout.named is not None and name and text_layout.header.count(name) == 1 else place
        for place, name in enumerate(text_layout.header, 1)
    ]
    columns = tuple(
        _clock(PreviewColumn(key, unit, *_joined([block.columns[place] for block in blocks])), rest, text_layout, place)
        for place, (key, unit) in enumerate(zip(keys, text_layout.units, strict=True))
    )
    uneven = next((block.uneven for block in blocks if block.uneven), None)
    first = tuple(tuple(cells[:width]) for _, cells in text_layout.rows[:SHOWN])
    return Preview(path, name, columns, first, str(text_layout), text_layout.separator, text_layout.decimal, uneven)


def _clock(column: PreviewColumn, lines: Sequence[Line], text_layout: Layout, place: int) -> PreviewColumn:
    """A column of times of day or dates as seconds since the first; any other as it is."""
    if column.wrong is None or not is_clock(column.wrong[1]):
        return column
    rows = [cells for _, cells in split(lines, text_layout.separator)]
    seconds = clock_seconds([cells[place] for cells in rows]) if all(len(cells) > place for cells in rows) else None
    return column if seconds is None else PreviewColumn(column.key, "s", seconds)


_Numbers = tuple[np.ndarray, int, tuple[int, str] | None]


@dataclass(frozen=True, eq=False)
class _Block:
    """Columns of some lines, and the first line that has another number of cells, and that number."""

    columns: list[_Numbers]
    uneven: tuple[int, int] | None = None


def _block(lines: Sequence[Line], text_layout: Layout, width: int, gaps: frozenset[str]) -> _Block:
    table = quick_numbers(lines, text_layout)
    if table is not None:
        return _Block([(column, 0, None) for column in np.ascontiguousarray(table.T)])
    rows = split(lines, text_layout.separator)
    padded = [(line, cells + [""] * (width - len(cells))) for line, cells in rows]
    uneven = next(((line, len(cells)) for line, cells in rows if len(cells) != width and any(cells[width:])), None)
    uneven = uneven or next(((line, len(cells)) for line, cells in rows if len(cells) < width), None)
    return _Block([_numbers(padded, place, text_layout.decimal, gaps) for place in range(width)], uneven)


def _numbers(rows: Sequence[Row], place: int, decimal: str, gaps: frozenset[str]) -> _Numbers:
    values, missing, wrong = np.full(len(rows), np.nan), 0, None
    for sample, (line, cells) in enumerate(rows):
        cell = cells[place]
        if cell.lower() in gaps:
            missing += 1
        elif is_number(cell, decimal) and np.isfinite(number := value(cell, decimal)):
            values[sample] = number
        else:
            wrong = wrong or (line, cell)
    return values, missing, wrong


def _joined(parts: Sequence[_Numbers]) -> _Numbers:
    values, missing, wrong = zip(*parts, strict=True)
    return np.concatenate(values), sum(missing), next(filter(None, wrong), None)


def _real(array: np.ndarray) -> _Numbers:
    values = np.asarray(array, dtype=float)
    infinite = np.flatnonzero(np.isinf(values))
    wrong = (int(infinite[0]), str(values[infinite[0]])) if len(infinite) else None
    return np.where(np.isinf(values), np.nan, values), int(np.isnan(values).sum()), wrong
