"""A section of sentences, figures and tables in this order."""

from typing import ClassVar

from dalembert.report.plot import Plot
from dalembert.report.sections.section import Section
from dalembert.report.table import Table


class Findings(Section):
    """Sentences, wide figures, smaller ones beside each other, and tables."""

    name: ClassVar[str] = "findings"

    @property
    def sentences(self) -> tuple[str, ...]:
        return ()

    @property
    def wide(self) -> tuple[Plot, ...]:
        """Figures as wide as the page."""
        return ()

    @property
    def pairs(self) -> tuple[Plot, ...]:
        """Figures two beside each other, where the page is wide enough."""
        return ()

    @property
    def tables(self) -> tuple[Table, ...]:
        return ()

    @property
    def plots(self) -> tuple[Plot, ...]:
        return (*self.wide, *self.pairs)
