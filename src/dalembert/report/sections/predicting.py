"""A predicted response and its bands."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from dalembert.inverse import Prediction
from dalembert.report import charts
from dalembert.report.each import numbered
from dalembert.report.look import plain
from dalembert.report.plot import Plot
from dalembert.report.quantities import by_quantity
from dalembert.report.sections.section import Section
from dalembert.report.table import Table, cell


@dataclass(frozen=True)
class Predicting(Section):
    """Bands in which the true response, and a new measurement, are expected, of each experiment."""

    name: ClassVar[str] = "predicting"
    heading: ClassVar[str] = "Prediction"
    predictions: Mapping[str, Prediction]

    @property
    def sentences(self) -> tuple[str, ...]:
        """The status of each."""
        return tuple(f"{name}: {told.status}" if name else told.status for name, told in self.predictions.items())

    @property
    def plots(self) -> tuple[Plot, ...]:
        how = "Dark: the true response; light: a new measurement. Each holds sample by sample."
        found = []
        for place, experiment, told in numbered("prediction", self.predictions):
            lead = f"{plain(experiment)}: " if experiment else ""
            for number, group in enumerate(by_quantity(told.channels), 1):
                chosen = [told.channels[column] for column in group]
                figure = charts.prediction(told, chosen, title=lead + plain(", ".join(chosen)))
                found.append(Plot(f"{place}-{number}", figure, how))
        return tuple(found)

    @property
    def table(self) -> Table:
        several = [] if "" in self.predictions else ["experiment"]
        rows = []
        for experiment, told in self.predictions.items():
            half = (told.upper - told.lower) / 2, (told.measured_upper - told.measured_lower) / 2
            for k, (name, unit) in enumerate(zip(told.channels, told.units, strict=True)):
                widest = (cell(float(np.fmax.reduce(widths[:, k])), digits=3) for widths in half)
                rows.append((*(cell(experiment) for _ in several), cell(name), cell(unit), *widest))
        columns = (*several, "channel", "unit", "± response at most", "± measurement at most")
        level = next(iter(self.predictions.values())).level
        return Table("prediction", f"Half widths of the {100 * level:g} % bands", columns, rows)
