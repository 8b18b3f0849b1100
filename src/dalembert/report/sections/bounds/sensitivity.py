"""Global sensitivity and screening: which parameters matter for the channels."""

import numpy as np

from dalembert.report import charts
from dalembert.report.digits import counted
from dalembert.report.headline import Headline
from dalembert.report.options import ReportOptions
from dalembert.report.registry import sections_of
from dalembert.report.section import Download, Fold, Plot, Row, Section
from dalembert.report.sections.shared_tables import box_table, samples
from dalembert.report.table import Table, cell, cells
from dalembert.uncertainty import Screening, SensitivityIndices


@sections_of(SensitivityIndices)
def sensitivity_indices(told: SensitivityIndices, options: ReportOptions) -> list[Section]:
    """Indices of whole channels, then over the samples, then the distributions."""
    facts = {
        "parameters": counted(len(told.box.names)),
        "simulations": counted(told.runs),
        "random checks": counted(told.checks),
    }
    headline = Headline(
        title="Global sensitivity",
        verdict="estimated",
        success=told.success,
        status=told.status,
        facts=facts,
        findings=told.findings,
    )
    indices = Section("Sobol indices", (_table(told), Row(_plots(told)), _download(told)))
    box = box_table(
        told.box,
        "Intervals and distributions of the parameters",
        units=told.parameter_units,
        distribution=told.distributions,
    )
    return [headline, indices, Section("Parameters", (box,))]


def _plots(told: SensitivityIndices) -> list[Plot]:
    lines = "Solid: first-order index. Dotted: total index, which contains interactions with other parameters."
    areas = (
        "Each area is the part of the variance that a parameter causes alone. What is left up to 1 are interactions."
    )
    plots = []
    for k, name in enumerate(told.channels, 1):
        if len(told.coordinate.values) == 1:
            plots.append(Plot(f"indices-{k}", charts.indices(told, name), "A total index contains interactions."))
        else:
            plots += [
                Plot(f"indices-{k}", charts.indices(told, name), lines),
                Plot(f"shares-{k}", charts.shares(told, name), areas),
            ]
    return plots


def _table(told: SensitivityIndices) -> Table:
    columns = {
        "channel": [channel for channel in told.channels for _ in told.box.names],
        "parameter": [name for _ in told.channels for name in told.box.names],
        "first-order index": [cell(float(value), digits=4) for value in told.whole_first.ravel()],
        "total index": [cell(float(value), digits=4) for value in told.whole_total.ravel()],
        "± at most": cells(told.uncertainty.repeat(len(told.box.names)), 2),
    }
    return Table.of("sobol-indices", "Parts of the variance of whole channels", columns)


def _download(told: SensitivityIndices) -> Download:
    series = {"mean": told.mean, "deviation": told.deviations}
    for number, name in enumerate(told.box.names):
        series[f"first-order of {name}"] = told.first[:, :, number]
        series[f"total of {name}"] = told.total[:, :, number]
    return samples("indices", told.coordinate, told.channels, series, "Download all indices as CSV")


@sections_of(Screening)
def screening(told: Screening, options: ReportOptions) -> list[Section]:
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
    table = Fold(_screening_table(told), most=40, rows="effects")
    effects = Section("Elementary effects", (table, Row(plots, beside=len(plots) > 1), download))
    return [headline, effects, Section("Parameters", (box,))]


def _screening_table(told: Screening) -> Table:
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
