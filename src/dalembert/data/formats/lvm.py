"""Columns of a measurement file of LabVIEW."""

import re
from pathlib import Path

from dalembert.data.lines_format import LinesFormat
from dalembert.data.text_layout import Line
from dalembert.data.text_lines import text_lines

END = "***End_of_Header***"
FIRST, COMMENT = "X_Value", "Comment"
"""Names of the first column, and of the last one."""
_COMMAS = re.compile(r"Separator[,\s]+Comma,*\s*")


class Lvm(LinesFormat):
    """LVM of LabVIEW: ``X_Value`` and the channels by their names, without the column of comments."""

    name = "lvm"
    suffixes = (".lvm",)

    def lines(self, path: Path) -> list[Line]:
        """The names of the channels and the lines of numbers of all segments, without headers and comments."""
        lines, found, width = text_lines(path), [], 0
        ends = [place for place, (_, text) in enumerate(lines) if text.strip(" \t,").startswith(END)]
        if not ends:
            return lines
        separator = "," if any(_COMMAS.fullmatch(text) for _, text in lines[: ends[0]]) else "\t"
        for number, text in lines[ends[0] + 1 :]:
            cells = [cell.strip() for cell in text.split(separator)]
            if cells[0] == FIRST:  # names the channels of a segment
                if not width:
                    width = len(cells) - (cells[-1] == COMMENT)
                    found.append((number, separator.join(cells[:width])))
            elif width and all(map(_is_numeric, filter(None, cells[:width]))) and any(cells[:width]):
                found.append((number, separator.join(cells[:width])))
        return found


def _is_numeric(cell: str) -> bool:
    try:
        float(cell.replace(",", "."))
    except ValueError:
        return False
    return True
