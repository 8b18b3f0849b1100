"""Tables of results: text for people, full numbers in the CSV that can be downloaded."""

import base64
import csv
import io
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import ClassVar

import numpy as np

from dalembert.digits import counted, shown
from dalembert.intervals import Box
from dalembert.parameters import Parameter
from dalembert.quantities import labelled

MOST_FACTS = 4
"""Parameters up to which the value of each is a fact of its own; more are in a table alone."""


@dataclass(frozen=True)
class Cell:
    """One entry: its value, the text shown for it, and whether it deserves attention."""

    value: object
    text: str
    mark: bool = False

    @property
    def numeric(self) -> bool:
        return isinstance(self.value, int | float) and not isinstance(self.value, bool)


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
    """

    macro: ClassVar[str] = "table"
    name: str
    caption: str
    columns: Sequence[str]
    rows: Sequence[Sequence[Cell]] = field(default_factory=tuple)

    @classmethod
    def of(cls, name: str, caption: str, columns: Mapping[str, Iterable[object]]) -> "Table":
        """A table of columns: values, or cells."""
        return cls.of_rows(name, caption, tuple(columns), zip(*columns.values(), strict=True))

    @classmethod
    def of_rows(cls, name: str, caption: str, columns: Sequence[str], rows: Iterable[Iterable[object]]) -> "Table":
        """A table of rows: values, or cells."""
        return cls(name, caption, columns, [tuple(map(cell, row)) for row in rows])

    @classmethod
    def of_experiments(
        cls, name: str, caption: str, columns: Sequence[str], rows: Mapping[str, Iterable[Iterable[object]]]
    ) -> "Table":
        """A table of the rows of each experiment, whose names are the first column unless one has no name."""
        if "" not in rows:
            columns = ("experiment", *columns)
            rows = {experiment: [(experiment, *row) for row in own] for experiment, own in rows.items()}
        return cls.of_rows(name, caption, columns, [row for own in rows.values() for row in own])

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
    return marks("" if one else text for one in done)


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
