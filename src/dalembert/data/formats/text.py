"""Columns of numbers from a text file."""

from pathlib import Path

from dalembert.data.lines_format import LinesFormat
from dalembert.data.text_layout import Line
from dalembert.data.text_lines import text_lines


class Text(LinesFormat):
    """Text with columns."""

    name = "csv"
    suffixes = (".csv", ".txt", ".dat", ".tsv", ".asc", ".log")
    compressed = True

    def lines(self, path: Path) -> list[Line]:
        return text_lines(path)
