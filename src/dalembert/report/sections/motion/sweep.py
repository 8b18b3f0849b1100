"""Responses along one parameter at a time."""

from typing import Any

from dalembert.report import charts
from dalembert.report.headline import Headline
from dalembert.report.options import ReportOptions
from dalembert.report.registry import sections_of
from dalembert.report.section import Fold, Plot, Row, Section
from dalembert.tables import MOST_FACTS, Table, labelled


@sections_of("dalembert.study.tasks.sweep.Sweep")
def sweep(result: Any, options: ReportOptions) -> list[Section]:
    """A figure and a table for each parameter."""
    names = ", ".join(curve.parameter for curve in result.curves)
    status = f"Responses at {result.at}, one parameter varied at a time: {names}. {result.status}"
    facts = {f"values of {curve.parameter}": str(len(curve.values)) for curve in result.curves[:MOST_FACTS]}
    headline = Headline.of("Parameter sweep", result.success, ("swept", "incomplete"), status, facts)
    places = list(enumerate(result.curves, start=1))
    how = ["" if curve.sensitivities is None else "Below, its slope." for curve in result.curves]
    plots = [Plot(f"sweep-{place}", charts.sweep(curve, result.at), how[place - 1]) for place, curve in places]
    tables = [Fold(_table(place, curve), 0, "values") for place, curve in places]
    return [headline, Section("Sweep", (Row(plots), *tables))]


def _table(place: int, curve: Any) -> Table:
    columns = {labelled(curve.parameter, curve.unit): curve.values}
    columns |= zip(curve.channels, curve.responses.T, strict=True)
    if curve.sensitivities is not None:
        names = [f"d {channel} / d {curve.parameter}" for channel in curve.channels]
        columns |= zip(names, curve.sensitivities.T, strict=True)
    return Table.of(f"sweep-{place}", f"Responses along {curve.parameter}", columns)
