"""A fit as a labelled dataset, and in a NetCDF file."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np

from dalembert.contents import Contents
from dalembert.inverse.experiments.explained import Explained
from dalembert.inverse.experiments.validation import Validation
from dalembert.inverse.fit.fit import Fit
from dalembert.inverse.fit.stored_correlated import correlated_of, stored_correlated, told_correlated
from dalembert.inverse.fit.stored_data import data_labels, data_of, stored_data
from dalembert.inverse.fit.stored_halves import halves_of, stored_halves
from dalembert.inverse.fit.stored_integration import integration_of, stored_integration
from dalembert.inverse.fit.stored_nodes import nodes_of, stored_nodes, told_nodes
from dalembert.inverse.fit.stored_parts import parts_of, stored_parts, told_parts
from dalembert.inverse.fit.stored_search import search_of, stored_ends, stored_search
from dalembert.parameters import Parameter, Parameters
from dalembert.results import facts_of, saved_findings, saved_outcome, stored_facts, told_of

if TYPE_CHECKING:
    from xarray import Dataset


FACTS = ("method", "success", "fitness", "simulations")


def contents_of(fit: Fit) -> Contents:
    """Arrays over parameter, sample coordinate, channel, step and start; what is not an array stands in attributes."""
    variables: dict[str, Any] = {
        "values": ("parameter", fit.values),
        "deviations": ("parameter", fit.deviations),
        "correlation": (("parameter", "parameter_"), fit.correlation),
        "singular_values": ("combination", fit.singular_values),
        "directions": (("combination", "parameter"), fit.directions),
        "response": (("sample", "channel"), fit.response),
        **stored_data(fit.data),
        "residuals": (("sample", "channel"), fit.residuals),
        "weights": (("sample", "channel"), fit.weights),
        **stored_search(fit.history, fit.starts, "parameter", len(fit.parameters)),
        **stored_parts(fit.parts, len(fit.response)),
        **stored_nodes(fit.nodes),
        **stored_correlated(fit.correlated),
        **stored_integration(fit.integration),
        **stored_halves(fit.halves),
    }
    if fit.validation is not None:
        variables["validation_weights"] = (("sample", "channel"), fit.validation.weights)
    coordinates = {
        "parameter": ("parameter", list(fit.parameters.names)),
        **data_labels(fit.data),
    }
    told = {
        "parameters": [asdict(item) for item in fit.parameters.declared],
        "ends": stored_ends(fit.starts),
        "provenance": fit.provenance,
        "samples": fit.history[-1].samples if fit.history else len(fit.response),
        "parts": told_parts(fit.parts),
        "nodes": told_nodes(fit.nodes),
        "correlated": told_correlated(fit.correlated),
        "integration": None if fit.integration is None else fit.integration.how,
        "halves_refitted": None if fit.halves is None else fit.halves.refitted,
        "validation": None
        if fit.validation is None
        else {
            "what": fit.validation.what,
            "misfit": fit.validation.misfit,
            "fitted": fit.validation.fitted,
            "explained": [asdict(item) for item in fit.validation.explained],
            "covered": fit.validation.covered,
        },
    }
    return Contents(variables, coordinates, stored_facts(fit, FACTS, **told))


def from_xarray(dataset: "Dataset") -> Fit:
    """The fit that is in a dataset."""
    told = told_of(dataset)
    a = {str(name): variable.values for name, variable in dataset.variables.items()}
    history, starts = search_of(a, told["ends"], told["samples"])
    validation = told["validation"]
    return Fit(
        parameters=Parameters(tuple(Parameter(**item) for item in told["parameters"])),
        values=a["values"],
        deviations=a["deviations"],
        correlation=a["correlation"],
        singular_values=a["singular_values"],
        directions=a["directions"],
        **facts_of(Fit, dataset, FACTS),
        response=a["response"],
        data=data_of(dataset),
        weights=a["weights"],
        history=history,
        starts=starts,
        provenance=told["provenance"],
        parts=parts_of(a, told["parts"]),
        validation=None if validation is None else _validation(a["validation_weights"], **validation),
        nodes=nodes_of(a, told.get("nodes")),
        outcome=saved_outcome(dataset),
        findings=saved_findings(dataset),
        correlated=correlated_of(a, told.get("correlated")),
        integration=integration_of(a, told.get("integration")),
        halves=halves_of(a, told.get("halves_refitted")),
    )


def _validation(weights: np.ndarray, explained: Sequence[Mapping[str, Any]] = (), **facts: Any) -> Validation:
    return Validation(weights=weights, explained=tuple(Explained(**item) for item in explained), **facts)
