"""What results on vibration have in common as datasets: arrays with units; names, numbers and provenance as JSON."""

import json
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy

import dalembert
from dalembert.contents import Contents
from dalembert.findings import findings_of, stored_findings

if TYPE_CHECKING:
    from xarray import Dataset

Dimensions = Mapping[str, tuple[str, ...]]
"""Names of arrays of a result, each with the names of its dimensions."""


def versions() -> dict[str, str]:
    """Versions of the programs that a result comes from."""
    return {"version": dalembert.__version__, "numpy": np.__version__, "scipy": scipy.__version__}


def stored(result: Any, dimensions: Dimensions, units: Mapping[str, str], names: Sequence[str]) -> Contents:
    """A :class:`~dalembert.results.Result` as arrays; as attributes its format, ``names`` and provenance."""
    variables = {
        name: (over, getattr(result, name), {"units": units[name]} if units.get(name) else {})
        for name, over in dimensions.items()
    }
    found = stored_findings(result.findings)
    facts = {
        "names": {name: getattr(result, name) for name in names},
        "provenance": dict(result.provenance),
        "findings": found,
    }
    attributes = {"format": result.FORMAT, **{key: json.dumps(own) for key, own in facts.items()}}
    return Contents(variables, attributes=attributes)


def fields_of(dataset: "Dataset", dimensions: Dimensions, truths: Sequence[str] = ()) -> dict[str, Any]:
    """Fields of a result that was :func:`stored`; the arrays ``truths`` are of truth values."""
    arrays = {name: dataset[name].values for name in dimensions if name in dataset}
    names = {name: _tuples(own) for name, own in json.loads(dataset.attrs["names"]).items()}
    provenance = json.loads(dataset.attrs["provenance"])
    found = findings_of(json.loads(dataset.attrs.get("findings", "[]")))
    facts = {"provenance": provenance, **({"findings": found} if found else {})}
    return {**arrays, **{name: arrays[name].astype(bool) for name in truths}, **names, **facts}


def _tuples(given: Any) -> Any:
    """The same with tuples in place of lists."""
    return tuple(map(_tuples, given)) if isinstance(given, list) else given
