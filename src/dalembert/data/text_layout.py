"""The layout of a text file with columns: separator, decimal mark, header, units, and where the numbers begin."""

import csv
import math
import re
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import product

from dalembert.data.clock_times import is_clock
from dalembert.unit_table import readings

AUTO = "auto"
SEPARATORS = {",": "commas", ";": "semicolons", "\t": "tabs", " ": "blanks"}
COMMENTS = ("%", "#")
GAPS = (
    *("", "na", "nan", "n/a", "#n/a", "-", "--", "---", "?", "null", "none", "nil", "missing", "-nan", "nan(ind)"),
    *("-nan(ind)", "1.#qnan", "-1.#ind", "#value!", "#div/0!", "#num!", "no data"),
)
"""What a cell without a value holds, in any case of letters."""
DESCRIBING = (
    "abs absolute actual calculated command demand desired filtered front left lower max mean measured raw rear ref "
    "reference rel relative right rms set setpoint simulated smoothed std target top upper"
)
"""Words in brackets behind a name that are no units."""

Line = tuple[int, str]
Row = tuple[int, list[str]]
_SAMPLE = 50  # lines that are looked at
_FOLLOW = 3  # lines of numbers that begin them


@dataclass(frozen=True)
class Layout:
    """What the lines of a text file are. ``separator``: a blank stands for any number of blanks and tabs; ``header``:
    names of the columns, their numbers from 1 where the file has none; ``units``: one a column, ``""`` where none is
    named; ``rows``: (line number, cells); ``named``, ``measured``: line of the names, and of the units, None where
    there is none.
    """

    separator: str
    decimal: str
    header: tuple[str, ...]
    units: tuple[str, ...]
    rows: list[Row]
    named: int | None
    measured: int | None

    def __str__(self) -> str:
        marks = f"cells separated by {SEPARATORS.get(self.separator, repr(self.separator))}"
        comma = ", decimal commas" if self.decimal == "," else ""
        names = "no header" if self.named is None else f"names in line {self.named}"
        units = ", units behind names" if any(self.units) else ""
        units = units if self.measured is None else f", units in line {self.measured}"
        return f"{marks}{comma}, {names}{units}"


