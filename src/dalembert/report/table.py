"""Tables of a report: text for people, full numbers in the CSV that can be downloaded."""

import base64
import csv
import io
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

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

    name: str
    caption: str
    columns: Sequence[str]
    rows: Sequence[Sequence[Cell]] = field(default_factory=tuple)

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
    if isinstance(value, bool) or not isinstance(value, int | float):
        return Cell(value, str(value), mark)
    if isinstance(value, int):
        return Cell(value, counted(value), mark)
    return Cell(value, shown(value, deviation, digits), mark)


def _safe(value: object) -> object:
    """A text that a spreadsheet would run as a formula gets an apostrophe."""
    return f"'{value}" if isinstance(value, str) and value.startswith(("=", "+", "-", "@", "\t")) else value
