"""Designs of an experiment."""

from dataclasses import dataclass
from typing import ClassVar

from dalembert.inverse import Designs
from dalembert.report import charts
from dalembert.report.plot import Plot
from dalembert.report.quantities import labelled
from dalembert.report.sections.section import Section
from dalembert.report.table import Table, cell


@dataclass(frozen=True)
class Designing(Section):
    """Sensors and horizons in order of what they would tell."""

    name: ClassVar[str] = "designing"
    heading: ClassVar[str] = "Designs"
    designs: Designs

    @property
    def plots(self) -> tuple[Plot, ...]:
        how = "Further left is better: the deviations to be expected, in parts of the parameters' scales."
        first = Plot("ranking", charts.ranking(self.designs), how)
        if len(set(self.designs.horizons.tolist())) < 2:
            return (first,)
        longer = "Where a line flattens, measuring longer brings little more."
        return (first, Plot("horizons", charts.horizons(self.designs), longer))

    @property
    def table(self) -> Table:
        told = self.designs
        rows = [
            (
                cell(k + 1),
                cell(", ".join(told.sensors[k])),
                cell(float(told.horizons[k])),
                cell(float(told.scores[k]), digits=4, mark=bool(told.unseen[k])),
                *(cell(float(value), digits=3) for value in told.deviations[k]),
                cell(f"{told.unseen[k]} unseen" if told.unseen[k] else "", mark=bool(told.unseen[k])),
            )
            for k in range(len(told.scores))
        ]
        expected = (f"± {labelled(item.name, item.unit)}" for item in told.parameters)
        columns = ("rank", "sensors", labelled(told.along, told.unit), "score", *expected, "note")
        return Table("designs", "Designs, the best first, with the deviations to be expected", columns, rows)
