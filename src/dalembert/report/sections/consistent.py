"""The set of parameters that are consistent with bounded-error data."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import ClassVar

from dalembert.inverse import ParameterSet
from dalembert.report import charts
from dalembert.report.charts.paving import planes
from dalembert.report.plot import Plot
from dalembert.report.sections.bounds import box_table
from dalembert.report.sections.section import Section
from dalembert.report.table import Table


@dataclass(frozen=True)
class Consistent(Section):
    """Outer and inner box, and the paving in the planes of the parameters."""

    name: ClassVar[str] = "consistent"
    heading: ClassVar[str] = "Consistent set"
    found: ParameterSet
    truth: Mapping[str, float] = field(default_factory=dict)

    @property
    def tables(self) -> tuple[Table, ...]:
        given = (
            ("outer-box", self.found.outer, "Outer box: all consistent parameters lie in it"),
            ("inner-box", self.found.inner, "Inner box: all parameters in it are consistent"),
        )
        return tuple(box_table(box, caption, name) for name, box, caption in given if box is not None)

    @property
    def plots(self) -> tuple[Plot, ...]:
        caption = (
            "Every point of a consistent box explains all data within their errors; an undecided box may hold some."
        )
        return tuple(
            Plot(f"paving-{place}", charts.paving(self.found, plane, truth=self.truth), caption)
            for place, plane in enumerate(planes(self.found.parameters.names), start=1)
        )
