"""Measurements as variables of a dataset, and back."""

from typing import TYPE_CHECKING, Any

from dalembert.data import Measurements
from dalembert.forward.stored_coordinate import coordinate_of, stored_coordinate

if TYPE_CHECKING:
    from xarray import Dataset


def stored_data(data: Measurements) -> dict[str, Any]:
    """Variables over ``sample`` and ``channel``."""
    variables: dict[str, Any] = {"data": (("sample", "channel"), data.values, {"missing": data.missing})}
    if data.deviations is not None:
        variables["data_deviations"] = ("channel", data.deviations)
    if data.wraps:
        variables["data_wraps"] = ("channel", data.wrapping)
    if data.sampled is not None:
        variables["data_sampled"] = (("sample", "channel"), data.taken)
    return variables


def data_labels(data: Measurements) -> dict[str, Any]:
    """Coordinates ``channel`` and ``coordinate``."""
    return {"channel": ("channel", list(data.channels)), "coordinate": stored_coordinate(data.coordinate)}


def data_of(dataset: "Dataset") -> Measurements:
    """The measurements that are in a dataset."""
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
    )
