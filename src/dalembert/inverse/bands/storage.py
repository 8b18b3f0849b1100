"""An identification from bands as a labelled dataset, and in a NetCDF file."""

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np

from dalembert.contents import Contents
from dalembert.data import Bands
from dalembert.forward.stored_coordinate import coordinate_of, stored_coordinate
from dalembert.intervals import Box
from dalembert.inverse.bands.band_fit import BandFit
from dalembert.inverse.fit.stored_search import search_of, stored_ends, stored_search
from dalembert.parameters import Parameter, Parameters
from dalembert.results import facts_of, saved_findings, saved_outcome, stored_facts, told_of

if TYPE_CHECKING:
    from xarray import Dataset


TABLES = ("weights", "lower", "upper", "error")
"""Fields of shape (samples, channels)."""

FACTS = ("method", "success", "fitness", "simulations", "seconds")
ARRAYS = ("middle_deviations", "radius_deviations", "correlation", "singular_values", "directions", *TABLES)


def contents_of(fit: BandFit) -> Contents:
    """Arrays over parameter, unknown, sample, channel, step and start; other facts are attributes."""
    variables: dict[str, Any] = {
        "box_lower": ("parameter", fit.box.lower),
        "box_upper": ("parameter", fit.box.upper),
        "middle_deviations": ("parameter", fit.middle_deviations),
        "radius_deviations": ("parameter", fit.radius_deviations),
        "correlation": (("unknown", "unknown_"), fit.correlation),
        "singular_values": ("combination", fit.singular_values),
        "directions": (("combination", "unknown"), fit.directions),
        "given_lower": (("sample", "channel"), fit.bands.lower),
        "given_upper": (("sample", "channel"), fit.bands.upper),
        **{name: (("sample", "channel"), np.array(getattr(fit, name))) for name in TABLES},
        **stored_search(fit.history, fit.starts, "unknown", len(fit.unknowns)),
    }
    if fit.checked_lower is not None and fit.checked_upper is not None:
        variables["checked_lower"] = (("sample", "channel"), fit.checked_lower)
        variables["checked_upper"] = (("sample", "channel"), fit.checked_upper)
    coordinates = {
        "parameter": ("parameter", list(fit.parameters.names)),
        "unknown": ("unknown", list(fit.unknowns)),
        "channel": ("channel", list(fit.bands.channels)),
        "coordinate": stored_coordinate(fit.bands.coordinate),
    }
    told = {
        "parameters": [asdict(item) for item in fit.parameters.declared],
        "intervals": fit.intervals,
        "checked_fitness": fit.checked_fitness,
        "ends": stored_ends(fit.starts),
        "provenance": fit.provenance,
    }
    return Contents(variables, coordinates, stored_facts(fit, FACTS, **told))


def from_xarray(dataset: "Dataset") -> BandFit:
    """The result that is in a dataset."""
    told = told_of(dataset)
    a = {str(name): variable.values for name, variable in dataset.variables.items()}
    along = coordinate_of(dataset["coordinate"])
    history, starts = search_of(a, told["ends"], len(along.values))
    parameters = Parameters(tuple(Parameter(**item) for item in told["parameters"]))
    return BandFit(
        parameters=parameters,
        intervals=tuple(told["intervals"]),
        box=Box(parameters.names, a["box_lower"], a["box_upper"]),
        unknowns=tuple(map(str, a["unknown"])),
        **{name: a[name] for name in ARRAYS},
        **facts_of(BandFit, dataset, FACTS),
        bands=Bands(along, tuple(map(str, a["channel"])), a["given_lower"], a["given_upper"]),
        checked_lower=a.get("checked_lower"),
        checked_upper=a.get("checked_upper"),
        checked_fitness=told["checked_fitness"],
        history=history,
        starts=starts,
        provenance=told["provenance"],
        outcome=saved_outcome(dataset),
        findings=saved_findings(dataset),
    )
