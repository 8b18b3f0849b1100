"""Names that a study defines: what a key that refers to something may say."""

from collections.abc import Iterator, Mapping
from typing import Any

from dalembert.studio.editor.draft import Draft
from dalembert.studio.editor.fields import fields_at

Names = Mapping[str, tuple[str, ...]]


def names_in(document: Mapping[str, Any]) -> dict[str, tuple[str, ...]]:
    """Return the names that the tables of a document give, by what they are names of, such as ``"point"``."""
    model = _table(document, "model")
    bodies = dict(_entries(model, "body"))
    parameters, constants = tuple(_table(document, "parameters")), tuple(_table(document, "constants"))
    return {
        "body": tuple(str(body["name"]) for body in bodies.values()),
        "joint": tuple(str(joint["name"]) for _, joint in _entries(model, "joint")),
        "point": (
            "ground",
            *(
                f"{body['name']}.{point}"
                for number, body in bodies.items()
                for point in _points(document, number, body)
            ),
        ),
        "parameter": parameters,
        "constant": constants,
        "number": (*parameters, *constants),
        "input": tuple(_table(document, "inputs")),
        "node": tuple(str(mass["name"]) for _, mass in _entries(model, "mass")),
        "channel": tuple(_table(_table(document, "data"), "columns")),
    }


class Channels:
    """All channels of the last study of a draft that had no mistakes."""

    def __init__(self, draft: Draft) -> None:
        self._draft = draft

    @property
    def known(self) -> Names:
        """The channels, as names of ``"channel"``."""
        return {"channel": () if self._draft.good is None else self._draft.good.channels}

    async def __call__(self) -> Names:
        """Return the channels."""
        return self.known


def _points(document: Mapping[str, Any], number: int, body: Mapping[str, Any]) -> Iterator[str]:
    """Names of the points of a body by its keys, so that nothing is imported; without nodes of flexible ones."""
    keys = {field.key for field in fields_at(document, ("model", "body", number))}
    yield from ("start", "end") if "start" in keys else ()
    yield from () if "elements" in keys else ("centre",)
    yield from ("origin",) if "orientation" in keys else ()
    yield from _table(body, "points")


def _entries(table: Mapping[str, Any], key: str) -> Iterator[tuple[int, Mapping[str, Any]]]:
    """Tables of a list that have a name, with their numbers."""
    entries = table.get(key)
    for number, entry in enumerate(entries if isinstance(entries, list) else ()):
        if isinstance(entry, dict) and "name" in entry:
            yield number, entry


def _table(table: Mapping[str, Any], key: str) -> Mapping[str, Any]:
    entry = table.get(key)
    return entry if isinstance(entry, Mapping) else {}
