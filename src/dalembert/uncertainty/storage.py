"""Propagations and comparisons as labelled datasets, and in NetCDF files."""

from typing import TYPE_CHECKING, Any

from dalembert.forward.stored_coordinate import coordinate_of, stored_coordinate
from dalembert.intervals import Box
from dalembert.results import facts_of, stored_facts, told_of
from dalembert.uncertainty.comparison import Comparison
from dalembert.uncertainty.propagation import Propagation

if TYPE_CHECKING:
    from xarray import Dataset


FACTS = ("method", "kind", "runs", "success", "status", "seconds")


def to_xarray(result: Propagation) -> "Dataset":
    """Dataset over sample coordinate, channel and parameter; what is not an array stands in attributes."""
    from xarray import Dataset

    bands = ("sample", "channel")
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
        "coordinate": stored_coordinate(result.coordinate),
    }
    attributes = stored_facts(result, FACTS, failures=result.failures, provenance=result.provenance)
    return Dataset(variables, coordinates, attributes)


def from_xarray(dataset: "Dataset") -> Propagation:
    """The propagation that :func:`to_xarray` turned into a dataset."""
    told = told_of(dataset)
    a = {str(name): variable.values for name, variable in dataset.variables.items()}
    return Propagation(
        coordinate=coordinate_of(dataset["coordinate"]),
        channels=tuple(map(str, a["channel"])),
        lower=a["lower"],
        upper=a["upper"],
        units=tuple(map(str, a["unit"])),
        box=Box(tuple(map(str, a["parameter"])), a["box_lower"], a["box_upper"]),
        **facts_of(Propagation, dataset, FACTS),
        error=a.get("error"),
        at_lower=a.get("at_lower"),
        at_upper=a.get("at_upper"),
        failures=tuple(told["failures"]),
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
    return stacked.assign_coords(method=[result.method for result in comparison.results]).assign_attrs(
        stored_facts(comparison, ("reference",), results=own, refused=comparison.refused)
    )


def comparison_from(dataset: "Dataset") -> Comparison:
    """The comparison that :func:`compared` turned into a dataset."""
    told = told_of(dataset)
    results = tuple(
        from_xarray(dataset.isel(method=place)[own["variables"]].assign_attrs(own["attributes"]))
        for place, own in enumerate(told["results"])
    )
    return Comparison(results, str(dataset.attrs["reference"]), tuple(map(tuple, told["refused"])))
