"""What differs between two texts, line by line."""

from difflib import SequenceMatcher
from typing import Literal

from nicegui import ui

Kind = Literal["same", "added", "removed", "left out"]
Line = tuple[Kind, str]
AROUND = 3
"""Equal lines that are kept around a difference."""
_MARKS = {"same": " ", "added": "+", "removed": "−", "left out": "…"}


def differences(old: str, new: str) -> list[Line]:
    """Return the lines of two texts with what was done to them; equal lines far from differences are left out.

    >>> differences("a = 1\\nb = 2\\n", "a = 1\\nb = 3\\n")
    [('same', 'a = 1'), ('removed', 'b = 2'), ('added', 'b = 3')]
    >>> differences("a = 1\\n", "a = 1\\n")
    []
    """
    before, after = old.splitlines(), new.splitlines()
    groups = list(SequenceMatcher(None, before, after, autojunk=False).get_grouped_opcodes(AROUND))
    found: list[Line] = []
    for place, group in enumerate(groups):
        if place or group[0][1] > 0:
            found.append(("left out", ""))
        for kind, a, b, c, d in group:
            found += _lines(kind, before[a:b], after[c:d])
    if groups and groups[-1][-1][2] < len(before):
        found.append(("left out", ""))
    return found


def _lines(kind: str, old: list[str], new: list[str]) -> list[Line]:
    if kind == "equal":
        return [("same", line) for line in old]
    return [*(("removed", line) for line in old), *(("added", line) for line in new)]


def as_text(lines: list[Line]) -> str:
    """Return differences as a text with a mark before each line.
    >>> print(as_text([("removed", "b = 2"), ("added", "b = 3")]))
    − b = 2
    + b = 3
    """
    return "\n".join(f"{_MARKS[kind]} {line}".rstrip() for kind, line in lines)


def show_differences(lines: list[Line]) -> None:
    """Show differences on a page: a mark and a colour for each line."""
    grounds = {"added": "rgba(33, 186, 69, 0.2)", "removed": "rgba(224, 49, 49, 0.2)"}
    with ui.column().classes("w-full gap-0 border rounded overflow-x-auto py-1").props("role=group aria-label=Changes"):
        for kind, line in lines:
            text = ui.label(f"{_MARKS[kind]} {line}")
            text.classes("w-full min-w-fit whitespace-pre font-mono text-sm px-3")
            text.style(f"background: {grounds.get(kind, 'transparent')}")
