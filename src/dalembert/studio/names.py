"""Names that a study defines: what a key that refers to something may say."""

from collections.abc import Iterator, Mapping
from typing import Any

from dalembert.errors import DalembertError
from dalembert.study.catalogue import kinds_of
from dalembert.study.spaces import is_in_space
from dalembert.study.study import Study

Names = Mapping[str, tuple[str, ...]]
_POINTS = ("start", "end", "centre", "origin")


def names_in(document: Mapping[str, Any]) -> dict[str, tuple[str, ...]]:
    """Return the names that the tables of a document give, by what they are names of.

    Parameters
    ----------
    document : mapping
        As TOML reads it.

    Examples
    --------
    >>> bar = {"kind": "RigidBar", "name": "rod"}
    >>> names = names_in({"model": {"body": [bar]}, "parameters": {"drag": {}}})
    >>> names["point"], names["parameter"]
    (('ground', 'rod.start', 'rod.end', 'rod.centre'), ('drag',))
    """
    model = _table(document, "model")
    bodies = list(_entries(model, "body"))
    nodes = [str(mass["name"]) for mass in _entries(model, "mass")]
    parameters, constants = tuple(_table(document, "parameters")), tuple(_table(document, "constants"))
    return {
        "body": tuple(str(body["name"]) for body in bodies),
        "joint": tuple(str(joint["name"]) for joint in _entries(model, "joint")),
        "point": ("ground", *(f"{body['name']}.{point}" for body in bodies for point in _points(body, model))),
        "parameter": parameters,
        "constant": constants,
        "number": (*parameters, *constants),
        "input": tuple(_table(document, "inputs")),
        "node": tuple(nodes),
        "channel": tuple(_table(_table(document, "data"), "columns")),
    }


def channels_of(study: Study) -> tuple[str, ...]:
    """Return all channels of a study's mechanism; none of another model, or where it cannot be built."""
    if not study.has_system:
        return ()
    from dalembert.multibody.observe import channel_names

    try:
        return tuple(channel_names(study.system()))
    except DalembertError:
        return ()


def _points(body: Mapping[str, Any], model: Mapping[str, Any]) -> Iterator[str]:
    """Names of the points of a body, without nodes of flexible ones."""
    kinds = {
        kind.__name__: kind for kind in kinds_of("body", frozenset([str(body.get("kind"))]), space=is_in_space(model))
    }
    kind = kinds.get(str(body.get("kind")))
    named = [name for name in _POINTS if isinstance(getattr(kind, name, None), property)]
    yield from named or (("origin", "centre") if is_in_space(model) else ("centre",))
    yield from _table(body, "points")


def _entries(table: Mapping[str, Any], key: str) -> Iterator[Mapping[str, Any]]:
    """Tables of a list that have a name."""
    given = table.get(key)
    for entry in given if isinstance(given, list) else ():
        if isinstance(entry, dict) and "name" in entry:
            yield entry


def _table(table: Mapping[str, Any], key: str) -> Mapping[str, Any]:
    given = table.get(key)
    return given if isinstance(given, Mapping) else {}
