"""What pydantic finds wrong in a study file, in sentences that a user can act on."""

import ast
import re
from collections.abc import Iterable
from difflib import get_close_matches
from typing import Any

from pydantic import ValidationError

from dalembert.component_index import KINDS, SPATIAL_KINDS
from dalembert.errors import unknown
from dalembert.study.text.spaces import is_in_space
from dalembert.study.text.table import Context

_TABLE = re.compile(r"\[\[?[a-z]")
_EXPECTED = {
    "int": "a whole number",
    "float": "a number",
    "bool": "true or false",
    "string": "text in quotes",
    "list": "a list",
    "dict": "a table",
    "model": "a table",
    "greater_than": "a number greater than {gt}",
    "greater_than_equal": "a number of at least {ge}",
    "multiple_of": "a multiple of {multiple_of}",
    "less_than": "a number less than {lt}",
    "less_than_equal": "a number of at most {le}",
    "too_short": "at least {min_length} entries",
    "too_long": "at most {max_length} entries",
    "string_too_short": "at least {min_length} characters",
}


def mistakes(error: ValidationError, document: Any, context: Context) -> list[tuple[tuple[str | int, ...], str]]:
    """Return the path and the sentence of each error: table and key, what was given, what is expected. ``document``:
    the study as TOML reads it, which was validated with the ``context``.
    """
    result = []
    for entry, path, table in _likeliest(document, error.errors(include_url=False)):
        where = path
        if entry["type"] == "extra_forbidden":
            *where, key = path
            texts = [unknown("key", str(key), context.known_keys(table))]
        else:
            texts = _texts(entry, is_in_space(document.get("model")))
        result += [(tuple(path), _placed(document, where, text)) for text in texts]
    return result


def _likeliest(document: Any, entries: Iterable[Any]) -> list[tuple[Any, list[str | int], Any]]:
    """Errors with their paths and holders, of each union those of the members that the value was meant for.

    A member of another type says nothing where a member of the same type found a mistake at the value, or within it.
    """
    followed = [(entry, *_follow(document, entry["loc"])) for entry in entries]
    kept = []
    for entry, path, holder in followed:
        of_union = len(entry["loc"]) > len(path) and entry["type"] != "missing"
        other = [candidate for candidate in followed if candidate[1][: len(path)] == path and candidate[0] is not entry]
        within = any(len(candidate[1]) > len(path) for candidate in other)
        at = any(candidate[1] == path and not _of_type(candidate[0]) for candidate in other)
        if not (of_union and (within or (at and _of_type(entry)))):
            kept.append((entry, path, holder))
    return kept


def _of_type(entry: Any) -> bool:
    return entry["type"].endswith("_type")


def _placed(document: Any, path: list[str | int], text: str) -> str:
    return text if not path or _TABLE.match(text) else f"{place(document, path)}: {text}"


def place(document: Any, path: Iterable[str | int]) -> str:
    """Return the name of a place in a study file, as its author would say it.
    >>> study = {"model": {"body": [{"name": "OA", "start": ["1 kg", 0]}]}}
    >>> place(study, ["model", "body", 0, "start", 0])
    "[[model.body]] 'OA', start, entry 1"
    """
    table: list[str] = []
    rest: list[str] = []
    current = document
    label = ""
    for step in path:
        current = _child(current, step)
        if isinstance(step, int):
            is_table = isinstance(current, dict) and not rest and not label
            name = current.get("name") if isinstance(current, dict) else None
            if is_table:
                label = f" {name!r}" if isinstance(name, str) else f" number {step + 1}"
            else:
                rest.append(f"entry {step + 1}")
        elif not rest and not label and _is_table(current):
            table.append(step)
        else:
            rest.append(step)
    brackets = "[[{}]]" if label else "[{}]"
    return ", ".join(([brackets.format(".".join(table)) + label] if table else []) + rest)


def _is_table(value: Any) -> bool:
    return isinstance(value, dict) or (
        isinstance(value, list) and bool(value) and all(isinstance(v, dict) for v in value)
    )


def _follow(document: Any, location: Iterable[str | int]) -> tuple[list[str | int], Any]:
    """Path in the document, without the names of union members that pydantic adds, and what holds its last step."""
    path: list[str | int] = []
    current = holder = document
    for step in location:
        child = _child(current, step)
        if child is not _NOTHING:
            path.append(step)
            holder, current = current, child
    return path, holder


def _child(value: Any, step: str | int) -> Any:
    if isinstance(value, dict) and step in value:
        return value[step]
    if isinstance(value, list) and isinstance(step, int) and step < len(value):
        return value[step]
    return _NOTHING


_NOTHING = object()


def _texts(entry: Any, space: bool) -> list[str]:
    kind, details = entry["type"], entry.get("ctx", {})
    if kind == "dalembert":
        return details["sentences"].split("\n")
    if kind == "missing":
        return [f"the key {entry['loc'][-1]!r} is missing"]
    if kind == "union_tag_not_found":
        return ["the key 'kind' is missing"]
    if kind == "union_tag_invalid":
        return [_unknown_kind(str(details["tag"]), _quoted(details["expected_tags"]), space)]
    if kind == "literal_error" and details["expected"] in ("True", "False"):
        kind = "bool"
    if kind == "literal_error":
        known = _quoted(details["expected"].replace(" or ", ", "))
        close = get_close_matches(str(entry["input"]), known, n=1)
        hint = f"; did you mean {close[0]!r}?" if close else ""
        return [f"{entry['input']!r} was given; expected {details['expected']}{hint}"]
    expected = _EXPECTED.get(kind, _EXPECTED.get(kind.split("_")[0], ""))
    return [f"{_short(entry['input'])} was given; expected {expected.format(**details)}" if expected else entry["msg"]]


def _unknown_kind(kind: str, known: list[str], space: bool) -> str:
    other_kinds = KINDS if space else SPATIAL_KINDS
    here = SPATIAL_KINDS if space else KINDS
    for base in ("Body", "Joint", "Load"):
        if kind in other_kinds[base] and not set(here[base]).isdisjoint(known):
            what = (
                "a planar component, and the model is in space (space = true)"
                if space
                else ("a component in space, and the model is planar without space = true")
            )
            return f"{kind!r} is {what}; expected one of {', '.join(known)}"
    return unknown("kind", kind, known)


def _quoted(listed: str) -> list[str]:
    return [str(name) for name in ast.literal_eval(f"[{listed}]")]


def _short(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
