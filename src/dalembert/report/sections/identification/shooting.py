"""The segments of multiple shooting: how they came together, and where they meet."""

from collections.abc import Iterable

import numpy as np

from dalembert.inverse import Fit, Nodes
from dalembert.report import charts
from dalembert.report.quantities import labelled
from dalembert.report.section import Plot, Section
from dalembert.report.table import Table, cells


def shooting(fit: Fit, nodes: Nodes) -> Section:
    """Gaps over the steps, and the states at which the segments meet."""
    come = "The gaps weigh ever more until they are closed; where two segments merge, a gap opens once more."
    grown = f"By the last of these states a small change of the initial state has grown {nodes.growth:.2g} times."
    return Section("Multiple shooting", (f"{nodes} {grown}", Plot("gaps", charts.gaps(fit), come), _table(fit, nodes)))


def _table(fit: Fit, nodes: Nodes) -> Table:
    along = [fit, *fit.experiments][-1].data.coordinate
    columns: dict[str, Iterable[object]] = {"experiment": nodes.experiments} if any(nodes.experiments) else {}
    columns |= {"sample": nodes.samples, labelled(along.name, along.unit): nodes.times}
    for name, unit, values in zip(nodes.states, nodes.units, nodes.begins.T, strict=True):
        columns[labelled(name, unit)] = ["" if np.isnan(value) else value for value in values]
    columns["largest gap"] = cells(np.nanmax(abs(nodes.ends - nodes.begins), axis=1), 2)
    return Table.of("nodes", "States found where segments meet", columns)
