"""Measurements, bands and the parts of a joint response as variables of a dataset, and back."""

import json
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np

from dalembert.data import Bands, Measurements
from dalembert.forward import Coordinate
from dalembert.forward.stored_coordinate import coordinate_of, stored_coordinate
from dalembert.inverse.experiments.experiment import ExperimentPart
from dalembert.stored_fields import Source, Store

if TYPE_CHECKING:
    from xarray import Dataset


class _Data:
    """Measurements as variables over ``sample`` and ``channel``."""

    def store(self, to: Store, settings: dict[str, Any], name: str, value: Measurements) -> None:
        to.variables.update(_variables(value))
        to.coordinates["channel"] = ("channel", list(value.channels))
        to.coordinates["coordinate"] = stored_coordinate(value.coordinate)

    def load(self, source: Source, settings: Mapping[str, Any], name: str) -> Measurements:
        return _measurements(source.dataset)


class _Measured:
    """Measurements whose samples and channels differ from those of the result; None as nothing."""

    def store(self, to: Store, settings: dict[str, Any], name: str, value: Measurements | None) -> None:
        if value is None:
            return
        for variable, (over, *rest) in _variables(value).items():
            over = over if isinstance(over, tuple) else (over,)
            to.variables[variable] = (tuple(f"measured_{dimension}" for dimension in over), *rest)
        to.variables["measured_at"] = stored_coordinate(value.coordinate, "measured_sample")
        settings["measured"] = value.channels

    def load(self, source: Source, settings: Mapping[str, Any], name: str) -> Measurements | None:
        if "measured" not in settings:
            return None
        dataset = source.dataset.drop_vars(["channel", "coordinate"]).drop_dims(["sample", "channel"])
        dataset = dataset.rename({"measured_sample": "sample", "measured_channel": "channel"})
        dataset = dataset.rename_vars({"measured_at": "coordinate"}).assign_coords(channel=settings["measured"])
        return _measurements(dataset)


class _Bands:
    """Bands as variables over ``sample`` and ``channel``."""

    def store(self, to: Store, settings: dict[str, Any], name: str, value: Bands) -> None:
        over = ("sample", "channel")
        to.variables.update({"given_lower": (over, value.lower), "given_upper": (over, value.upper)})
        to.coordinates["channel"] = ("channel", list(value.channels))
        to.coordinates["coordinate"] = stored_coordinate(value.coordinate)

    def load(self, source: Source, settings: Mapping[str, Any], name: str) -> Bands:
        along, names = coordinate_of(source.dataset["coordinate"]), tuple(map(str, source.arrays["channel"]))
        return Bands(along, names, source.arrays["given_lower"], source.arrays["given_upper"])


class StoredParts:
    """What each experiment's samples lie along, over ``experiment`` and ``sample``; NaN where it has none in a row."""

    def store(self, to: Store, settings: dict[str, Any], name: str, value: Sequence[ExperimentPart]) -> None:
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
            for part_values, part in zip(along, value, strict=True):
                part_values[part.rows] = part.coordinate.values
            to.variables["experiment_coordinate"] = (("experiment", "sample"), along)

    def load(self, source: Source, settings: Mapping[str, Any], name: str) -> tuple[ExperimentPart, ...]:
        parts = []
        for number, part in enumerate(settings[name]):
            along = source.arrays["experiment_coordinate"][number]
            rows = np.flatnonzero(np.isfinite(along))
            label, unit = part["coordinate"]
            coordinate = Coordinate(label, unit, along[rows])
            columns = np.array(part["columns"], dtype=int)
            parts.append(ExperimentPart(part["name"], coordinate, tuple(part["channels"]), rows, columns))
        return tuple(parts)


StoredData = Annotated[Measurements, _Data()]
StoredMeasured = Annotated[Measurements | None, _Measured()]
StoredBands = Annotated[Bands, _Bands()]


def _variables(data: Measurements) -> dict[str, tuple]:
    variables: dict[str, tuple] = {"data": (("sample", "channel"), data.values, {"missing": data.missing})}
    if data.deviations is not None:
        variables["data_deviations"] = ("channel", data.deviations)
    if data.wraps:
        variables["data_wraps"] = ("channel", data.wrapping)
    if data.source_units:
        variables["data"][2]["units"] = json.dumps(dict(data.source_units))
    if data.sampled is not None:
        variables["data_sampled"] = (("sample", "channel"), data.taken)
    return variables


def _measurements(dataset: "Dataset") -> Measurements:
    channels = tuple(map(str, dataset["channel"].values))
    wraps = dataset["data_wraps"].values.astype(bool) if "data_wraps" in dataset else [False] * len(channels)
    return Measurements(
        coordinate_of(dataset["coordinate"]),
        channels,
        dataset["data"].values,
        dataset["data_deviations"].values if "data_deviations" in dataset else None,
        dataset["data"].attrs.get("missing", "refuse"),
        tuple(name for name, wrap in zip(channels, wraps, strict=True) if wrap),
        sampled=dataset["data_sampled"].values.astype(bool) if "data_sampled" in dataset else None,
        source_units=json.loads(dataset["data"].attrs.get("units", "{}")),
    )
