"""The peak of a response over a parameter, as a result."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np

from dalembert.errors import InputError
from dalembert.findings import Finding
from dalembert.tables import Table, counted, in_words, labelled, noted, shown, unless
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
    VERDICTS: ClassVar[tuple[str, str]] = ("tracked", "incomplete")

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

    @property
    def title(self) -> str:
        return f"Resonance over {self.parameter}"

    @property
    def status(self) -> str:
        """At how many values the peak was found, in a sentence."""
        return f"The peak was found at {int(self.converged.sum())} of {len(self)} values of {self.parameter}."

    def facts(self) -> dict[str, str]:
        facts = {"values": counted(len(self)), "points balanced": counted(int(np.sum(self.solves)))}
        if self.converged.any():
            for size, row in (("smallest", np.nanargmin(self.amplitudes)), ("largest", np.nanargmax(self.amplitudes))):
                amplitude = in_words(float(self.amplitudes[row]), unit_of(self.dof), 5)
                facts[f"{self.parameter} of the {size} peak"] = f"{shown(float(self.values[row]))} {self.unit}".rstrip()
                facts[f"{size} peak of {self.dof}"] = f"{amplitude} at {shown(float(self.frequencies[row]))} Hz"
        return facts

    def tables(self) -> tuple[Table, ...]:
        """Return the peak at each value."""
        columns = {
            labelled(self.parameter, self.unit): self.values,
            labelled("peak", unit_of(self.dof)): self.amplitudes,
            "at frequency (Hz)": self.frequencies,
            "points balanced": self.solves,
            "note": unless(self.converged, "not found"),
        }
        return (noted(Table.of("resonance", f"Peaks of {self.dof}", columns)),)
