"""Where in the text of a study file a place stands that a mistake is about."""

import re
from collections.abc import Iterator, Sequence

_HEADER = re.compile(r"\s*(\[\[?)\s*([^\[\]]+?)\s*\]\]?\s*(#.*)?$")
_PART = r"""(?:"[^"]*"|'[^']*'|[\w-]+)"""
_KEY = re.compile(rf"\s*({_PART}(?:\s*\.\s*{_PART})*)\s*=")
Place = tuple[str | int, ...]


def line_of(text: str, place: Sequence[str | int]) -> int:
    """Number of the line, from 1, of the longest beginning of a place that stands in the text.

    Examples
    --------
    >>> text = '[model]\\ngravity = [0, 0]\\n[[model.body]]\\nname = "A"\\n[[model.body]]\\nname = "B"\\n'
    >>> line_of(text, ("model", "gravity", 1)), line_of(text, ("model", "body", 1, "name"))
    (2, 6)
    >>> line_of(text, ("identify", "starts"))
    1
    """
    known = dict(reversed(list(_places(text))))  # the first of each
    for length in range(len(place), 0, -1):
        if tuple(place[:length]) in known:
            return known[tuple(place[:length])]
    return 1


def _places(text: str) -> Iterator[tuple[Place, int]]:
    """Tables and keys with the numbers of their lines."""
    counts: dict[str, int] = {}
    table: Place = ()
    for number, line in enumerate(text.splitlines(), 1):
        if header := _HEADER.match(line):
            name = header[2]
            if header[1] == "[[":
                counts[name] = counts.get(name, -1) + 1
            table = _resolved(_parts(name), counts)
            yield from ((table[:length], number) for length in range(1, len(table) + 1))
        elif key := _KEY.match(line):
            yield (*table, *_parts(key[1])), number


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
