"""What can be added to a study by a form: bodies, joints, forces, contacts, sensors, parameters, tasks and so on."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace
from itertools import count
from typing import Any

from dalembert.studio.editor.cursor import tolerant
from dalembert.studio.editor.editing import with_table, with_value, without
from dalembert.studio.editor.fields import KIND, fields_at, kinds_at, tables_of
from dalembert.studio.editor.lines import Place
from dalembert.studio.editor.model_kind import model_elsewhere, model_kind
from dalembert.study.schema_file import task_names

_MECHANISM = {"body": "Body", "joint": "Joint", "load": "Force"}
_STRUCTURE = {"mass": "Mass", "spring": "Spring", "rotor": "Rotor", "force": "Force", "contact": "Contact"}
_NAMED = {"parameters": "Parameter", "constants": "Constant", "sensors": "Sensor", "inputs": "Input"}
_BEGINNING = {"parameters": {"lower": 0.0, "upper": 1.0}}
"""With what a table begins."""
TASK = "Task"


@dataclass(frozen=True)
class Addition:
    """Something that can be added. ``place``: table or list of tables to add it to, empty for one of the tables of
    ``kinds``; ``kinds``: kinds, or tables, and their meanings, empty if a name is requested; ``names``: ``"channel"``
    for that of a channel, empty for a new name; ``elsewhere``: a sentence on where to add it instead, or empty.
    """

    label: str
    place: Place
    kinds: Mapping[str, str] = field(default_factory=dict)
    names: str = ""
    elsewhere: str = ""


def additions(text: str, only: Collection[str] = ()) -> tuple[Addition, ...]:
    """Return what can be added to a study, or to a file that may have ``only`` some of its tables."""
    document = tolerant(text)
    parts = _STRUCTURE if model_kind(document) == "structure" else _MECHANISM
    elsewhere = model_elsewhere(document)
    result = [
        Addition(label, ("model", key, 0), kinds_at(document, ("model", key, 0)), elsewhere=elsewhere)
        for key, label in parts.items()
    ]
    result += [Addition(label, (key,), names="channel" if key == "sensors" else "") for key, label in _NAMED.items()]
    tables = {place[0]: meaning for place, meaning in tables_of(document).items() if len(place) == 1}
    rest = {key: meaning for key, meaning in tables.items() if key not in (*task_names(), *_NAMED, *document)}
    tasks = {str(key): meaning for key, meaning in tables.items() if key in task_names() and key not in document}
    result += [Addition(TASK, (), tasks), Addition("Table", (), {str(key): table for key, table in rest.items()})]
    return tuple(filter(None, (_within(table, only) for table in result))) if only else tuple(result)


def _within(addition: Addition, tables: Collection[str]) -> Addition | None:
    """The addition as far as it is one of the tables, or to one of them; None if nothing is left."""
    if addition.place:
        return addition if addition.place[0] in tables else None
    kinds = {kind: meaning for kind, meaning in addition.kinds.items() if kind in tables}
    return replace(addition, kinds=kinds) if kinds else None


def added(text: str, addition: Addition, what: str) -> tuple[str, Place]:
    """Return the text with an addition, and its place. ``what`` is one of the addition's kinds, or a name. A task
    replaces the one that there is, as a study has one.
    """
    document = tolerant(text)
    if addition.place == ("constants",):
        return with_value(text, ("constants", what), 0.0), ("constants", what)
    if not addition.kinds:
        return with_table(text, (*addition.place, what), _BEGINNING.get(str(addition.place[0]), {}))
    if not addition.place:
        for task in document.keys() & set(task_names()) if addition.label == TASK else ():
            text = without(text, (task,))
        return with_table(text, (what,), {})
    values = {KIND: what}
    model = document.get("model") or {}
    entry = {"model": {**model, str(addition.place[1]): [values]}}
    if any(field.key == "name" for field in fields_at(entry, addition.place)):
        values["name"] = _free(model, str(addition.place[1]))
    return with_table(text, addition.place, values)


def _free(model: Mapping[str, Any], what: str) -> str:
    """Return a name that nothing in a model has.
    >>> _free({"body": [{"name": "body1"}]}, "body")
    'body2'
    """
    lists = [entries for entries in model.values() if isinstance(entries, list)]
    taken = {entry.get("name") for entries in lists for entry in entries if isinstance(entry, dict)}
    return next(name for number in count(1) if (name := f"{what}{number}") not in taken)
