"""Responses over frequency for several values of a parameter, as one result."""

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

import numpy as np

from dalembert.contents import Contents
from dalembert.errors import InputError
from dalembert.findings import Finding
from dalembert.results import Result
from dalembert.tables import Table, cells, counted, in_words, labelled, marks, noted, percent, shown
from dalembert.units import unit_of
from dalembert.vibration.paths.curve import FrequencyCurve, Peak
from dalembert.vibration.paths.focus import Look

if TYPE_CHECKING:
    from xarray import Dataset

ON_HARMONICS = {"few-harmonics": "error", "unchecked-harmonics": "harmonics", "harmonics-chosen": "harmonics"}
"""Codes of findings on chosen harmonics, and the value by which one is worse than another."""


class Envelope(NamedTuple):
    """The smallest and the largest response of all curves: frequencies in Hz, amplitudes, each (points,)."""

    frequencies: np.ndarray
    smallest: np.ndarray
    largest: np.ndarray


@dataclass(frozen=True, eq=False)
class CurveFamily(Result):
    """Responses over frequency for several values of a parameter, as :func:`frequency_responses` returns them.

    Parameters
    ----------
    parameter, unit : str
        What is varied.
    values : array, shape (values,)
    curves : tuple of FrequencyCurve or None
        None where there is none.
    failures : tuple of str or None
        Why there is none.
    """

    FORMAT: ClassVar[str] = "dalembert curve family 1"

    parameter: str
    unit: str
    values: np.ndarray
    curves: tuple[FrequencyCurve | None, ...]
    failures: tuple[str | None, ...]

    def __len__(self) -> int:
        return len(self.values)

    @property
    def dofs(self) -> tuple[str, ...]:
        """Names of the observed degrees of freedom."""
        return next((curve.dofs for curve in self.curves if curve is not None), ())

    def peaks(self, dof: str, kind: str = "peak") -> tuple[Peak, ...]:
        """The largest amplitude of a degree of freedom on each curve; NaN if no point of the curve converged.

        Parameters
        ----------
        dof : str
        kind : str
            ``"peak"``, ``"rms"``, or ``"harmonic 1"`` and so on.

        Raises
        ------
        InputError
            For an unknown kind, or a degree of freedom that was not observed.
        """
        missing = Peak(float("nan"), float("nan"))
        return tuple(
            curve.peak(dof, kind) if curve is not None and curve.converged.any() else missing for curve in self.curves
        )

    def best(self, dof: str, kind: str = "peak") -> float:
        """Return the value whose curve has the smallest peak.

        Raises
        ------
        InputError
            As :meth:`peaks`, and where no curve was found.
        """
        sizes = self._sizes(dof, kind)
        if np.isnan(sizes).all():
            raise InputError(f"no curve was found, so no value of {self.parameter} is the best; see failures")
        return float(self.values[np.nanargmin(sizes)])

    def reduction(self, dof: str, kind: str = "peak") -> np.ndarray:
        """Reduction of each peak relative to that of the first value, (values,): 1 - peak / first peak.

        NaN where there is no first peak, or no motion at it.
        """
        sizes = self._sizes(dof, kind)
        return 1 - sizes / sizes[0] if sizes[0] > 0 else np.full(len(sizes), np.nan)

    def envelope(self, dof: str, kind: str = "peak") -> Envelope:
        """The smallest and the largest response of all curves at each frequency that all of them have.

        A curve that passes a frequency several times, past folds, counts with all its responses there. Between points
        curves are straight.
        """
        curves = [curve for curve in self.curves if curve is not None and curve.converged.sum() > 1]
        if not curves:
            raise InputError("no curve was found, so there is no envelope; see failures")
        places = [curve.frequencies[curve.converged] for curve in curves]
        low, high = max(each.min() for each in places), min(each.max() for each in places)
        every = np.unique(np.concatenate(places))
        frequencies = every[(low <= every) & (every <= high)]
        smallest, largest = np.full((2, len(frequencies)), np.nan)
        for curve, along in zip(curves, places, strict=True):
            sizes = curve.amplitude(dof, kind)[curve.converged]
            for rows, between in _passes(along, sizes, frequencies):
                smallest[rows] = np.fmin(smallest[rows], between)
                largest[rows] = np.fmax(largest[rows], between)
        return Envelope(frequencies, smallest, largest)

    @property
    def success(self) -> bool:
        """Whether every point of every curve is converged."""
        return all(curve is not None and curve.success for curve in self.curves)

    @property
    def status(self) -> str:
        """How many curves there are, in a sentence."""
        curves = [curve for curve in self.curves if curve is not None]
        points, lost = sum(map(len, curves)), sum(int((~curve.converged).sum()) for curve in curves)
        text = f"{len(curves)} of {len(self)} curves over {self.parameter}, {points - lost} of {points} points found"
        reasons = [
            f"; {self.parameter} = {value:.6g}: {reason}"
            for value, reason in zip(self.values, self.failures, strict=True)
            if reason
        ]
        return text + "".join(reasons[:3]) + "."

    @property
    def findings(self) -> tuple[Finding, ...]:
        """The worst findings of all curves on automatic numbers of harmonics, with the parameter's value there."""
        findings = [
            (value, finding)
            for value, curve in zip(self.values.tolist(), self.curves, strict=True)
            for finding in (() if curve is None else curve.findings)
        ]
        worst = []
        for code, size in ON_HARMONICS.items():
            of_code = [(value, finding) for value, finding in findings if finding.code == code]
            if of_code:
                value, finding = max(of_code, key=lambda entry: entry[1].values[size])
                message = f"{self.parameter} = {_quantity(value, self.unit)}: {finding.message}"
                worst.append(replace(finding, values={**finding.values, "value": value}, message=message))
        return tuple(worst)

    @property
    def title(self) -> str:
        return f"Forced response over {self.parameter}"

    def foremost(self, kind: str = "peak") -> tuple[str, ...]:
        """The degree of freedom that moves most in the first curve there is; none where there is none."""
        curves = (curve for curve in self.curves if curve is not None and curve.converged.any())
        return next(((Look.of(curve, kind=kind).dof,) for curve in curves), ())

    def facts(self, dofs: Sequence[str] = (), kind: str = "peak") -> dict[str, str]:
        """Return the value of the smallest peak of the first of ``dofs``, or of the one that moves most."""
        facts = {"values": counted(len(self))}
        for dof in tuple(dofs or self.foremost(kind))[:1]:
            best = self.best_row(dof, kind)
            gain = float(self.reduction(dof, kind)[best])
            facts[f"{self.parameter} of the smallest peak"] = _quantity(self.values[best], self.unit)
            facts[f"peak of {dof} there"] = in_words(self.peaks(dof, kind)[best].amplitude, unit_of(dof), 5)
            facts |= {f"reduction from {_quantity(self.values[0], self.unit)}": percent(gain)} if gain > 0 else {}
        return facts

    def tables(self, dofs: Sequence[str] = (), kind: str = "peak") -> tuple[Table, ...]:
        """Return the peaks of each of ``dofs``, or of the one that moves most."""
        tables = []
        for place, dof in enumerate(dofs or self.foremost(kind), start=1):
            peaks = self.peaks(dof, kind)
            columns = {
                labelled(self.parameter, self.unit): self.values,
                labelled("peak", unit_of(dof)): [peak.amplitude for peak in peaks],
                "at frequency (Hz)": [peak.frequency for peak in peaks],
                "change from the first (%)": cells(-100 * np.asarray(self.reduction(dof, kind)), 4),
                "points found": [
                    "" if curve is None else f"{int(curve.converged.sum())} of {len(curve.converged)}"
                    for curve in self.curves
                ],
                "note": marks(reason or "" for reason in self.failures),
            }
            tables.append(noted(Table.of(f"family-{place}", f"Peaks of {dof}", columns)))
        return tuple(tables)

    def best_row(self, dof: str, kind: str = "peak") -> int:
        """Number of the curve with the smallest peak; :meth:`best` is its value."""
        return int(np.flatnonzero(np.asarray(self.values) == self.best(dof, kind))[0])

    def contents(self) -> Contents:
        """Everything as arrays: the names and dimensions of each curve end in its number, ``_0``."""
        kept = {row: curve.contents() for row, curve in enumerate(self.curves) if curve is not None}
        variables: dict[str, Any] = {"values": ("value", self.values, {"units": self.unit})}
        for row, contents in kept.items():
            for name, (over, *rest) in contents.variables.items():
                variables[f"{name}_{row}"] = (tuple(f"{dimension}_{row}" for dimension in over), *rest)
        attributes = {
            "format": self.FORMAT,
            "parameter": self.parameter,
            "failures": json.dumps(self.failures),
            "curves": json.dumps({row: dict(contents.attributes) for row, contents in kept.items()}),
        }
        return Contents(variables, attributes=attributes)

    @classmethod
    def from_xarray(cls, dataset: "Dataset") -> "CurveFamily":
        """The family that :meth:`to_xarray` turned into a dataset."""
        kept = json.loads(dataset.attrs["curves"])
        values = dataset["values"]
        curves = tuple(_curve(dataset, str(row), kept.get(str(row))) for row in range(len(values)))
        failures = tuple(json.loads(dataset.attrs["failures"]))
        return cls(dataset.attrs["parameter"], values.attrs["units"], values.values, curves, failures)

    def _sizes(self, dof: str, kind: str) -> np.ndarray:
        return np.array([peak.amplitude for peak in self.peaks(dof, kind)])


def _curve(dataset: "Dataset", row: str, attributes: dict[str, Any] | None) -> FrequencyCurve | None:
    """The curve whose variables end in a number."""
    if attributes is None:
        return None
    part = dataset[[name for name in dataset if str(name).rpartition("_")[2] == row]]
    names = {name: str(name).rpartition("_")[0] for name in (*part, *part.dims)}
    return FrequencyCurve.from_xarray(part.rename(names).assign_attrs(attributes))


def _passes(along: np.ndarray, sizes: np.ndarray, frequencies: np.ndarray) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Rows of the frequencies on each part of a curve that does not turn, and its responses there."""
    turns = np.flatnonzero(np.diff(np.sign(np.diff(along)))) + 1
    for begin, end in zip(np.append(0, turns), np.append(turns, len(along) - 1), strict=True):
        part = slice(begin, end + 1)
        order = np.argsort(along[part])
        ascending, amplitudes = along[part][order], sizes[part][order]
        rows = np.flatnonzero((ascending[0] <= frequencies) & (frequencies <= ascending[-1]))
        yield rows, np.interp(frequencies[rows], ascending, amplitudes)


def _quantity(value: float, unit: str) -> str:
    return f"{shown(float(value))} {unit}".rstrip()
