"""Propagations and comparisons as labelled datasets, and in NetCDF files."""

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np

from dalembert.contents import Contents
from dalembert.forward.stored_coordinate import coordinate_of, stored_coordinate
from dalembert.intervals import Box
from dalembert.parameters import Parameter
from dalembert.results import facts_of, saved_findings, saved_outcome, stored_facts, told_of
from dalembert.uncertainty.comparison import Comparison
from dalembert.uncertainty.propagation import Propagation

if TYPE_CHECKING:
    from xarray import Dataset


FACTS = ("method", "kind", "runs", "success", "seconds")
FORMER_KINDS = {"enclosure": "enclosure of the surrogate"}
"""Names of kinds in files of former versions."""


def contents_of(result: Propagation) -> Contents:
    """Arrays over sample coordinate, channel and parameter; what is not an array stands in attributes."""
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
    held = [asdict(item) for item in result.fixed]
    attributes = stored_facts(result, FACTS, failures=result.failures, provenance=result.provenance, fixed=held)
    return Contents(variables, coordinates, attributes)


def from_xarray(dataset: "Dataset") -> Propagation:
    """The propagation that is in a dataset."""
    told, facts = told_of(dataset), facts_of(Propagation, dataset, FACTS)
    a = {str(name): variable.values for name, variable in dataset.variables.items()}
    return Propagation(
        coordinate=coordinate_of(dataset["coordinate"]),
        channels=tuple(map(str, a["channel"])),
        lower=a["lower"],
        upper=a["upper"],
        units=tuple(map(str, a["unit"])),
        box=Box(tuple(map(str, a["parameter"])), a["box_lower"], a["box_upper"]),
        **{**facts, "kind": FORMER_KINDS.get(facts["kind"], facts["kind"])},
        error=a.get("error"),
        at_lower=a.get("at_lower"),
        at_upper=a.get("at_upper"),
        failures=tuple(told["failures"]),
        provenance=told["provenance"],
        outcome=saved_outcome(dataset),
        findings=saved_findings(dataset),
        fixed=tuple(Parameter(**item) for item in told.get("fixed", ())),
    )


def compared(comparison: Comparison) -> Contents:
    """Arrays of all results over the dimension ``method``; what a method does not know is NaN."""
    parts = [contents_of(result) for result in comparison.results]
    own = [{"attributes": part.attributes, "variables": list(part.variables)} for part in parts]
    variables = {}
    for name, (over, like, *_) in {name: entry for part in parts for name, entry in part.variables.items()}.items():
        missing = ((), np.full(np.shape(like), np.nan))
        over = (over,) if isinstance(over, str) else over
        variables[name] = ("method", *over), np.stack([part.variables.get(name, missing)[1] for part in parts])
    coordinates = {**parts[0].coordinates, "method": ("method", [result.method for result in comparison.results])}
    facts = stored_facts(comparison, ("reference",), results=own, refused=comparison.refused)
    return Contents(variables, coordinates, facts)


def comparison_from(dataset: "Dataset") -> Comparison:
    """The comparison that :func:`compared` turned into a dataset."""
    told = told_of(dataset)
    results = tuple(
        from_xarray(dataset.isel(method=place)[own["variables"]].assign_attrs(own["attributes"]))
        for place, own in enumerate(told["results"])
    )
    return Comparison(results, str(dataset.attrs["reference"]), tuple(map(tuple, told["refused"])))