def layout(lines: Sequence[Line], time: str | int | None, separator: str = AUTO, decimal: str = AUTO) -> Layout:
    """Return the layout of ``lines`` (line number, text) that are not blank.

    All pairs of a separator and a decimal mark are tried on the lines in the middle. The pair is taken that leaves the
    fewest cells that are not numbers; of several, the one that gives the most columns. There is always a result: it has
    no rows if no line has numbers.

    ``time``: name of the column of times, or its number from 1; a first line with a cell of this name is a header, even
    if all its cells are numbers. ``separator``, ``decimal``: ``"auto"``, or the mark; a blank separator stands for any
    number of blanks and tabs.

    >>> str(layout([(1, "% rig 7"), (2, "time;angle"), (3, "s;deg"), (4, "0,0;1,5"), (5, "0,1;1,4")], "time"))
    'cells separated by semicolons, decimal commas, names in line 2, units in line 3'
    """
    plain = [line for line in lines if not line[1].lstrip().startswith(COMMENTS)]
    sample = [text for _, text in plain[len(plain) // 2 :]][:_SAMPLE]
    separators = tuple(SEPARATORS) if separator == AUTO else (separator,)
    marks = [(cut, mark) for cut, mark in product(separators, ".," if decimal == AUTO else decimal) if cut != mark] or [
        (separators[0], ".")
    ]
    first = [text for _, text in plain[:_SAMPLE]]
    cut, mark = max(marks, key=lambda pair: _suits(sample, first, *pair))
    rows = split(plain, cut)
    counts = Counter(len(cells) for _, cells in rows[len(rows) // 2 :][:_SAMPLE])
    width = counts.most_common(1)[0][0] if counts else 0
    begin = _first_numbers(rows, width, mark)
    if rows and begin == 0 and isinstance(time, str) and time in rows[0][1]:
        begin = 1
    before = rows[begin][0] if begin < len(rows) else math.inf
    names, units = _head(_above(lines, before, cut, width, time), width, time)
    header = tuple(names[1]) if names else tuple(map(str, range(1, width + 1)))
    data = rows[begin:]
    header, data = _without_empty_end(header, data, named=names is not None)
    width = len(data[0][1]) if data else len(header)
    header += tuple(str(number) for number in range(len(header) + 1, width + 1))
    symbols = [_bracketed(name) for name in header] if units is None else [_unit(cell) for cell in units[1]]
    symbols = (symbols + [""] * len(header))[: len(header)]
    return Layout(cut, mark, header, tuple(symbols), data, names and names[0], units and units[0])


def gaps_of(absent: Iterable[str]) -> frozenset[str]:
    """Return what cells without a value hold, with further words, in lower case."""
    return frozenset([*GAPS, *(word.lower() for word in absent)])


def is_number(cell: str, decimal: str = ".") -> bool:
    """Whether a cell holds a number."""
    try:
        value(cell, decimal)
    except ValueError:
        return False
    return True


def value(cell: str, decimal: str) -> float:
    """Number in a cell; a point beside decimal commas may divide thousands, and is refused, as is Python's ``1_0``."""
    if (decimal == "," and "." in cell) or not is_plain(cell):
        raise ValueError
    return float(cell.replace(decimal, "."))


def is_plain(cell: str) -> bool:
    """Return whether a text has only characters of numbers in data, not those that Python alone allows.

    >>> is_plain("1e-3"), is_plain("1_0"), is_plain("１")
    (True, False, False)
    """
    return cell.isascii() and "_" not in cell


def split(lines: Iterable[Line], separator: str) -> list[Row]:
    lines = list(lines)
    if separator == " ":
        return [(number, text.split()) for number, text in lines]
    cells = csv.reader((text for _, text in lines), delimiter=separator)
    return [(number, [cell.strip() for cell in row]) for (number, _), row in zip(lines, cells, strict=False)]


def _suits(sample: Sequence[str], first: Sequence[str], separator: str, decimal: str) -> tuple[float, int]:
    """Share of the cells that are numbers or empty times that of the lines of equal length; the number of columns."""
    rows = [cells for _, cells in split(enumerate(sample), separator)]
    cells = [cell for row in rows for cell in row]
    texts = [cell for cell in cells if not is_number(cell, decimal) and cell.lower() not in GAPS]
    good = len(cells) - len(texts) + sum(map(is_clock, texts))
    width = Counter(map(len, rows)).most_common(1)[0][0] if rows else 0
    even = sum(len(cells) == width for _, cells in split(enumerate(first), separator)) / max(1, len(first))
    return even * good / max(1, len(cells)), width


def _first_numbers(rows: Sequence[Row], width: int, decimal: str) -> int:
    """Number of the first row of numbers: one that others follow, or else the first of all."""
    sample = [cells for _, cells in rows[len(rows) // 2 :][:_SAMPLE] if len(cells) == width]
    numeric = [
        column
        for column in range(width)
        if 2 * sum(is_number(cells[column], decimal) for cells in sample) >= max(1, len(sample))
    ]
    first = len(rows)
    for place, (_, cells) in enumerate(rows):
        if _has_numbers(cells, numeric, width, decimal):
            first = min(first, place)
            following = (cells for _, cells in rows[place + 1 : place + _FOLLOW])
            if all(_has_numbers(cells, numeric, width, decimal) for cells in following):
                return place
    return first


def _has_numbers(cells: Sequence[str], numeric: Sequence[int], width: int, decimal: str) -> bool:
    """Whether at least half of the cells in columns of numbers are some; of a line of another length all of them."""
    filled = [cells[column] for column in numeric if column < len(cells) and cells[column].lower() not in GAPS]
    numbers = sum(is_number(cell, decimal) for cell in filled)
    return bool(filled) and (2 * numbers >= len(filled) if len(cells) == width else numbers == len(filled))


def _above(lines: Sequence[Line], before: float, separator: str, width: int, time: str | int | None) -> list[Row]:
    """The lines above the numbers, comments among them without their marks, where they may name columns or units.

    A comment below the line that names the times is text, unless it holds units.
    """
    rows, named = [], False
    for number, text in lines:
        if number >= before:
            break
        marked = text.lstrip().startswith(COMMENTS)
        plain = text.lstrip().lstrip("%#").strip() if marked else text
        ((_, cells),) = split([(number, plain)], separator)
        cells = plain.split() if marked and len(cells) != width else cells
        cells = _names_with_blanks(plain, width) or cells if separator == " " and len(cells) != width else cells
        wide = len(cells) == width and not all(map(is_number, cells))
        if not marked or (wide and (not named or time in cells or _are_units(cells, width))):
            rows.append((number, cells))
            named = named or time in cells
    return rows


def _names_with_blanks(text: str, width: int) -> list[str] | None:
    """Names above columns that blanks separate, if they have blanks themselves: before brackets, or single ones.

    >>> _names_with_blanks("t [ms] angle [deg]", 2), _names_with_blanks("Time (ms)   Rod angle", 2)
    (['t [ms]', 'angle [deg]'], ['Time (ms)', 'Rod angle'])
    """
    splits = re.findall(r"\S+(?:\s+[\[(][^\])]*[\])])?", text), re.split(r"\t|\s{2,}", text.strip())
    return next((names for names in splits if len(names) == width), None)


def _head(above: Sequence[Row], width: int, time: str | int | None) -> tuple[Row | None, Row | None]:
    """The row of names and the row of units among those above the numbers."""
    if len(above) > 1 and _are_units(above[-1][1], width) and (time not in above[-1][1] or time in above[-2][1]):
        return above[-2], above[-1]
    return (above[-1] if above else None), None


def _are_units(cells: Sequence[str], width: int) -> bool:
    """Whether cells are units: two of three at least are known, so that an unknown one is noticed as one."""
    named = [cell for cell in map(_unit, cells) if cell]
    return len(cells) == width and 3 * sum(map(_is_unit, named)) >= 2 * len(named)


def _without_empty_end(header: tuple[str, ...], rows: list[Row], *, named: bool) -> tuple[tuple[str, ...], list[Row]]:
    """Without a last column that is empty throughout, as a separator at the end of each line leaves one."""
    width = len(header) if named else max((len(cells) for _, cells in rows), default=0)
    ended = all(cells and not cells[-1] for _, cells in rows) and len({len(cells) for _, cells in rows}) == 1
    if not rows or not ended or len(rows[0][1]) < 2 or (named and width == len(rows[0][1]) and header[-1]):
        return header, rows
    return header[: len(rows[0][1]) - 1], [(number, cells[:-1]) for number, cells in rows]


def _unit(cell: str) -> str:
    inner = cell.strip()
    for left, right in ("[]", "()"):
        inner = inner[1:-1].strip() if inner.startswith(left) and inner.endswith(right) else inner
    return "" if inner.lower() in ("-", "1", "none", "n/a", "unitless", "dimensionless") else inner


def _is_unit(cell: str) -> bool:
    return bool(readings(_unit(cell)))


def _bracketed(name: str) -> str:
    """Unit in brackets at the end of a name, also an unknown word; not a number, nor a letter that is no unit.

    >>> [_bracketed(name) for name in ("angle [deg]", "Time (ms)", "x (furlong)", "force (1)", "force (X)", "x")]
    ['deg', 'ms', 'furlong', '', '', '']
    """
    for left, right in ("[]", "()"):
        if name.endswith(right) and left in name:
            unit = _unit(name[_opening(name, left, right) :])
            described = len(unit) < 2 or is_number(unit) or unit.lower() in DESCRIBING.split()
            return unit if _is_unit(unit) or not described else ""
    return ""


def _opening(name: str, left: str, right: str) -> int:
    """Place of the bracket that the last one closes.

    >>> _opening("drag (N*m/(rad/s))", "(", ")")
    5
    """
    depth = 0
    for place in range(len(name) - 1, -1, -1):
        depth += (name[place] == right) - (name[place] == left)
        if depth == 0:
            return place
    return len(name) - 1
