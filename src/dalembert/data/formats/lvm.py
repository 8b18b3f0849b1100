"""Columns of a measurement file of LabVIEW."""

import re
from collections.abc import Mapping
from pathlib import Path

from dalembert.data.lines_format import LinesFormat
from dalembert.data.text_layout import Line
from dalembert.data.text_lines import text_lines
from dalembert.errors import DataError
from dalembert.unit_table import readings

END = "***End_of_Header***"
FIRST, COMMENT = "X_Value", "Comment"
"""Names of the first column, and of the last one."""
_COMMAS = re.compile(r"Separator[,\s]+Comma,*\s*")


class Lvm(LinesFormat):
    """LVM of LabVIEW: ``X_Value`` and the channels by their names, without the column of comments.

    Without a column of times (``X_Columns`` is ``No``), times are those of the header: ``X0 + n Delta_X``.
    """

    name = "lvm"
    suffixes = (".lvm",)

    def lines(self, path: Path) -> list[Line]:
        """The names of the channels, their units and the lines of numbers of all segments, without comments."""
        lines = text_lines(path)
        ends = [place for place, (_, text) in enumerate(lines) if text.strip(" \t,").startswith(END)]
        if not ends:
            return lines
        separator = "," if any(_COMMAS.fullmatch(text) for _, text in lines[: ends[0]]) else "\t"
        rows = [(number, [cell.strip() for cell in text.split(separator)]) for number, text in lines]
        is_timed = ["X_Columns", "No"] not in (cells[:2] for _, cells in rows[: ends[0]])
        table: list[tuple[int, list[str]]] = []
        head: dict[str, list[str]] = {}
        width, sample = 0, 0
        for number, cells in rows[ends[0] + 1 :]:
            if cells[0] in SETTINGS:
                head[cells[0]], sample = cells[1:], 0
            elif cells[0] == FIRST:  # names the channels of a segment
                if not width:
                    width = len(cells) - (cells[-1] == COMMENT)
                    names = [*head.get(UNITS, []), *([""] * width)][: width - 1]
                    known = [bool(readings(name)) for name in names if name]
                    table += [(number, cells[:width]), *([(number, ["", *names])] if known and all(known) else [])]
            elif width and all(map(_is_numeric, filter(None, cells[:width]))) and any(cells[:width]):
                time = cells[:1] if is_timed else [_time(path, head, sample)]
                table.append((number, time + cells[1:width]))
                sample += 1
        return [(number, separator.join(cells)) for number, cells in table]


BEGIN, STEP, UNITS = "X0", "Delta_X", "Y_Unit_Label"
SETTINGS = (BEGIN, STEP, UNITS)
"""Names of settings of a segment: its first time, the distance of its samples, and the units, of each channel."""


def _time(path: Path, head: Mapping[str, list[str]], sample: int) -> str:
    steps = {cell for cell in head.get(STEP, []) if cell}
    begins = {cell for cell in head.get(BEGIN, []) if cell} or {"0"}
    if len(steps) != 1 or len(begins) != 1 or not all(map(_is_numeric, steps | begins)):
        words = f"{STEP} {', '.join(sorted(steps)) or 'missing'} and {BEGIN} {', '.join(sorted(begins))}"
        raise DataError(
            f"{path}: the file has no column of times, and its header has {words}; expected one of each for all "
            "channels; export the channels of each rate by themselves"
        )
    step, begin = steps.pop(), begins.pop()
    time = float(begin.replace(",", ".")) + sample * float(step.replace(",", "."))
    return f"{time:.15g}".replace(".", "," if "," in step + begin else ".")


def _is_numeric(cell: str) -> bool:
    try:
        float(cell.replace(",", "."))
    except ValueError:
        return False
    return True
