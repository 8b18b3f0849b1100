"""Changes of a study's text in place: keys and tables are added, changed and removed; comments and order stay.

tomlkit changes the keys of one table. It is not given the whole document: it moves tables of one list that stand apart.
"""

import re
from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from typing import Any

import tomlkit
from tomlkit.exceptions import TOMLKitError
from tomlkit.items import Item

from dalembert.errors import InputError
from dalembert.studio.editor.fields import TableField, tables_of
from dalembert.studio.editor.lines import Place, is_within, tables


def with_value(text: str, place: Place, value: Any) -> str:
    """Return the text with a value at a key; a table without a header becomes an inline table."""
    table = _table_with(text, place)
    if table is None:
        *holder, key = place
        return with_table(text, tuple(holder), {str(key): value})[0]

    def change(block: Any) -> None:
        *way, key = place[len(table) :]
        for step in way:
            if isinstance(step, str) and not isinstance(block.get(step), Mapping | list):
                block[step] = tomlkit.inline_table()
            block = block[step]
        block[key] = _item(value)

    return _changed(text, table, change)


def without(text: str, place: Place) -> str:
    """Return the text without a key, or without a table and the tables in it."""
    lines = [f"{line}\n" for line in text.splitlines()]
    blocks = [(first, end) for table, first, end in _blocks(text) if is_within(table, place)]
    if blocks:
        for first, end in reversed(blocks):
            is_apart = first == 0 or not lines[first - 1].strip()
            del lines[first:end]
            while is_apart and first < len(lines) and not lines[first].strip():
                del lines[first]
        return "".join(lines)
    table = _table_with(text, place)
    if table is None:
        return text

    def change(block: Any) -> None:
        *way, key = place[len(table) :]
        for step in way:
            block = block[step]
        del block[key]

    return _changed(text, table, change)


def with_table(text: str, place: Place, values: Mapping[str, Any]) -> tuple[str, Place]:
    """Return the text with a further table, and its place. ``place`` is that of a table, ``("identify",)``, or of an
    entry of a list, ``("model", "body", 0)``: any number at its end stands for the next free one.
    """
    blocks, is_entry = _blocks(text), isinstance(place[-1], int)
    if is_entry:
        place = (*place[:-1], sum(table[:-1] == place[:-1] for table, _, _ in blocks))
    elif len(place) == 2 and place[0] != "model":
        if any(table == place[:1] for table, _, _ in blocks):
            return with_value(text, place, dict(values)), place
        if not any(is_within(table, place[:1]) for table, _, _ in blocks):
            return with_table(text, place[:1], {str(place[1]): values})[0], place
    name = ".".join(_key(step) for step in place if isinstance(step, str))
    lines = [f"{line}\n" for line in text.splitlines()]
    order = list(tables_of({}))
    at = max((end for table, _, end in blocks if _rank(table, order) <= _rank(place, order)), default=_beginning(lines))
    gap_before = "\n" if at and lines[at - 1].strip() else ""
    gap_after = "\n" if at < len(lines) and lines[at].strip() else ""
    document = tomlkit.document()
    for key, value in values.items():
        document[key] = _item(value)
    header = f"[[{name}]]" if is_entry else f"[{name}]"
    lines.insert(at, f"{gap_before}{header}\n{tomlkit.dumps(document)}{gap_after}")
    return "".join(lines), place


def value_of(text: str, field: TableField) -> Any:
    """Return the value that a text in a form stands for, by the shape of its field; None if it is empty.
    >>> number, names = TableField("length", "number"), TableField("channels", "list")
    >>> value_of("0.4", number), value_of("400 mm", number), value_of("A.x, A.y", names)
    (0.4, '400 mm', ['A.x', 'A.y'])
    """
    text = text.strip()
    if not text:
        return None
    if text[0] in "[{":
        try:
            return tomlkit.value(text).unwrap()
        except TOMLKitError as error:
            raise InputError(f"{field.key}: {text} is not valid TOML: {error}. Write a list as [1, 2]") from None
    if field.shape == "list":
        return [_number_or_text(part.strip()) for part in text.split(",")]
    if field.shape == "switch" and text in ("true", "false"):
        return text == "true"
    return _number_or_text(text) if field.shape in ("number", "whole") else text


def text_of(value: Any) -> str:
    """Return a value of a study as a form shows it; :func:`value_of` reads it back.
    >>> text_of("400 mm"), text_of([0, "2 m"]), text_of({"end": 2.0})
    ('400 mm', '[0, "2 m"]', '{ end = 2.0 }')
    """
    return "" if value is None else value if isinstance(value, str) else _item(value).as_string()


def _number_or_text(text: str) -> int | float | str:
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text


def _blocks(text: str) -> list[tuple[Place, int, int]]:
    """Tables with headers, the lines of these, from 0, and the lines after the last key of each."""
    lines = text.splitlines()
    headers = [*tables(text), ((), len(lines) + 1)]
    blocks = []
    for (table, first), (_, after) in pairwise(headers):
        end = after - 1
        while end > first and (not lines[end - 1].strip() or lines[end - 1].lstrip().startswith("#")):
            end -= 1
        blocks.append((table, first - 1, end))
    return blocks


def _table_with(text: str, place: Place) -> Place | None:
    """The table with a header that a key at a place stands in; None if there is none."""
    tables = [table for table, _, _ in _blocks(text) if is_within(place, table) and len(table) < len(place)]
    return max(tables, key=len, default=None)


def _changed(text: str, table: Place, change: Callable[[Any], None]) -> str:
    """The text after a change of the keys of a table."""
    lines = [f"{line}\n" for line in text.splitlines()]
    first, end = next((first, end) for header, first, end in _blocks(text) if header == table)
    try:
        block = tomlkit.parse("".join(lines[first + 1 : end]))
        change(block)
    except (KeyError, IndexError, TypeError):
        raise InputError("The text has changed meanwhile. Select the table again") from None
    except TOMLKitError as error:
        raise InputError(f"The text is not valid TOML: {error}. Correct it first") from None
    lines[first + 1 : end] = [tomlkit.dumps(block)]
    return "".join(lines)


def _item(value: Any) -> Item:
    """A value as TOML writes it, tables in one line."""
    if isinstance(value, Mapping):
        pairs = ", ".join(f"{_key(str(key))} = {_item(entry).as_string()}" for key, entry in value.items())
        return tomlkit.value(f"{{ {pairs} }}" if value else "{}")
    if isinstance(value, Sequence) and not isinstance(value, str):
        array = tomlkit.array()
        for entry in value:
            array.append(_item(entry))
        return array
    return tomlkit.item(value)


def _key(name: str) -> str:
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else tomlkit.item(name).as_string()


def _rank(place: Place, order: Sequence[Place]) -> tuple[int, int]:
    """Where a table stands usually: by its first key, and those of a model by the second one."""
    tops, inner = [table[:1] for table in order], [table[:2] for table in order]
    top = tops.index(place[:1]) if place[:1] in tops else len(order)
    return top, inner.index(place[:2]) if len(place) > 1 and place[:2] in inner else -1


def _beginning(lines: Sequence[str]) -> int:
    """Where a first table goes: after directives such as ``#:schema``."""
    return next((number for number, line in enumerate(lines) if not line.startswith("#:")), len(lines))
