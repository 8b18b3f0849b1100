"""Columns of a sheet of a workbook of Excel."""

from datetime import date, datetime, time, timedelta
from pathlib import Path
from typing import Any

from dalembert.data.lines_format import LinesFormat
from dalembert.data.opening import library, reading
from dalembert.data.text_layout import Line
from dalembert.errors import DataError


class Xlsx(LinesFormat):
    """XLSX of Excel: the first sheet with numbers, read as text with columns is."""

    name = "xlsx"
    suffixes = (".xlsx", ".xlsm")

    def lines(self, path: Path) -> list[Line]:
        with reading(path, "XLSX"):
            openpyxl = library("openpyxl", path, "XLSX files", "xlsx")
            book = openpyxl.load_workbook(path, read_only=True, data_only=True)
            try:
                sheets = [_lines(sheet) for sheet in book.worksheets]
            finally:
                book.close()
        for lines, numbers in sheets:
            if numbers:
                return lines
        raise DataError(f"{path}: no sheet has numbers; save the values of formulas with the workbook")


def _lines(sheet: Any) -> tuple[list[Line], int]:
    lines, numbers = [], 0
    for number, row in enumerate(sheet.iter_rows(values_only=True), start=1):
        if any(cell is not None for cell in row):
            numbers += sum(isinstance(cell, int | float) and not isinstance(cell, bool) for cell in row)
            lines.append((number, "\t".join(map(_text, row))))
    return lines, numbers


def _text(cell: Any) -> str:
    if cell is None:
        return ""
    if isinstance(cell, timedelta):
        return repr(cell.total_seconds())
    if isinstance(cell, datetime | date | time):
        return cell.isoformat(*([" "] if isinstance(cell, datetime) else []))
    return str(cell).replace("\t", " ").replace("\n", " ").replace('"', "'")
