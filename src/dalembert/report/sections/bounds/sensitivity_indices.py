"""Global sensitivity: which parameters cause the variance of the channels."""

from dalembert.report import charts
from dalembert.report.asked import Asked
from dalembert.report.digits import counted
from dalembert.report.headline import Headline
from dalembert.report.registry import sections_of
from dalembert.report.section import Plot, Row, Section
from dalembert.report.table import Table, cell, cells
from dalembert.uncertainty import SensitivityIndices


@sections_of(SensitivityIndices)
def sensitivity_indices(told: SensitivityIndices, asked: Asked) -> list[Section]:
    """Indices of whole channels, then over the samples."""
    facts = {"parameters": counted(len(told.box.names)), "simulations": counted(told.runs)}
    headline = Headline(title="Global sensitivity", verdict="estimated", facts=facts, findings=told.findings)
    how = "Each area is the part of the variance that a parameter causes alone. What is left up to 1 are interactions."
    plots = [Plot(f"shares-{k}", charts.shares(told, name), how) for k, name in enumerate(told.channels, 1)]
    return [headline, Section("Sobol indices", (_table(told), Row(plots, beside=len(plots) > 1)))]


def _table(told: SensitivityIndices) -> Table:
    columns = {
        "channel": [channel for channel in told.channels for _ in told.box.names],
        "parameter": [name for _ in told.channels for name in told.box.names],
        "first-order index": [cell(float(value), digits=4) for value in told.whole_first.ravel()],
        "total index": [cell(float(value), digits=4) for value in told.whole_total.ravel()],
        "± at most": cells(told.uncertainty.repeat(len(told.box.names)), 2),
    }
    return Table.of("sobol-indices", "Parts of the variance of whole channels", columns)
