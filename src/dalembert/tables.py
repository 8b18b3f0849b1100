"""Numbers, quantities and tables of results as people read them; full numbers in the CSV that can be downloaded."""

import base64
import csv
import io
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import ClassVar

import numpy as np

from dalembert.intervals import Box
from dalembert.parameter import Parameter

SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def shown(value: float | None, deviation: float | None = None, digits: int = 6) -> str:
    """Return the text of a number. With its standard ``deviation``, it ends with the second digit of that; otherwise it
    has ``digits`` significant digits, trailing zeros dropped.
    """
    if value is None or math.isnan(value):
        return "–"
    if math.isinf(value):
        return "∞" if value > 0 else "−∞"
    if value == 0:
        return "0"
    known = deviation is not None and math.isfinite(deviation) and deviation > 0
    if known and deviation:
        digits = min(max(_exponent(value) - _exponent(deviation) + 2, 2), 12)
    rounded = float(f"{value:.{digits - 1}e}")
    exponent = _exponent(rounded)
    if -4 < exponent < 6:
        text = f"{rounded:.{max(digits - 1 - exponent, 0)}f}"
        text = text if known else _trimmed(text)
    else:
        mantissa, _, power = f"{rounded:.{digits - 1}e}".partition("e")
        mantissa = mantissa if known else _trimmed(mantissa)
        text = f"{mantissa} × 10{str(int(power)).translate(SUPERSCRIPTS)}"
    return text.replace("-", "−")


def with_deviation(value: float, deviation: float) -> str:
    """Return the text of a number and its standard deviation, to the same decimal: ``(2.0000 ± 0.0030) × 10⁸``."""
    if not (math.isfinite(deviation) and deviation > 0):
        return shown(value)
    mantissa, _, power = shown(value, deviation).partition(" × ")
    size = 10.0 ** _exponent(value) if power else 1.0
    spread = f"{deviation / size:.{len(mantissa.partition('.')[2])}f}"
    return f"({mantissa} ± {spread}) × {power}" if power else f"{mantissa} ± {spread}"


def interval(lower: float, upper: float) -> str:
    """Return the text of an interval; one number where its ends are the same."""
    return shown(float(lower)) if lower == upper else f"[{shown(float(lower))}, {shown(float(upper))}]"


def counted(number: int) -> str:
    """Return the text of a whole number, in groups of three digits."""
    return f"{number:,}".replace(",", " ")


def percent(part: float, digits: int = 3) -> str:
    """Return the text of a part of a whole in percent."""
    return f"{shown(100 * float(part), digits=digits)} %"


def _exponent(value: float) -> int:
    return math.floor(math.log10(abs(value)))


def _trimmed(text: str) -> str:
    return text.rstrip("0").rstrip(".") if "." in text else text


