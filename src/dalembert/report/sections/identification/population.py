"""Several specimens: the mean of their parameters, and how much these vary."""

from collections.abc import Iterable

from dalembert.inverse import Population
from dalembert.report import charts
from dalembert.report.headline import Headline
from dalembert.report.options import ReportOptions
from dalembert.report.registry import sections_of
from dalembert.report.section import Fold, Listed, Plot, Row, Section
from dalembert.tables import MOST_FACTS, Table, cell, cells, counted, interval, labelled, shown


@sections_of(Population)
def population(told: Population, options: ReportOptions) -> list[Section]:
    """Means and spreads, then the specimens."""
    named = [labelled(name, unit) for name, unit in zip(told.names, told.units, strict=True)]
    texts = [f"{shown(float(m))}, spread {shown(float(s))}" for m, s in zip(told.mean, told.spread, strict=True)]
    facts = {
        **(dict(zip(named, texts, strict=True)) if len(named) <= MOST_FACTS else {}),
        "specimens": counted(len(told.specimens)),
    }
    headline = Headline(title="Several specimens", verdict="estimated", facts=facts, findings=told.findings)
    return [headline, varied(told)]


def varied(told: Population, *more: Listed) -> Section:
    """Means, spreads, and the specimens of each parameter."""
    level = f"{100 * told.level:g} %"
    named = [labelled(name, unit) for name, unit in zip(told.names, told.units, strict=True)]
    how = f"The line is the mean. The band contains a new specimen with {level}. Bars are two standard deviations."
    plots = [Plot(f"specimens-{k}", charts.specimens(told, name), how) for k, name in enumerate(told.names, 1)]
    blocks = (
        _means(told, named, level),
        *more,
        Row(plots, side_by_side=len(plots) > 1),
        Fold(_values(told, named), rows="specimens"),
    )
    return Section("Mean and spread", blocks)


def _means(told: Population, named: list[str], level: str) -> Table:
    columns = {
        "parameter": named,
        "mean": [cell(mean, deviation) for mean, deviation in zip(told.mean, told.mean_deviations, strict=True)],
        "standard deviation": cells(told.mean_deviations, 2),
        "spread": cells(told.spread, 3),
        f"spread, {level}": [interval(*ends) for ends in zip(told.spread_lower, told.spread_upper, strict=True)],
        f"new specimen, {level}": [interval(*ends) for ends in told.prediction.values()],
        "Q": cells(told.heterogeneity, 3),
        "p-value of Q": cells(told.p_value, 2),
    }
    return Table.of("population", "Mean over specimens, and standard deviation between them", columns)


def _values(told: Population, named: list[str]) -> Table:
    columns: dict[str, Iterable[object]] = {"specimen": told.specimens}
    for k, name in enumerate(named):
        for words, values, deviations in (
            ("", told.values, told.deviations),
            (", adjusted", told.adjusted, told.adjusted_deviations),
        ):
            pairs = zip(values[:, k], deviations[:, k], strict=True)
            columns[f"{name}{words}"] = [cell(value, deviation) for value, deviation in pairs]
            columns[f"± {name}{words}"] = cells(deviations[:, k], 2)
    return Table.of("specimens", "Values of the specimens, and adjusted by what is known of the others", columns)
