"""A nonlinear mode over its amplitude."""

import numpy as np

from dalembert.report import charts
from dalembert.report.headline import Headline
from dalembert.report.options import ReportOptions
from dalembert.report.registry import sections_of
from dalembert.report.section import Fold, Plot, Section
from dalembert.tables import Table, cells, counted, labelled, noted, percent, shown, unless
from dalembert.units import unit_of
from dalembert.vibration import Backbone

STEADY = 1e-3
"""Change of the frequency, as part of it, below which there is none to tell."""


@sections_of(Backbone)
def backbone(mode: Backbone, options: ReportOptions) -> list[Section]:
    """The mode alone."""
    found, facts = np.asarray(mode.converged), {}
    if found.any():
        ends = [shown(float(np.asarray(mode.frequencies)[found][end])) for end in (0, -1)]
        facts["frequency"] = f"{' to '.join(dict.fromkeys(ends))} Hz"
        facts["largest damping ratio"] = percent(np.asarray(mode.damping)[found].max())
    facts["amplitudes"] = counted(len(found))
    status = f"Mode {mode.mode} was found at {mode.extent}."
    complete = bool(found.all()) and all(finding.code != "end-not-reached" for finding in mode.findings)
    headline = Headline.of("Nonlinear mode", complete, ("computed", "incomplete"), status, facts)
    return [headline, nonlinear_mode(mode)]


def nonlinear_mode(mode: Backbone) -> Section:
    """Frequency and damping over amplitude, with the energy of the mode and the force that keeps it going."""
    columns = {
        labelled(f"amplitude of {mode.dof}", unit_of(mode.dof)): mode.amplitudes,
        "frequency (Hz)": mode.frequencies,
        "damping ratio (%)": cells(100 * np.asarray(mode.damping), 4),
        "kinetic energy, largest (J)": cells(mode.energies, 4),
        "force at resonance (N)": cells(mode.forces, 4),
        "note": unless(mode.converged, "not found"),
    }
    how = "Without force, and with the damping made up for: resonance peaks of forced responses lie on this line."
    table = noted(Table.of("backbone", f"Mode {mode.mode} over its amplitude", columns))
    return Section("Nonlinear mode", (*_sentences(mode), Plot("backbone", charts.backbone(mode), how), Fold(table)))


def _sentences(mode: Backbone) -> tuple[str, ...]:
    found = np.asarray(mode.converged)
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
    most = f"It is damped most, by a ratio of {percent(damping[top])}, at "
    most += f"{shown(float(amplitudes[top]), digits=4)} {unit}."
    return (told, most) if damping[top] > 0 else (told,)