PREFIXES = {-9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G"}
SMALLEST = {"m": (-9, 0), "N": (0, 6), "J": (-9, 6)}
"""Exponents of the smallest and the largest prefix that people use with a unit; others stay as they are."""


def prefixed(largest: float, unit: str) -> tuple[float, str]:
    """Return the factor from a unit to one in which the largest of some values lies between 1 and 1000, and its name.
    >>> prefixed(2.5e-5, "m"), prefixed(1200.0, "N"), prefixed(3e-5, "rad"), prefixed(1e4, "m")
    ((1000000.0, 'µm'), (0.001, 'kN'), (1.0, 'rad'), (1.0, 'm'))
    """
    if unit not in SMALLEST or not (math.isfinite(largest) and largest > 0):
        return 1.0, unit
    least, most = SMALLEST[unit]
    exponent = min(max(3 * math.floor(math.log10(largest * (1 + 1e-12)) / 3), least), most)
    return 10.0**-exponent, f"{PREFIXES[exponent]}{unit}"


def in_words(value: float, unit: str, digits: int = 6) -> str:
    """Return the text of a number with the prefix of its unit that makes it easy to read."""
    factor, prefixed_unit = prefixed(abs(value), unit)
    return f"{shown(factor * value, digits=digits)} {prefixed_unit}"


def labelled(name: str, unit: str) -> str:
    """Name with its unit in brackets, where it has one."""
    return f"{name} ({unit})" if unit else name


MOST_FACTS = 4
"""Parameters up to which each value is a separate fact; more are only in a table."""


@dataclass(frozen=True)
class Cell:
    """One entry: its value, the text shown for it, and whether it deserves attention."""

    value: object
    text: str
    mark: bool = False


@dataclass(frozen=True)
class Table:
    """Rows of cells under named columns.

    Parameters
    ----------
    name : str
        Of the file that is downloaded.
    caption : str
        Shown above it; empty for one that is only downloaded.
    columns : sequence of str
    rows : sequence of sequence of Cell
    detail : bool
        Whether summaries leave it out.
    """

    macro: ClassVar[str] = "table"
    name: str
    caption: str
    columns: Sequence[str]
    rows: Sequence[Sequence[Cell]] = field(default_factory=tuple)
    detail: bool = False

    @classmethod
    def of(cls, name: str, caption: str, columns: Mapping[str, Iterable[object]], *, detail: bool = False) -> "Table":
        """A table of columns: values, or cells."""
        rows = zip(*columns.values(), strict=True)
        return cls(name, caption, tuple(columns), [tuple(map(cell, row)) for row in rows], detail)

    @classmethod
    def of_rows(
        cls,
        name: str,
        caption: str,
        columns: Sequence[str],
        rows: Iterable[Iterable[object]],
        *,
        detail: bool = False,
    ) -> "Table":
        """A table of rows: values, or cells."""
        return cls(name, caption, columns, [tuple(map(cell, row)) for row in rows], detail)

    @classmethod
    def joined(cls, tables: Mapping[str, "Table"]) -> "Table":
        """Return the tables of experiments as one, their names the first column unless one has no name."""
        first = next(iter(tables.values()))
        if "" in tables:
            return first
        rows = [(cell(experiment), *row) for experiment, table in tables.items() for row in table.rows]
        return replace(first, columns=("experiment", *first.columns), rows=rows)

    @property
    def csv(self) -> str:
        """The table as CSV, numbers with all their digits."""
        buffer = io.StringIO()
        writer = csv.writer(buffer, lineterminator="\n")
        writer.writerow([_safe(column) for column in self.columns])
        writer.writerows([_safe(entry.value) for entry in row] for row in self.rows)
        return buffer.getvalue()

    def lines(self, most: int = 20) -> list[str]:
        """Return the table as text for a terminal, of at most ``most`` rows.

        >>> print(*Table.of("masses", "Masses", {"body": ["rod"], "mass (kg)": [0.25]}).lines(), sep="\\n")
        body  mass (kg)
        ───────────────
        rod   0.25
        """
        texts = [tuple(self.columns), *(tuple(entry.text for entry in row) for row in self.rows[:most])]
        texts = [(*(text if len(text) <= 60 else f"{text[:58]} …" for text in row[:-1]), row[-1]) for row in texts]
        widths = [max(map(len, column)) for column in zip(*texts, strict=True)]
        lines = ["  ".join(map(str.ljust, row, widths)).rstrip() for row in texts]
        more = [f"and {len(self.rows) - most} more"] if len(self.rows) > most else []
        return [lines[0], "─" * (sum(widths) + 2 * (len(widths) - 1)), *lines[1:], *more]

    @property
    def link(self) -> str:
        """Address that holds the CSV in itself."""
        return "data:text/csv;charset=utf-8;base64," + base64.b64encode(self.csv.encode()).decode()


def noted(table: Table) -> Table:
    """The table without its last column where that says nothing."""
    if any(row[-1].text for row in table.rows):
        return table
    return replace(table, columns=table.columns[:-1], rows=[row[:-1] for row in table.rows])


def cell(value: object, deviation: float | None = None, *, digits: int = 6, mark: bool = False) -> Cell:
    """Cell of a value, with the digits that its standard deviation leaves.

    Examples
    --------
    >>> cell(0.78539816, 2e-4).text, cell("AB").text
    ('0.78540', 'AB')
    """
    if isinstance(value, Cell):
        return value
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, bool) or not isinstance(value, int | float):
        return Cell(value, str(value), mark)
    if isinstance(value, int):
        return Cell(value, counted(value), mark)
    return Cell(value, shown(value, deviation, digits), mark)


def cells(values: Iterable[object], digits: int = 6) -> list[Cell]:
    """Cells of values, with a number of significant digits."""
    return [cell(value, digits=digits) for value in values]


def marks(texts: Iterable[str]) -> list[Cell]:
    """Cells of notes, which deserve attention unless they are empty."""
    return [cell(text, mark=bool(text)) for text in texts]


def unless(done: Iterable[bool], text: str) -> list[Cell]:
    """Notes on what is not done."""
    return marks("" if is_done else text for is_done in done)


def few_values(parameters: Iterable[Parameter], texts: Iterable[str]) -> dict[str, str]:
    """Return the values of parameters as facts; none if there are many."""
    facts = {labelled(item.name, item.unit): text for item, text in zip(parameters, texts, strict=True)}
    return facts if len(facts) <= MOST_FACTS else {}


def box_table(box: Box, caption: str, name: str = "box", *, units: Sequence[str] = (), **more: Sequence[str]) -> Table:
    """Return ends, middle and radius of each interval of a box, the units that are known, and more columns."""
    middle, radius = (box.lower + box.upper) / 2, (box.upper - box.lower) / 2
    columns = {"parameter": box.names, "lower": box.lower, "upper": box.upper, "middle": middle, "radius": radius}
    if any(units):
        columns["unit"] = units
    return Table.of(name, caption, {**columns, **more})


def _safe(value: object) -> object:
    """A text that a spreadsheet would run as a formula gets an apostrophe."""
    return f"'{value}" if isinstance(value, str) and value.startswith(("=", "+", "-", "@", "\t")) else value
