"""A predicted response and its bands."""

from collections.abc import Mapping

import numpy as np

from dalembert.inverse import Prediction
from dalembert.report import charts
from dalembert.report.asked import Asked
from dalembert.report.digits import counted
from dalembert.report.headline import Headline
from dalembert.report.look import plain
from dalembert.report.quantities import by_quantity
from dalembert.report.registry import sections_of
from dalembert.report.section import Plot, Section, numbered
from dalembert.report.table import Table, cells


@sections_of(Prediction)
def prediction(told: Prediction, asked: Asked) -> list[Section]:
    """The prediction alone."""
    facts = {"level": f"{100 * told.level:g} %", "channels": counted(len(told.channels))}
    verdicts = ("predicted", "not bounded")
    return [Headline.of("Predicted response", told.success, verdicts, told.status, facts), predicted({"": told})]


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
    rows = {}
    for experiment, told in predictions.items():
        half = (told.upper - told.lower) / 2, (told.measured_upper - told.measured_lower) / 2
        widest = (cells(np.fmax.reduce(widths, axis=0), 3) for widths in half)
        rows[experiment] = list(zip(told.channels, told.units, *widest, strict=True))
    names = ("channel", "unit", "± response at most", "± measurement at most")
    caption = f"Half widths of the {100 * next(iter(predictions.values())).level:g} % bands"
    return Table.of_experiments("prediction", caption, names, rows)
