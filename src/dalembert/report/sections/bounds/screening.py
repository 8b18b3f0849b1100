"""Screening: which of many parameters have effects on the channels."""

import numpy as np

from dalembert.report import charts
from dalembert.report.asked import Asked
from dalembert.report.digits import counted
from dalembert.report.headline import Headline
from dalembert.report.registry import sections_of
from dalembert.report.section import Fold, Plot, Row, Section
from dalembert.report.sections.box import box_table
from dalembert.report.sections.samples import samples
from dalembert.report.table import Table, cell, cells
from dalembert.uncertainty import Screening


@sections_of(Screening)
def screening(told: Screening, asked: Asked) -> list[Section]:
    """Effects on whole channels, the largest first, then the distributions."""
    facts = {
        "parameters": counted(len(told.box.names)),
        "trajectories": counted(told.trajectories),
        "simulations": counted(told.runs),
    }
    headline = Headline(
        title="Screening of parameters",
        verdict="ranked",
        success=told.success,
        status=told.status,
        facts=facts,
        findings=told.findings,
    )
    how = "Right: a large effect. Up: the effect depends on the other parameters or is not linear. Bars: two errors."
    plots = [Plot(f"effects-{k}", charts.effects(told, name), how) for k, name in enumerate(told.channels, 1)]
    series = {f"effect of {name}": told.effects[:, :, number] for number, name in enumerate(told.box.names)}
    download = samples("effects", told.coordinate, told.channels, series, "Download all effects as CSV")
    box = box_table(
        told.box,
        "Intervals and distributions of the parameters",
        units=told.parameter_units,
        distribution=told.distributions,
    )
    table = Fold(_table(told), most=40, rows="effects")
    effects = Section("Elementary effects", (table, Row(plots, beside=len(plots) > 1), download))
    return [headline, effects, Section("Parameters", (box,))]


def _table(told: Screening) -> Table:
    order = np.argsort(-told.whole_effects, axis=1, kind="stable")
    rows = [(c, int(p)) for c, places in enumerate(order) for p in places]
    at = tuple(np.array(rows).T)
    columns = {
        "channel": [told.channels[c] for c, _ in rows],
        "parameter": [told.box.names[p] for _, p in rows],
        "mean absolute effect": [cell(float(told.whole_effects[pair]), digits=4) for pair in rows],
        "standard error": cells(told.errors[at], 2),
        "spread": cells(told.whole_spread[at], 3),
        "unit": [told.units[c] for c, _ in rows],
    }
    return Table.of("effects-of-parameters", "Effects on whole channels, over the whole intervals", columns)
