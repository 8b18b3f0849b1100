"""Global sensitivity: which parameters cause the variance of the channels."""

from dalembert.report import charts
from dalembert.report.asked import Asked
from dalembert.report.digits import counted
from dalembert.report.headline import Headline
from dalembert.report.registry import sections_of
from dalembert.report.section import Download, Plot, Row, Section
from dalembert.report.sections.box import box_table
from dalembert.report.sections.samples import samples
from dalembert.report.table import Table, cell, cells
from dalembert.uncertainty import SensitivityIndices


@sections_of(SensitivityIndices)
def sensitivity_indices(told: SensitivityIndices, asked: Asked) -> list[Section]:
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
