"""What is known beyond a fit: profiles, predictions, designs of experiments, and several specimens."""

from collections.abc import Mapping, Sequence

import numpy as np

from dalembert.inverse import Designs, Population, Prediction, Profiles
from dalembert.quantities import by_quantity
from dalembert.report import charts
from dalembert.report.headline import headline_of
from dalembert.report.look import plain
from dalembert.report.options import ReportOptions
from dalembert.report.registry import sections_of
from dalembert.report.section import Listed, Plot, Row, Section, numbered
from dalembert.tables import Table


@sections_of(Profiles)
def profiles(result: Profiles, options: ReportOptions) -> list[Section]:
    """The profiles alone."""
    return [headline_of(result), profiled(result)]


def profiled(result: Profiles) -> Section:
    """The section on profiles."""
    sentences = [str(item) for item in result.outcome if item.code != "profile-level"]
    how = "Shaded is where the data do not contradict the value; a parameter with a flat profile is not identifiable."
    plots = [
        Plot(f"profile-{number}", charts.profile(result, curve.name), how)
        for number, curve in enumerate(result.curves, 1)
    ]
    blocks = (Listed(sentences), *result.tables(), Row(plots, side_by_side=len(plots) > 1))
    return Section("Profile likelihood", blocks)


@sections_of(Prediction)
def prediction(result: Prediction, options: ReportOptions) -> list[Section]:
    """The prediction alone."""
    return [headline_of(result), predicted({"": result})]


def predicted(predictions: Mapping[str, Prediction]) -> Section:
    """Bands in which the true response, and a new measurement, are expected, of each experiment."""
    sentences = [f"{name}: {result.status}" if name else result.status for name, result in predictions.items()]
    how = "Dark: the true response; light: a new measurement. Each holds sample by sample."
    plots = []
    for place, experiment, result in numbered("prediction", predictions):
        lead = f"{plain(experiment)}: " if experiment else ""
        for number, chosen in enumerate(by_quantity(result.channels), 1):
            figure = charts.prediction(result, chosen, title=lead + plain(", ".join(chosen)))
            plots.append(Plot(f"{place}-{number}", figure, how))
    widths = Table.joined({name: result.tables()[0] for name, result in predictions.items()})
    return Section("Prediction", (*sentences, *plots, widths))


@sections_of(Designs)
def designs(result: Designs, options: ReportOptions) -> list[Section]:
    """The designs, the best first."""
    how = "Further left is better: the deviations to be expected, in parts of the parameters' scales."
    plots = [Plot("ranking", charts.ranking(result), how)]
    if len(np.unique(result.horizons)) > 1:
        longer = "Where a line flattens, measuring longer brings little more."
        plots.append(Plot("horizons", charts.horizons(result), longer))
    return [headline_of(result), Section("Designs", (*plots, *result.tables()))]


@sections_of(Population)
def population(result: Population, options: ReportOptions) -> list[Section]:
    """Means and spreads, then the specimens."""
    return [headline_of(result), varied(result)]


def varied(result: Population, sentences: Sequence[str] = ()) -> Section:
    """Means, spreads, and the specimens of each parameter."""
    means, specimens = result.tables()
    how = f"The line is the mean. The band contains a new specimen with {100 * result.level:g} %."
    how += " Bars are two standard deviations."
    plots = [Plot(f"specimens-{k}", charts.specimens(result, name), how) for k, name in enumerate(result.names, 1)]
    blocks = (means, Listed(sentences), Row(plots, side_by_side=len(plots) > 1), specimens)
    return Section("Mean and spread", blocks)
