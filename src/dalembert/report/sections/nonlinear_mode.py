"""A nonlinear mode over its amplitude."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from dalembert.report import charts
from dalembert.report.digits import shown
from dalembert.report.focus import unit_of
from dalembert.report.plot import Plot
from dalembert.report.quantities import labelled
from dalembert.report.sections.findings import Findings
from dalembert.report.table import Table, cell, noted
from dalembert.vibration import Backbone

STEADY = 1e-3
"""Change of the frequency, as part of it, below which there is none to tell."""


@dataclass(frozen=True)
class NonlinearMode(Findings):
    """Frequency and damping over amplitude, with the energy of the mode and the force that keeps it going."""

    heading: ClassVar[str] = "Nonlinear mode"
    mode: Backbone

    @property
    def sentences(self) -> tuple[str, ...]:
        mode, found = self.mode, np.asarray(self.mode.converged)
        if not found.any():
            return ()
        amplitudes, frequencies, damping = (
            np.asarray(values)[found] for values in (mode.amplitudes, mode.frequencies, mode.damping)
        )
        unit = unit_of(mode.dof)
        low, high = (f"{shown(float(amplitudes[end]), digits=4)} {unit}" for end in (0, -1))
        first, last = float(frequencies[0]), float(frequencies[-1])
        word = "stiffens" if last > first else "softens"
        told = f"From {low} to {high} of {mode.dof} the mode {word}: its frequency goes from {shown(first)} to "
        told += f"{shown(last)} Hz."
        if abs(last - first) < STEADY * first:
            told = f"From {low} to {high} of {mode.dof} the frequency of the mode stays at {shown(first)} Hz."
        top = int(damping.argmax())
        most = f"It is damped most, by a ratio of {shown(100 * float(damping[top]), digits=3)} %, at "
        most += f"{shown(float(amplitudes[top]), digits=4)} {unit}."
        return (told, most) if damping[top] > 0 else (told,)

    @property
    def wide(self) -> tuple[Plot, ...]:
        how = "Without force, and with the damping made up for: resonance peaks of forced responses lie on this line."
        return (Plot("backbone", charts.backbone(self.mode), how),)

    @property
    def tables(self) -> tuple[Table, ...]:
        mode = self.mode
        rows = [
            (
                cell(float(amplitude)),
                cell(float(mode.frequencies[k])),
                cell(100 * float(mode.damping[k]), digits=4),
                cell(float(mode.energies[k]), digits=4),
                cell(float(mode.forces[k]), digits=4),
                cell("" if mode.converged[k] else "not found", mark=not mode.converged[k]),
            )
            for k, amplitude in enumerate(mode.amplitudes)
        ]
        columns = (
            labelled(f"amplitude of {mode.dof}", unit_of(mode.dof)),
            "frequency (Hz)",
            "damping ratio (%)",
            "kinetic energy, largest (J)",
            "force at resonance (N)",
            "note",
        )
        return (noted(Table("backbone", f"Mode {mode.mode} over its amplitude", columns, rows)),)
