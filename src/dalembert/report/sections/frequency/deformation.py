"""The structure in motion at one frequency, and where its contacts stick, slip or lift off."""

import numpy as np

from dalembert.report import charts
from dalembert.report.charts.frequency.shapes import magnified
from dalembert.report.headline import Headline
from dalembert.report.options import ReportOptions
from dalembert.report.registry import sections_of
from dalembert.report.section import Block, Plot, Section
from dalembert.tables import counted, percent, shown
from dalembert.vibration import Deformation


@sections_of(Deformation)
def deformation(shape: Deformation, options: ReportOptions) -> list[Section]:
    """The deformed shape."""
    contacts = {"contacts": counted(len(shape.contacts))} if shape.contacts else {}
    headline = Headline(
        title="Deformed shape",
        verdict="computed",
        status="The motion of the whole structure at one point of a response over frequency.",
        facts={"frequency": f"{shown(shape.frequency)} Hz", "nodes": counted(len(shape.places)), **contacts},
    )
    return [headline, deformed(shape)]


def deformed(shape: Deformation) -> Section:
    """The deformed shape as a film, and a map of the interface where there are contacts."""
    how = f"Displacements drawn {shown(magnified(shape), digits=2)} times as large as they are; thin lines: at rest."
    blocks: list[Block] = [_energies(shape), Plot("deformation", charts.deformation(shape), how)]
    if shape.contacts:
        over = "Filled: the state at the phase shown; ring: the state held for longest; larger contacts take more "
        over += "energy from the motion."
        at = f"Contact states over the interface at {shown(shape.frequency)} Hz"
        blocks.append(Plot("interface-map", charts.interface_map(shape, title=at), over))
    return Section("Deformed shape", blocks)


def _energies(shape: Deformation) -> str:
    """Which contact takes most energy."""
    energies = np.asarray(shape.energies, dtype=float)
    if len(energies) < 2 or not energies.max() > 0:
        return ""
    most = int(energies.argmax())
    part = percent(energies[most] / energies.sum())
    return f"Of all the energy that friction takes, {shape.contacts[most]} takes most, {part}."
