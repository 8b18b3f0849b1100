"""Propagations and comparisons as labelled datasets, and in NetCDF files."""

import json
from typing import TYPE_CHECKING, Any

from dalembert.forward import Coordinate
from dalembert.intervals import Box
from dalembert.uncertainty.comparison import Comparison
from dalembert.uncertainty.propagation import Propagation

if TYPE_CHECKING:
    from xarray import Dataset


def to_xarray(result: Propagation) -> "Dataset":
    """Dataset over sample coordinate, channel and parameter; what is not an array stands in attributes."""
    from xarray import Dataset

    along, bands = result.coordinate, ("sample", "channel")
    variables: dict[str, Any] = {
        "lower": (bands, result.lower),
        "upper": (bands, result.upper),
        "box_lower": ("parameter", result.box.lower),
        "box_upper": ("parameter", result.box.upper),
    }
    if result.error is not None:
        variables["error"] = (bands, result.error)
    for name, at in (("at_lower", result.at_lower), ("at_upper", result.at_upper)):
        if at is not None:
            variables[name] = ((*bands, "parameter"), at)
    coordinates = {
        "parameter": ("parameter", list(result.box.names)),
        "channel": ("channel", list(result.channels)),
        "unit": ("channel", list(result.units)),
        "coordinate": ("sample", along.values, {"long_name": along.name, "units": along.unit}),
    }
    attributes = {
        "format": Propagation.FORMAT,
        "method": result.method,
        "kind": result.kind,
        "runs": result.runs,
        "success": int(result.success),
        "status": result.status,
        "seconds": result.seconds,
        "settings": json.dumps({"failures": result.failures, "provenance": result.provenance}, sort_keys=True),
    }
    return Dataset(variables, coordinates, attributes)


def from_xarray(dataset: "Dataset") -> Propagation:
    """The propagation that :func:`to_xarray` turned into a dataset."""
    told = json.loads(dataset.attrs["settings"])
    a = {str(name): variable.values for name, variable in dataset.variables.items()}
    along = dataset["coordinate"]
    return Propagation(
        coordinate=Coordinate(along.attrs["long_name"], along.attrs["units"], a["coordinate"]),
        channels=tuple(map(str, a["channel"])),
        lower=a["lower"],
        upper=a["upper"],
        units=tuple(map(str, a["unit"])),
        box=Box(tuple(map(str, a["parameter"])), a["box_lower"], a["box_upper"]),
        method=str(dataset.attrs["method"]),
        kind=str(dataset.attrs["kind"]),
        runs=int(dataset.attrs["runs"]),
        error=a.get("error"),
        at_lower=a.get("at_lower"),
        at_upper=a.get("at_upper"),
        failures=tuple(told["failures"]),
        success=bool(dataset.attrs["success"]),
        status=str(dataset.attrs["status"]),
        seconds=float(dataset.attrs["seconds"]),
        provenance=told["provenance"],
    )


def compared(comparison: Comparison) -> "Dataset":
    """Dataset of all results over the dimension ``method``; what a method does not know is NaN."""
    from xarray import concat

    parts = [to_xarray(result) for result in comparison.results]
    own = [{"attributes": part.attrs, "variables": [str(name) for name in part.data_vars]} for part in parts]
    stacked = concat(
        parts, "method", data_vars="all", coords="minimal", compat="override", join="override", combine_attrs="drop"
    )
    told = {"results": own, "refused": comparison.refused}
    return stacked.assign_coords(method=[result.method for result in comparison.results]).assign_attrs(
        format=Comparison.FORMAT,
        reference=comparison.reference,
        settings=json.dumps(told, sort_keys=True),
    )


def comparison_from(dataset: "Dataset") -> Comparison:
    """The comparison that :func:`compared` turned into a dataset."""
    told = json.loads(dataset.attrs["settings"])
    results = tuple(
        from_xarray(dataset.isel(method=place)[own["variables"]].assign_attrs(own["attributes"]))
        for place, own in enumerate(told["results"])
    )
    return Comparison(results, str(dataset.attrs["reference"]), tuple(map(tuple, told["refused"])))
