"""What is known beyond a fit: profiles, predictions, and designs of experiments."""

from collections.abc import Mapping

import numpy as np

from dalembert.inverse import Designs, Prediction, Profiles
from dalembert.quantities import by_quantity
from dalembert.report import charts
from dalembert.report.headline import Headline
from dalembert.report.look import plain
from dalembert.report.options import ReportOptions
from dalembert.report.registry import sections_of
from dalembert.report.section import Fold, Listed, Plot, Row, Section, numbered
from dalembert.tables import Table, cell, cells, counted, few_values, interval, labelled, marks, shown


@sections_of(Profiles)
def profiles(told: Profiles, options: ReportOptions) -> list[Section]:
    """The profiles alone."""
    items = {item.name: item for item in told.parameters}
    ends = [interval(curve.lower, curve.upper) for curve in told.curves]
    facts = {
        **few_values([items[curve.name] for curve in told.curves], ends),
        "level": f"{100 * told.level:g} %",
        "simulations": counted(told.simulations),
    }
    verdicts = ("profiled", "not settled")
    return [Headline.of("Profile likelihood", told.success, verdicts, told.status, facts), profiled(told)]


def profiled(told: Profiles) -> Section:
    """The section on profiles."""
    sentences = [str(item) for item in told.outcome if item.code != "profile-level"]
    how = "Shaded is where the data do not contradict the value; a parameter with a flat profile is not identifiable."
    plots = [
        Plot(f"profile-{number}", charts.profile(told, curve.name), how) for number, curve in enumerate(told.curves, 1)
    ]
    return Section("Profile likelihood", (Listed(sentences), _table(told), Row(plots, side_by_side=len(plots) > 1)))


def _table(told: Profiles) -> Table:
    curves, places = told.curves, [told.parameters.names.index(curve.name) for curve in told.curves]
    sides = [
        " and ".join(side for side, is_open in zip(("lower", "upper"), curve.open, strict=True) if is_open)
        for curve in curves
    ]
    columns = {
        "parameter": [curve.name for curve in curves],
        "value": told.values[places],
        "lower end": [cell(curve.lower, mark=curve.open[0]) for curve in curves],
        "upper end": [cell(curve.upper, mark=curve.open[1]) for curve in curves],
        "unit": [told.parameters.items[k].unit for k in places],
        "standard deviation": cells(told.deviations[places], 2),
        "note": marks(f"open: {side} bound" if side else "" for side in sides),
    }
    return Table.of("profiles", f"{100 * told.level:g} % intervals from profile likelihoods", columns)


@sections_of(Prediction)
def prediction(told: Prediction, options: ReportOptions) -> list[Section]:
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
    return Section("Prediction", (*sentences, *plots, _prediction_table(predictions)))


def _prediction_table(predictions: Mapping[str, Prediction]) -> Table:
    rows = {}
    for experiment, told in predictions.items():
        half = (told.upper - told.lower) / 2, (told.measured_upper - told.measured_lower) / 2
        widest = (cells(np.fmax.reduce(widths, axis=0), 3) for widths in half)
        rows[experiment] = list(zip(told.channels, told.units, *widest, strict=True))
    names = ("channel", "unit", "± response at most", "± measurement at most")
    caption = f"Half widths of the {100 * next(iter(predictions.values())).level:g} % bands"
    return Table.of_experiments("prediction", caption, names, rows)


@sections_of(Designs)
def designs(told: Designs, options: ReportOptions) -> list[Section]:
    """The designs, the best first."""
    facts = {
        "best sensors": ", ".join(told.sensors[0]),
        f"until {told.along}": f"{shown(float(told.horizons[0]))} {told.unit}".rstrip(),
        "criterion": told.criterion,
        "designs": counted(len(told.scores)),
    }
    headline = Headline.of("Design of the experiment", told.success, ("ranked", "not ranked"), told.status, facts)
    how = "Further left is better: the deviations to be expected, in parts of the parameters' scales."
    plots = [Plot("ranking", charts.ranking(told), how)]
    if len(np.unique(told.horizons)) > 1:
        longer = "Where a line flattens, measuring longer brings little more."
        plots.append(Plot("horizons", charts.horizons(told), longer))
    return [headline, Section("Designs", (*plots, Fold(_designs_table(told), rows="designs")))]


def _designs_table(told: Designs) -> Table:
    unseen = list(map(int, told.unseen))
    columns = {
        "rank": range(1, len(told.scores) + 1),
        "sensors": map(", ".join, told.sensors),
        labelled(told.along, told.unit): told.horizons,
        "score": [cell(score, digits=4, mark=lost > 0) for score, lost in zip(told.scores, unseen, strict=True)],
        **{
            f"± {labelled(item.name, item.unit)}": cells(deviations, 3)
            for item, deviations in zip(told.parameters, told.deviations.T, strict=True)
        },
        "note": marks(f"{lost} unseen" if lost else "" for lost in unseen),
    }
    return Table.of("designs", "Designs, the best first, with the deviations to be expected", columns)
