"""Numbers of the lines of a long text file, without their cells one by one."""

from collections.abc import Sequence

import numpy as np

from dalembert.data.text_layout import COMMENTS, Layout, Line

HEAD = 5000
"""Lines whose layout is that of the file."""
BLOCK = 10_000
"""Lines that are read at once; other threads have their turn between blocks."""


def lines_of_numbers(lines: Sequence[Line], text_layout: Layout) -> list[Line]:
    """Return the lines from the first one of numbers on, without comments."""
    first = text_layout.rows[0][0]
    return [line for line in lines if line[0] >= first and not line[1].lstrip().startswith(COMMENTS)]


def quick_numbers(lines: Sequence[Line], text_layout: Layout) -> np.ndarray | None:
    """Return the numbers (lines, columns) of lines; None if a cell is no finite number, or a line of another length."""
    texts, width = [text for _, text in lines], len(text_layout.header)
    if text_layout.decimal == ",":
        if any("." in text for text in texts):  # which may divide thousands
            return None
        texts = [text.replace(",", ".") for text in texts]
    try:
        separator = None if text_layout.separator == " " else text_layout.separator
        table = np.loadtxt(texts, delimiter=separator, comments=None, quotechar='"', ndmin=2)
    except ValueError:
        return None
    return table if table.shape[1] == width and bool(np.isfinite(table).all()) else None


def quick_table(lines: Sequence[Line], text_layout: Layout) -> np.ndarray | None:
    """Return the numbers (lines, columns) of all lines of numbers, as :func:`quick_numbers` block by block."""
    blocks: list[np.ndarray] = []
    for begin in range(0, len(lines), BLOCK):
        numbers = quick_numbers(lines[begin : begin + BLOCK], text_layout)
        if numbers is None:
            return None
        blocks.append(numbers)
    return np.concatenate(blocks) if blocks else None
