"""The parts of a joint response as variables of a dataset, and back."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from dalembert.forward import Coordinate
from dalembert.inverse.experiments.experiments import Part


def stored_parts(parts: Sequence[Part], rows: int) -> dict[str, Any]:
    """What each experiment's samples lie along, over ``experiment`` and ``sample``; NaN where it has none in a row."""
    if not parts:
        return {}
    along = np.full((len(parts), rows), np.nan)
    for own, part in zip(along, parts, strict=True):
        own[part.rows] = part.coordinate.values
    return {"experiment_coordinate": (("experiment", "sample"), along)}


def told_parts(parts: Sequence[Part]) -> list[dict[str, Any]]:
    """What of the parts is no array, for JSON."""
    return [
        {
            "name": part.name,
            "coordinate": [part.coordinate.name, part.coordinate.unit],
            "channels": list(part.channels),
            "columns": part.columns.tolist(),
        }
        for part in parts
    ]


def parts_of(arrays: Mapping[str, np.ndarray], told: Sequence[Mapping[str, Any]]) -> tuple[Part, ...]:
    """The parts again."""
    found = []
    for number, part in enumerate(told):
        along = arrays["experiment_coordinate"][number]
        rows = np.flatnonzero(np.isfinite(along))
        name, unit = part["coordinate"]
        columns = np.array(part["columns"], dtype=int)
        found.append(Part(part["name"], Coordinate(name, unit, along[rows]), tuple(part["channels"]), rows, columns))
    return tuple(found)
