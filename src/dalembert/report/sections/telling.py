"""What the data tell about the parameters, and what they do not."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

from dalembert.inverse import BandFit, Fit
from dalembert.report import charts
from dalembert.report.charts.correlation import unknowns
from dalembert.report.plot import Plot
from dalembert.report.sections.section import Section

MOST_BESIDE = 3


@dataclass(frozen=True)
class Telling(Section):
    """Sentences on identifiability; of several unknowns, singular values and correlation."""

    name: ClassVar[str] = "telling"
    heading: ClassVar[str] = "What the data tell"
    fit: Fit | BandFit
    sentences: Sequence[str]
    spectrum: Plot

    @property
    def beside(self) -> bool:
        """Whether the figures have room side by side: combinations of many unknowns have long names."""
        return len(unknowns(self.fit)) <= MOST_BESIDE

    @property
    def plots(self) -> tuple[Plot, ...]:
        if len(unknowns(self.fit)) == 1:
            return ()
        pairs = "Near 1 or −1, the data tell a combination of the two parameters but not each of them."
        heat = Plot("correlation", charts.correlation(self.fit), pairs)
        return heat, self.spectrum
