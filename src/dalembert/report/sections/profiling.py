"""Profile likelihoods."""

from dataclasses import dataclass
from typing import ClassVar

from dalembert.inverse import Profiles
from dalembert.report import charts
from dalembert.report.plot import Plot
from dalembert.report.sections.section import Section
from dalembert.report.table import Table, cell


@dataclass(frozen=True)
class Profiling(Section):
    """Intervals from profile likelihoods, beside those of the standard deviations."""

    name: ClassVar[str] = "profiling"
    heading: ClassVar[str] = "Profile likelihood"
    profiles: Profiles

    @property
    def sentences(self) -> tuple[str, ...]:
        return tuple(str(item) for item in self.profiles.outcome if item.code != "profile-level")

    @property
    def plots(self) -> tuple[Plot, ...]:
        how = "Shaded is where the data do not contradict the value; a flat profile is a parameter they do not tell."
        return tuple(
            Plot(f"profile-{number}", charts.profile(self.profiles, curve.name), how)
            for number, curve in enumerate(self.profiles.curves, 1)
        )

    @property
    def table(self) -> Table:
        told, rows = self.profiles, []
        for curve in told.curves:
            k = told.parameters.names.index(curve.name)
            sides = " and ".join(side for side, is_open in zip(("lower", "upper"), curve.open, strict=True) if is_open)
            rows.append(
                (
                    cell(curve.name),
                    cell(float(told.values[k])),
                    cell(curve.lower, mark=curve.open[0]),
                    cell(curve.upper, mark=curve.open[1]),
                    cell(told.parameters.items[k].unit),
                    cell(float(told.deviations[k]), digits=2),
                    cell(f"open: {sides} bound" if sides else "", mark=bool(sides)),
                )
            )
        columns = ("parameter", "value", "lower end", "upper end", "unit", "standard deviation", "note")
        return Table("profiles", f"{100 * told.level:g} % intervals from profile likelihoods", columns, rows)
