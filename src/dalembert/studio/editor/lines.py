"""Lines of the text of a study file, and the places in the file that they are about."""

import re
from collections.abc import Iterator, Sequence
from itertools import pairwise

_PART = r"""(?:"[^"]*"|'[^']*'|[\w-]+)"""
_PARTS = rf"{_PART}(?:\s*\.\s*{_PART})*"
_HEADER = re.compile(rf"\s*(\[\[?)\s*({_PARTS})\s*\]\]?\s*(#.*)?$")
_KEY = re.compile(rf"\s*({_PARTS})\s*=")
Place = tuple[str | int, ...]


def line_of(text: str, place: Sequence[str | int]) -> int:
    """Number of the line, from 1, of the longest beginning of a place that is in the text; 1 if none is."""
    known = dict(reversed(list(_places(text))))  # the first of each
    for length in range(len(place), 0, -1):
        if tuple(place[:length]) in known:
            return known[tuple(place[:length])]
    return 1


def place_at(text: str, line: int) -> Place:
    """Return the key, or the table, that a line is part of; an empty place above the first."""
    table: Place = ()
    for place, number in _places(text):
        if number > line:
            break
        table = place
    return table


def is_within(place: Place | None, table: Place) -> bool:
    """Whether a place is a table, or lies in it; None lies in no table."""
    return place is not None and place[: len(table)] == table


def table_of(text: str, place: Place) -> Place:
    """Return the innermost table with a header that a place is, or lies in; an empty one if there is none."""
    within = [table for table, _ in tables(text) if is_within(place, table)]
    return max(within, key=len, default=())


def lines_of(text: str, table: Place) -> range:
    """Return the lines of a table from its header to the last line before the next one; empty if it is not there. Blank
    lines at its end are left out.
    """
    lines = text.splitlines()
    headers = [*tables(text), ((), len(lines) + 1)]
    for (header, first), (_, after) in pairwise(headers):
        if header == table:
            while after - 1 > first and not lines[after - 2].strip():
                after -= 1
            return range(first, after)
    return range(0)


def _places(text: str) -> Iterator[tuple[Place, int]]:
    """Tables and keys with the numbers of their lines."""
    headers = {number: table for table, number in tables(text)}
    table: Place = ()
    for number, line in enumerate(text.splitlines(), 1):
        if number in headers:
            table = headers[number]
            yield from ((table[:length], number) for length in range(1, len(table) + 1))
        elif key := _KEY.match(line):
            yield (*table, *_parts(key[1])), number


def tables(text: str) -> Iterator[tuple[Place, int]]:
    """Tables with the numbers of the lines of their headers."""
    counts: dict[str, int] = {}
    for number, line in enumerate(text.splitlines(), 1):
        if header := _HEADER.match(line):
            name = header[2]
            if header[1] == "[[":
                counts[name] = counts.get(name, -1) + 1
            yield _resolved(_parts(name), counts), number


def _parts(name: str) -> list[str]:
    """Parts of a dotted name, without their quotes."""
    return [part.strip().strip("\"'") for part in re.findall(r"\"[^\"]*\"|'[^']*'|[^.]+", name)]


def _resolved(parts: list[str], counts: dict[str, int]) -> Place:
    """A table's path, with the numbers of the entries of lists of tables."""
    path: list[str | int] = []
    for length, part in enumerate(parts, 1):
        path.append(part)
        number = counts.get(".".join(parts[:length]))
        if number is not None:
            path.append(number)
    return tuple(path)
