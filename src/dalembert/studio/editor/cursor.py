"""Where a position in the text of a study is: the table, the key, or the value of a key, also while it is typed."""

import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from dalembert.studio.editor.lines import Place, tables

_HEADER = re.compile(r"\s*\[\[?[\w.\-\"' ]*$")
_PIECES = re.compile(r"""\"[^"\n]*"?|'[^'\n]*'?|\#[^\n]*|[^\s"'\#=\[\]{},]+|\n|.""")


@dataclass(frozen=True)
class Cursor:
    """A position in a text. ``place`` is the table that a key belongs to, or the key that has the value. ``typed`` is
    the part before the position of the header, the key, the text in quotes, or the number or word. ``quoted`` is True
    within quotes. ``given`` maps the keys that an inline table has before the position to their texts.
    """

    where: Literal["header", "key", "value"]
    place: Place
    typed: str
    quoted: bool = False
    given: Mapping[str, str] = field(default_factory=dict)


def cursor_at(text: str, position: int) -> Cursor | None:
    """Return where a position (characters from the beginning) is; None in a comment.
    >>> cursor_at("[parameters]\\nd = { lower = 0, up", 32)
    Cursor(where='key', place=('parameters', 'd'), typed='up', quoted=False, given={'lower': ''})
    """
    before = text[:position]
    line = before.rpartition("\n")[2]
    if _HEADER.match(line):
        return Cursor("header", (), line.strip())
    headers = [(place, number) for place, number in tables(before)]
    table, first = headers[-1] if headers else ((), 0)
    if first == before.count("\n") + 1:  # behind a header
        return None
    return _followed(table, "\n".join(before.split("\n")[first:]))


def _followed(table: Place, text: str) -> Cursor | None:
    """Follow the keys and values of a table to the end of a text."""
    place, typed, in_value, quoted = table, "", False, False
    values: dict[str, str] = {}
    stack: list[tuple[str, Place, dict[str, str]]] = []  # open brackets, with what was before them
    pieces = _PIECES.findall(text)
    for piece in pieces:
        if piece[0] in "\"'" and in_value:
            typed = piece.strip(piece[0])
            quoted = len(piece) == 1 or piece[-1] != piece[0]
            values[str(place[-1])] = typed
        elif piece == "=" and not in_value:
            place, in_value, typed = (*place, *_parts(typed)), True, ""
            values[str(place[-1])] = ""
        elif piece == "{" or (piece == "[" and in_value):
            stack.append((piece, place, values))
            values, in_value, typed = ({}, False, "") if piece == "{" else (values, True, "")
        elif piece in "}]" and stack:
            _, place, values = stack.pop()
            in_value, typed = True, ""
        elif piece == "," and stack:
            place, in_value, typed = stack[-1][1], stack[-1][0] == "[", ""
        elif piece == "\n" and not stack:
            place, in_value, typed = table, False, ""
        elif not piece.startswith("#"):
            typed = (typed + piece).lstrip()
    if pieces and pieces[-1].startswith("#"):
        return None
    return Cursor("value" if in_value else "key", place, typed, quoted, values if stack else {})


def _parts(key: str) -> list[str]:
    key = key.strip()
    return [key.strip('"')] if key.startswith('"') else [part.strip() for part in key.split(".")]


def tolerant(text: str) -> dict[str, Any]:
    """Return the document of a text; of one that is not valid TOML, the lines that are."""
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError):
        pass
    document: dict[str, Any] = {}
    headers = {number: place for place, number in tables(text)}
    table = document
    for number, line in enumerate(text.splitlines(), 1):
        if number in headers:
            table = _with_tables(document, headers[number])
        else:
            try:
                table |= tomllib.loads(line)
            except (ValueError, RecursionError):
                continue
    return document


def _with_tables(document: dict[str, Any], place: Place) -> dict[str, Any]:
    """The table at a place, made where it is not there."""
    table: Any = document
    for step, following in zip(place, (*place[1:], ""), strict=True):
        if isinstance(step, int):
            while len(table) <= step:
                table.append({})
            table = table[step]
        else:
            empty: Any = [] if isinstance(following, int) else {}
            if not isinstance(table.get(step), type(empty)):
                table[step] = empty
            table = table[step]
    return table
