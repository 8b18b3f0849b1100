"""A predicted response and its bands."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from dalembert.report import charts
from dalembert.report.look import plain
from dalembert.report.needs_telling import PredictionLike
from dalembert.report.plot import Plot
from dalembert.report.quantities import by_quantity
from dalembert.report.sections.section import Section
from dalembert.report.table import Table, cell


@dataclass(frozen=True)
class Predicting(Section):
    """Bands in which the true response, and a new measurement, are expected."""

    name: ClassVar[str] = "predicting"
    heading: ClassVar[str] = "Prediction"
    prediction: PredictionLike

    @property
    def plots(self) -> tuple[Plot, ...]:
        told = self.prediction
        how = "Dark: the true response; light: a new measurement. Each holds sample by sample."
        groups = [[told.channels[column] for column in group] for group in by_quantity(told.channels)]
        return tuple(
            Plot(f"prediction-{number}", charts.prediction(told, group, title=plain(", ".join(group))), how)
            for number, group in enumerate(groups, 1)
        )

    @property
    def table(self) -> Table:
        told = self.prediction
        half = (told.upper - told.lower) / 2, (told.measured_upper - told.measured_lower) / 2
        rows = [
            (cell(name), cell(plain_unit), *(cell(float(np.max(widths[:, k])), digits=3) for widths in half))
            for k, (name, plain_unit) in enumerate(zip(told.channels, told.units, strict=True))
        ]
        columns = ("channel", "unit", "± response at most", "± measurement at most")
        return Table("prediction", f"Half widths of the {100 * told.level:g} % bands", columns, rows)
