"""Tables of a report: text for people, full numbers in the CSV that can be downloaded."""

import base64
import csv
import io
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import ClassVar

import numpy as np

from dalembert.report.digits import counted, shown


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


def _safe(value: object) -> object:
    """A text that a spreadsheet would run as a formula gets an apostrophe."""
    return f"'{value}" if isinstance(value, str) and value.startswith(("=", "+", "-", "@", "\t")) else value
