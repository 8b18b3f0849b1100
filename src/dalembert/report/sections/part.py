"""A section of the user's."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from dalembert.report.plot import Plot
from dalembert.report.sections.findings import Findings
from dalembert.report.table import Table


@dataclass(frozen=True)
class Part(Findings):
    """A section of a report: sentences, Plotly figures and tables.

    Parameters
    ----------
    heading : str
    sentences : tuple of str
    figures : mapping of str to plotly.graph_objects.Figure
        By their captions. Their titles stand in the figures' layouts.
    tables : tuple of Table

    Examples
    --------
    >>> Part("Weather", ("It rained.",)).anchor
    'weather'
    """

    heading: str  # type: ignore[misc] - of the object, not of its class
    sentences: tuple[str, ...] = ()  # type: ignore[assignment]
    figures: Mapping[str, Any] = field(default_factory=dict)
    tables: tuple[Table, ...] = ()  # type: ignore[assignment]

    @property
    def wide(self) -> tuple[Plot, ...]:
        return tuple(
            Plot(f"{self.anchor}-{number}", figure, caption)
            for number, (caption, figure) in enumerate(self.figures.items(), start=1)
        )
