"""The result of following responses over frequency for several values of a parameter, such as a preload."""

import json
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

import numpy as np

from dalembert.contents import Contents
from dalembert.errors import InputError
from dalembert.results import Result
from dalembert.units import unit_of
from dalembert.vibration.paths.curve import FrequencyCurve, Peak

if TYPE_CHECKING:
    from xarray import Dataset


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
        """The largest response of each curve; NaN where there is none.

        Raises
        ------
        InputError
            For another kind, or a degree of freedom that was not observed.
        """
        found = (one.peak(dof, kind) if one is not None and one.converged.any() else None for one in self.curves)
        return tuple(peak or Peak(float("nan"), float("nan")) for peak in found)

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
        found = [one for one in self.curves if one is not None and one.converged.sum() > 1]
        if not found:
            raise InputError("no curve was found, so there is no envelope; see failures")
        ends = np.array([[one.frequencies[one.converged].min(), one.frequencies[one.converged].max()] for one in found])
        low, high = ends[:, 0].max(), ends[:, 1].min()
        every = np.unique(np.concatenate([one.frequencies[one.converged] for one in found]))
        frequencies = every[(low <= every) & (every <= high)]
        smallest, largest = np.full((2, len(frequencies)), np.nan)
        for one in found:
            sizes = one.amplitude(dof, kind)[one.converged]
            for rows, between in _passes(one.frequencies[one.converged], sizes, frequencies):
                smallest[rows] = np.fmin(smallest[rows], between)
                largest[rows] = np.fmax(largest[rows], between)
        return Envelope(frequencies, smallest, largest)

    @property
    def success(self) -> bool:
        """Whether every point of every curve is converged."""
        return all(curve is not None and curve.success for curve in self.curves)

    @property
    def status(self) -> str:
        """How many curves were found, in a sentence."""
        found = [curve for curve in self.curves if curve is not None]
        points, lost = sum(map(len, found)), sum(int((~curve.converged).sum()) for curve in found)
        text = f"{len(found)} of {len(self)} curves over {self.parameter}, {points - lost} of {points} points found"
        reasons = [
            f"; {self.parameter} = {value:.6g}: {reason}"
            for value, reason in zip(self.values, self.failures, strict=True)
            if reason
        ]
        return text + "".join(reasons[:3])

    def summary(self) -> str:
        """A few lines: what was found, and the peaks of the observed degrees of freedom over the parameter."""
        lines = [self.status]
        for dof in self.dofs[:4]:
            peaks, more = self.peaks(dof), 0.0 - self.reduction(dof)
            lines.append(f"{dof}: smallest peak at {self.parameter} = {_quantity(self.best(dof), self.unit)}")
            lines += [
                f"  {_quantity(value, self.unit)}: {_quantity(peak.amplitude, unit_of(dof))} at "
                f"{peak.frequency:.6g} Hz ({part:+.1%})"
                for value, peak, part in zip(self.values, peaks, more, strict=True)
            ]
        return "\n".join(lines)

    def contents(self) -> Contents:
        """Everything as arrays: the names and dimensions of each curve end in its number, ``_0``."""
        kept = {row: curve.contents() for row, curve in enumerate(self.curves) if curve is not None}
        variables: dict[str, Any] = {"values": ("value", self.values, {"units": self.unit})}
        for row, one in kept.items():
            for name, (over, *rest) in one.variables.items():
                variables[f"{name}_{row}"] = (tuple(f"{dimension}_{row}" for dimension in over), *rest)
        attributes = {
            "format": self.FORMAT,
            "parameter": self.parameter,
            "failures": json.dumps(self.failures),
            "curves": json.dumps({row: dict(one.attributes) for row, one in kept.items()}),
        }
        return Contents(variables, attributes=attributes)

    @classmethod
    def from_xarray(cls, dataset: "Dataset") -> "CurveFamily":
        """The family that :meth:`to_xarray` turned into a dataset."""
        kept = json.loads(dataset.attrs["curves"])
        given = dataset["values"]
        curves = tuple(_curve(dataset, str(row), kept.get(str(row))) for row in range(len(given)))
        failures = tuple(json.loads(dataset.attrs["failures"]))
        return cls(dataset.attrs["parameter"], given.attrs["units"], given.values, curves, failures)

    def _sizes(self, dof: str, kind: str) -> np.ndarray:
        return np.array([peak.amplitude for peak in self.peaks(dof, kind)])


def _curve(dataset: "Dataset", row: str, attributes: dict[str, Any] | None) -> FrequencyCurve | None:
    """The curve whose variables end in a number."""
    if attributes is None:
        return None
    own = dataset[[name for name in dataset if str(name).rpartition("_")[2] == row]]
    names = {name: str(name).rpartition("_")[0] for name in (*own, *own.dims)}
    return FrequencyCurve.from_xarray(own.rename(names).assign_attrs(attributes))


def _passes(along: np.ndarray, sizes: np.ndarray, frequencies: np.ndarray) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Rows of the frequencies on each part of a curve that does not turn, and its responses there."""
    turns = np.flatnonzero(np.diff(np.sign(np.diff(along)))) + 1
    for begin, end in zip(np.append(0, turns), np.append(turns, len(along) - 1), strict=True):
        part = slice(begin, end + 1)
        order = np.argsort(along[part])
        own, there = along[part][order], sizes[part][order]
        rows = np.flatnonzero((own[0] <= frequencies) & (frequencies <= own[-1]))
        yield rows, np.interp(frequencies[rows], own, there)


def _quantity(value: float, unit: str) -> str:
    return f"{value:.6g} {unit}".rstrip()
