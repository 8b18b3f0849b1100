"""Completions of a study's text at a position, and what is said about the word there."""

import re
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from dalembert.studio.editor.cursor import Cursor, cursor_at, tolerant
from dalembert.studio.editor.fields import KIND, child, field_at, fields_at, keys_named, kinds_at, tables_of
from dalembert.studio.editor.lines import Place
from dalembert.studio.editor.model_kind import fits_model
from dalembert.studio.editor.names import Names, names_in

_OF_MODELS = ("model", "constants", "inputs")
"""Tables whose numbers may be expressions of parameters and constants."""
_WORD = re.compile(r"[\w-]*$")
_REST = re.compile(r"[\w-]*")


@dataclass(frozen=True)
class Option:
    """One of several completions. ``label`` is shown and compared with what is typed; ``insert`` replaces the typed
    text. ``detail`` (unit and default) is shown after the label. ``info`` is the meaning, shown while the completion is
    selected.
    """

    label: str
    insert: str
    detail: str = ""
    info: str = ""


def completions(
    text: str, position: int, more: Names | None = None, tables: Collection[str] = ()
) -> tuple[int, tuple[Option, ...]]:
    """Return where the completed text begins, and the completions at a position in a study's text (characters from its
    beginning). ``more`` has names that the text does not contain, such as the channels of the mechanism. ``tables`` are
    those that the file may have; all if empty.
    """
    cursor = cursor_at(text, position)
    if cursor is None:
        return position, ()
    document = _completed(tolerant(text), cursor)
    names = dict(names_in(document))
    for what, known in (more or {}).items():
        names[what] = tuple(dict.fromkeys((*names.get(what, ()), *known)))
    make = {"header": _headers, "key": _keys, "value": _values}[cursor.where]
    options = [
        completion for completion in make(document, cursor, names) if not tables or _table(completion, cursor) in tables
    ]
    typed = cursor.typed
    if cursor.where == "value" and not any(option.label.lower().startswith(typed.lower()) for option in options):
        typed = _WORD.search(typed)[0]  # type: ignore[index]  # the last name of an expression
    fitting = (option for option in options if option.label.lower().startswith(typed.lower()))
    return position - len(typed), tuple(option for option in fitting if option.label != typed)


def explanation(text: str, position: int) -> Option | None:
    """Return what the word at a position means: a key with unit and default, a kind, or a table."""
    end = position + len(_REST.match(text, position)[0])  # type: ignore[index]
    cursor, document = cursor_at(text, end), tolerant(text)
    if cursor is None or not cursor.typed:
        return None
    if cursor.where == "header":
        name = text[text.rfind("\n", 0, end) + 1 :].partition("\n")[0].strip().strip("[]")
        about = {_name(place): meaning for place, meaning in tables_of(document).items()}
        return Option(name, "", info=about[name]) if about.get(name) else None
    document = _completed(document, cursor)
    if cursor.where == "value":
        about = kinds_at(document, cursor.place[:-1]) if cursor.place[-1] == KIND else {}
        return Option(cursor.typed, "", info=about[cursor.typed]) if about.get(cursor.typed) else None
    field = field_at(document, (*cursor.place, cursor.typed.strip("\"'")))
    return None if field is None else Option(field.key, "", field.facts, field.meaning)


def _headers(document: Any, cursor: Cursor, names: Names) -> Iterator[Option]:
    for place, meaning in tables_of(document).items():
        if place[:1] == ("model",) and not all(fits_model(document, key) for key in place[1:2]):
            continue
        if isinstance(place[-1], int):
            yield Option(f"[[{_name(place)}]]", f"[[{_name(place)}]]", info=meaning)
        elif child(document, place) is None:
            yield Option(f"[{_name(place)}]", f"[{_name(place)}]", info=meaning)


def _keys(document: Any, cursor: Cursor, names: Names) -> Iterator[Option]:
    present = child(document, cursor.place)
    taken = set(present) - {cursor.typed} if isinstance(present, Mapping) else set()
    for field in fields_at(document, cursor.place):
        if field.key not in taken and (cursor.place != ("model",) or fits_model(document, field.key)):
            yield Option(field.key, f"{field.key} = ", field.facts, field.meaning)
    for name in names.get(keys_named(cursor.place), ()):
        if name not in taken:
            yield Option(f'"{name}"' if "." in name else name, f'"{name}" = ' if "." in name else f"{name} = ")


def _values(document: Any, cursor: Cursor, names: Names) -> Iterator[Option]:
    field = field_at(document, cursor.place)
    if field is None:
        return
    about = kinds_at(document, cursor.place[:-1] if field.key == KIND else cursor.place)
    is_expression = field.shape == "number" and cursor.place[0] in _OF_MODELS
    for text in (*field.choices, *names.get(field.names or "number" * is_expression, ())):
        yield Option(text, text if cursor.quoted else f'"{text}"', info=about.get(text, ""))
    if field.shape == "switch":
        yield from (Option(text, text, field.facts, field.meaning) for text in ("true", "false"))


def _table(option: Option, cursor: Cursor) -> str:
    """The table of the file that a completion belongs to."""
    return str(cursor.place[0]) if cursor.place else option.label.strip("[]").partition(".")[0]


def _name(place: Place) -> str:
    return ".".join(str(step) for step in place if isinstance(step, str))


def _completed(document: dict[str, Any], cursor: Cursor) -> dict[str, Any]:
    """The document with the keys of an inline table that is being typed."""
    if not cursor.given:
        return document
    place = cursor.place if cursor.where == "key" else cursor.place[:-1]
    holder = child(document, place[:-1])
    if isinstance(holder, dict) and not isinstance(holder.get(str(place[-1])), dict):
        holder[str(place[-1])] = dict(cursor.given)
    return document
