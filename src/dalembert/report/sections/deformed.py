"""The structure in motion at one frequency, and where its contacts stick, slip or lift off."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from dalembert.report import charts
from dalembert.report.charts.deformation import magnified
from dalembert.report.digits import shown
from dalembert.report.plot import Plot
from dalembert.report.sections.findings import Findings
from dalembert.vibration import Deformation


@dataclass(frozen=True)
class Deformed(Findings):
    """The deformed shape as a film, and a map of the interface where there are contacts."""

    heading: ClassVar[str] = "Deformed shape"
    shape: Deformation

    @property
    def wide(self) -> tuple[Plot, ...]:
        shape = self.shape
        how = (
            f"Displacements drawn {shown(magnified(shape), digits=2)} times as large as they are; thin lines: at rest."
        )
        found = [Plot("deformation", charts.deformation(shape), how)]
        if shape.contacts:
            over = "Filled: the state at the phase shown; ring: the state held for longest; larger contacts take more "
            over += "energy from the motion."
            at = f"Contact states over the interface at {shown(shape.frequency)} Hz"
            found.append(Plot("interface-map", charts.interface_map(shape, title=at), over))
        return tuple(found)

    @property
    def sentences(self) -> tuple[str, ...]:
        energies = np.asarray(self.shape.energies, dtype=float)
        if len(energies) < 2 or not energies.max() > 0:
            return ()
        most = int(energies.argmax())
        part = shown(100 * float(energies[most] / energies.sum()), digits=3)
        return (f"Of all the energy that friction takes, {self.shape.contacts[most]} takes most, {part} %.",)
