"""Entries of a study's document as a user would write them: with units, in the same style, comments kept."""

import re
from collections.abc import Iterable, Mapping
from typing import Any

import tomlkit
from tomlkit.items import InlineTable, Item

from dalembert.errors import InputError
from dalembert.study.text.expressions import Expression
from dalembert.study.text.numbers import read_number
from dalembert.units import is_quantity

_NUMBER = re.compile(r"\s*[+-]?[\d.]+([eE][+-]?\d+)?")
DIGITS = 6
"""Significant digits of numbers that are written into a study."""


def table_at(document: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    """Return a table of a document; an empty one if it is not there."""
    entry = document.get(name)
    return entry if isinstance(entry, Mapping) else {}


def number_of(entry: object) -> float | None:
    """Return the number that an entry is, in SI units; None for an expression of names, and for no entry.
    >>> number_of("1 ms"), number_of(0.5), number_of("pi / 2"), number_of("angle"), number_of(None)
    (0.001, 0.5, 1.5707963267948966, None, None)
    """
    if entry is None or isinstance(entry, bool):
        return None
    try:
        number = read_number(entry, None, None)
    except InputError:
        return None
    return None if isinstance(number, Expression) else float(number)


def units_of(entry: object) -> str:
    """Return the unit that an entry has with it; empty if there is none.
    >>> units_of("1 ms"), units_of(0.001), units_of("pi / 2")
    ('ms', '', '')
    """
    if not isinstance(entry, str) or not is_quantity(entry):
        return ""
    return _NUMBER.sub("", entry).strip()


def unit_among(entries: Iterable[object]) -> tuple[str, float]:
    """Return the first unit that entries have, and its size in SI units; ``("", 1.0)`` if none has one. A unit whose
    zero is another one, such as that of a temperature, is left out.
    >>> unit_among([0.5, "2 ms"]), unit_among([0.5])
    (('ms', 0.001), ('', 1.0))
    """
    unit = next(filter(None, map(units_of, entries)), "")
    zero, unity = (number_of(f"{size} {unit}") for size in (0, 1)) if unit else (None, None)
    return (unit, unity) if zero == 0 and unity else ("", 1.0)


def like(entry: object, number: float, table: Mapping[str, Any] | None = None) -> str | float:
    """Return a number in SI units as an entry with the unit of another entry, else of the first in ``table`` with one.
    >>> like("1 ms", 0.0005), like(0.001, 0.0005), like(0, 1.0, {"lower": 0, "upper": "90 deg"})
    ('0.5 ms', 0.0005, '57.2958 deg')
    """
    unit, size = unit_among([entry, *(table or {}).values()])
    return f"{number / size:.{DIGITS}g} {unit}" if unit else float(f"{number:.{DIGITS}g}")


def first_guess(value: float, table: Mapping[str, Any]) -> Any:
    """Return a value (SI units) as the ``start`` of a parameter's table; the entry of a bound that it reaches.
    >>> bounds = {"lower": "-60 deg", "upper": 1.0}
    >>> first_guess(0.5, bounds), first_guess(1.0, bounds), first_guess(-2.0, bounds)
    ('28.6479 deg', 1.0, '-60 deg')
    """
    entry = like(table.get("start", table.get("lower")), value, table)
    written = number_of(entry)  # rounded, so that it may lie outside of bounds that the value itself keeps
    for side, sign in (("lower", 1.0), ("upper", -1.0)):
        bound = number_of(table.get(side))
        if written is not None and bound is not None and sign * written <= sign * bound:
            return table[side].unwrap() if isinstance(table[side], Item) else table[side]
    return entry


def put(parent: Any, name: str | int, **entries: Any) -> None:
    """Set entries of a table, which is made if it is not there; None removes an entry.
    >>> document = tomlkit.parse("a = { b = 1, c = 2 } # kept\\n")
    >>> put(document, "a", b=None, d=[0.0, 0.5])
    >>> print(tomlkit.dumps(document), end="")
    a = { c = 2, d = [0.0, 0.5] } # kept
    """
    known: Any = parent.get(name) if isinstance(name, str) else parent[name]
    is_table = hasattr(known, "items")
    if isinstance(known, InlineTable) or not (is_table or isinstance(parent, tomlkit.TOMLDocument)):
        parent[name] = _inline(known if is_table else {}, entries)
        return
    if not is_table:
        known = tomlkit.table()
        parent.append(str(name), known)
    for key, value in entries.items():
        if value is not None:
            known[key] = value
        elif key in known:
            del known[key]


def _inline(known: Any, entries: Mapping[str, Any]) -> Item:
    """An inline table with spaces as people write them."""
    merged = {key: entry for key, entry in {**dict(known or {}), **entries}.items() if entry is not None}
    parts = [f"{tomlkit.key(key).as_string()} = {tomlkit.item(entry).as_string()}" for key, entry in merged.items()]
    return tomlkit.value(f"{{ {', '.join(parts)} }}")
