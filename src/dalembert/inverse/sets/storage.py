"""A set of consistent parameters as a labelled dataset, and in a NetCDF file."""

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np

from dalembert.contents import Contents
from dalembert.intervals import Box
from dalembert.inverse.fit.stored_data import data_labels, data_of, stored_data
from dalembert.inverse.sets.parameter_set import ParameterSet
from dalembert.parameters import Parameter, Parameters
from dalembert.results import facts_of, saved_findings, saved_outcome, stored_facts, told_of

if TYPE_CHECKING:
    from xarray import Dataset


FACTS = ("success", "resolution", "runs", "seconds")


def contents_of(found: ParameterSet) -> Contents:
    """Arrays over parameter, side, box, sample and channel; other facts are attributes."""
    variables: dict[str, Any] = {
        **stored_data(found.data),
        "error": (("sample", "channel"), np.array(found.error)),
        "surrogate_error": (("sample", "channel"), np.array(found.surrogate_error)),
        "boxes": (("box", "side", "parameter"), np.concatenate([found.inside, found.boundary])),
        "is_inside": ("box", np.arange(len(found.inside) + len(found.boundary)) < len(found.inside)),
    }
    for name, box in (("outer", found.outer), ("inner", found.inner)):
        if box is not None:
            variables[name] = (("side", "parameter"), np.stack([box.lower, box.upper]))
    coordinates = {
        "parameter": ("parameter", list(found.parameters.names)),
        "side": ("side", ["lower", "upper"]),
        **data_labels(found.data),
    }
    told = {"parameters": [asdict(item) for item in found.parameters.declared], "provenance": found.provenance}
    return Contents(variables, coordinates, stored_facts(found, FACTS, **told))


def from_xarray(dataset: "Dataset") -> ParameterSet:
    """The result that is in a dataset."""
    told = told_of(dataset)
    a = {str(name): variable.values for name, variable in dataset.variables.items()}
    parameters = Parameters(tuple(Parameter(**item) for item in told["parameters"]))
    is_inside = a["is_inside"].astype(bool)
    boxes = {name: Box(parameters.names, *a[name]) if name in a else None for name in ("outer", "inner")}
    return ParameterSet(
        parameters=parameters,
        data=data_of(dataset),
        error=a["error"],
        inside=a["boxes"][is_inside],
        boundary=a["boxes"][~is_inside],
        outer=boxes["outer"],
        inner=boxes["inner"],
        surrogate_error=a["surrogate_error"],
        **facts_of(ParameterSet, dataset, FACTS),
        provenance=told["provenance"],
        outcome=saved_outcome(dataset),
        findings=saved_findings(dataset),
    )
