"""A predicted response and its bands."""

from collections.abc import Mapping

import numpy as np

from dalembert.inverse import Prediction
from dalembert.report import charts
from dalembert.report.asked import Asked
from dalembert.report.digits import counted
from dalembert.report.headline import Headline
from dalembert.report.look import plain
from dalembert.report.plot import Plot, numbered
from dalembert.report.quantities import by_quantity
from dalembert.report.registry import sections_of
from dalembert.report.section import Section
from dalembert.report.table import Table, cell, cells


@sections_of(Prediction)
def prediction(told: Prediction, asked: Asked) -> list[Section]:
    """The prediction alone."""
    headline = Headline(
        title="Predicted response",
        verdict="predicted" if told.success else "not bounded",
        success=told.success,
        status=told.status,
        facts={"level": f"{100 * told.level:g} %", "channels": counted(len(told.channels))},
    )
    return [headline, predicted({"": told})]


def predicted(predictions: Mapping[str, Prediction]) -> Section:
    """Bands in which the true response, and a new measurement, are expected, of each experiment."""
    sentences = [f"{name}: {told.status}" if name else told.status for name, told in predictions.items()]
    how = "Dark: the true response; light: a new measurement. Each holds sample by sample."
    plots = []
    for place, experiment, told in numbered("prediction", predictions):
        lead = f"{plain(experiment)}: " if experiment else ""
        for number, chosen in enumerate(by_quantity(told.channels), 1):
            figure = charts.prediction(told, chosen, title=lead + plain(", ".join(chosen)))
            plots.append(Plot(f"{place}-{number}", figure, how))
    return Section("Prediction", (*sentences, *plots, _table(predictions)))


def _table(predictions: Mapping[str, Prediction]) -> Table:
    rows, several = [], "" not in predictions
    for experiment, told in predictions.items():
        half = (told.upper - told.lower) / 2, (told.measured_upper - told.measured_lower) / 2
        widest = (cells(np.fmax.reduce(widths, axis=0), 3) for widths in half)
        own = zip(told.channels, told.units, *widest, strict=True)
        rows += [tuple(map(cell, (experiment, *row) if several else row)) for row in own]
    names = ("channel", "unit", "± response at most", "± measurement at most")
    names = ("experiment", *names) if several else names
    caption = f"Half widths of the {100 * next(iter(predictions.values())).level:g} % bands"
    return Table("prediction", caption, names, rows)
