"""The peak of a response over a parameter, as a result."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np

from dalembert.errors import InputError
from dalembert.findings import Finding
from dalembert.units import unit_of
from dalembert.vibration.storage import ConvergedResult, Over

Values = Annotated[np.ndarray, Over(("value",))]


@dataclass(frozen=True, eq=False)
class ResonanceTrack(ConvergedResult):
    """The peak of a response over a parameter, as :func:`track_resonance` returns it.

    Parameters
    ----------
    parameter, unit : str
    dof, kind : str
        Degree of freedom, and kind of amplitude, whose peak was followed.
    values : array, shape (values,)
        Of the parameter.
    frequencies : array, shape (values,)
        Hz; NaN where the peak was not found.
    amplitudes : array, shape (values,)
        m.
    solves : array of int, shape (values,)
        Points that were balanced on the way.
    converged : array of bool, shape (values,)
    provenance : mapping
        Versions, method, settings.
    findings : tuple of Finding
        ``"harmonics-chosen"`` or ``"few-harmonics"`` where the number of harmonics was chosen.
    """

    FORMAT: ClassVar[str] = "dalembert resonance track 1"

    parameter: str
    unit: str
    dof: str
    kind: str
    values: Annotated[np.ndarray, Over(("value",), lambda track: track.unit)]
    frequencies: Annotated[np.ndarray, Over(("value",), "Hz")]
    amplitudes: Annotated[np.ndarray, Over(("value",), lambda track: unit_of(track.dof))]
    solves: Values
    converged: Values
    provenance: Mapping[str, Any]
    findings: tuple[Finding, ...] = ()

    def best(self) -> float:
        """The value with the smallest peak.

        Raises
        ------
        InputError
            Where no peak was found.
        """
        if not self.converged.any():
            raise InputError("no peak was found, so none is the smallest; begin nearer to it, or with a whole curve")
        return float(self.values[np.nanargmin(self.amplitudes)])

    def summary(self) -> str:
        """Return some lines: converged peaks, the smallest and the largest, and the number of solutions."""
        converged = self.converged
        lines = [
            f"{converged.sum()} of {len(self)} peaks found of {self.dof} ({self.kind}), "
            f"by {self.solves.sum()} solutions"
        ]
        if converged.any():
            ends = ("smallest", np.nanargmin(self.amplitudes)), ("largest", np.nanargmax(self.amplitudes))
            for word, place in ends:
                peak = f"{self.amplitudes[place]:.6g} {unit_of(self.dof)} at {self.frequencies[place]:.6g} Hz"
                where = f"{self.parameter} is {self.values[place]:.6g} {self.unit}".rstrip()
                lines.append(f"{word} {peak}, where {where}")
        if not converged.all():
            lost = ", ".join(f"{value:.6g}" for value in self.values[~converged][:5])
            lines.append(f"not found where {self.parameter} is {lost} {self.unit}".rstrip())
        return "\n".join([*lines, *map(str, self.findings)])
