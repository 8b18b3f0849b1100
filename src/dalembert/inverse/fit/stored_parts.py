"""The parts of a joint response as variables of a dataset, and back."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from dalembert.forward import Coordinate
from dalembert.inverse.experiments.experiment import Part
from dalembert.stored_fields import Source, Store


class StoredParts:
    """What each experiment's samples lie along, over ``experiment`` and ``sample``; NaN where it has none in a row."""

    def store(self, to: Store, settings: dict[str, Any], name: str, value: Sequence[Part]) -> None:
        settings[name] = [
            {
                "name": part.name,
                "coordinate": [part.coordinate.name, part.coordinate.unit],
                "channels": list(part.channels),
                "columns": part.columns.tolist(),
            }
            for part in value
        ]
        if value:
            along = np.full((len(value), len(to.coordinates["coordinate"][1])), np.nan)
            for own, part in zip(along, value, strict=True):
                own[part.rows] = part.coordinate.values
            to.variables["experiment_coordinate"] = (("experiment", "sample"), along)

    def load(self, source: Source, settings: Mapping[str, Any], name: str) -> tuple[Part, ...]:
        found = []
        for number, part in enumerate(settings[name]):
            along = source.arrays["experiment_coordinate"][number]
            rows = np.flatnonzero(np.isfinite(along))
            label, unit = part["coordinate"]
            coordinate = Coordinate(label, unit, along[rows])
            columns = np.array(part["columns"], dtype=int)
            found.append(Part(part["name"], coordinate, tuple(part["channels"]), rows, columns))
        return tuple(found)
