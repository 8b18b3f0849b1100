"""A periodic motion in time."""

from dataclasses import dataclass
from typing import ClassVar

from dalembert.report import charts
from dalembert.report.plot import Plot
from dalembert.report.sections.findings import Findings
from dalembert.vibration import PeriodicMotion


@dataclass(frozen=True)
class Period(Findings):
    """Displacements over a period, and the loops of contacts and springs."""

    heading: ClassVar[str] = "Periodic motion"
    motion: PeriodicMotion

    @property
    def wide(self) -> tuple[Plot, ...]:
        return (Plot("periodic-motion", charts.periodic_motion(self.motion), "The last period of the integration."),)

    @property
    def pairs(self) -> tuple[Plot, ...]:
        if not self.motion.coordinates:
            return ()
        how = "The area of a loop is the energy taken in a period."
        return (Plot("loops-in-time", charts.loops_in_time(self.motion), how),)
