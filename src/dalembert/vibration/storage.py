"""What results on vibration have in common as datasets: arrays with units; names, numbers and provenance as JSON."""

import json
from collections.abc import Callable, Mapping
from dataclasses import fields
from typing import TYPE_CHECKING, Any, NamedTuple, Self, get_args

import numpy as np
import scipy

import dalembert
from dalembert.contents import Contents
from dalembert.findings import Finding, findings_of, stored_findings
from dalembert.results import Result

if TYPE_CHECKING:
    from xarray import Dataset


class Over(NamedTuple):
    """How an array is stored: over which dimensions, and its unit, or what returns the unit for a result."""

    dimensions: tuple[str, ...]
    unit: str | Callable[[Any], str] = ""


class VibrationResult(Result):
    """A dataclass whose arrays are annotated with :class:`Over`; its other fields are names and numbers."""

    provenance: Mapping[str, Any]

    def contents(self) -> Contents:
        over, names = _split(type(self))
        units = {name: form.unit if isinstance(form.unit, str) else form.unit(self) for name, form in over.items()}
        variables = {
            name: (form.dimensions, getattr(self, name), {"units": units[name]} if units[name] else {})
            for name, form in over.items()
        }
        facts = {
            "names": {name: getattr(self, name) for name in names},
            "provenance": dict(self.provenance),
            "findings": stored_findings(self.findings),
        }
        return Contents(variables, attributes={"format": self.FORMAT} | {key: json.dumps(facts[key]) for key in facts})

    @classmethod
    def from_xarray(cls, dataset: "Dataset") -> Self:
        over, _ = _split(cls)
        arrays = {name: dataset[name].values for name in over if name in dataset}
        for name in ("converged", "fold"):  # NetCDF has no truth values
            if name in arrays:
                arrays[name] = arrays[name].astype(bool)
        facts = {name: _tuples(entry) for name, entry in json.loads(dataset.attrs["names"]).items()}
        findings = findings_of(json.loads(dataset.attrs["findings"]))
        facts |= {"provenance": json.loads(dataset.attrs["provenance"]), **({"findings": findings} if findings else {})}
        return cls(**arrays, **facts)


class ConvergedResult(VibrationResult):
    """A result whose points are marked where they are not converged."""

    converged: np.ndarray
    findings: tuple[Finding, ...]

    def __len__(self) -> int:
        return len(self.converged)

    @property
    def success(self) -> bool:
        """Whether every point is converged, and no finding is an error."""
        return bool(self.converged.all()) and all(finding.severity != "error" for finding in self.findings)

    @property
    def complete(self) -> bool:
        """Whether every point is converged, and a path came to its end inside its range."""
        codes = {finding.code for finding in self.findings}
        return bool(self.converged.all()) and codes.isdisjoint(("end-not-reached", "left-range"))

    @property
    def verdict(self) -> str:
        return self.VERDICTS[0 if self.complete else 1]


def versions() -> dict[str, str]:
    """Versions of the programs that a result comes from."""
    return {"version": dalembert.__version__, "numpy": np.__version__, "scipy": scipy.__version__}


def _split(kind: Any) -> tuple[dict[str, Over], list[str]]:
    hints = {part.name: part.type for part in fields(kind) if part.name not in ("provenance", "findings")}
    forms = {name: form for name, hint in hints.items() for form in get_args(hint)[1:] if isinstance(form, Over)}
    return forms, [name for name in hints if name not in forms]


def _tuples(entry: Any) -> Any:
    return tuple(map(_tuples, entry)) if isinstance(entry, list) else entry
