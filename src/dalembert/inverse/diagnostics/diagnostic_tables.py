"""Tables of residual diagnostics: tests, outliers, and the samples of the largest influence."""

from collections.abc import Iterator, Sequence

import numpy as np

from dalembert.inverse.diagnostics.findings import Outlier
from dalembert.inverse.diagnostics.series_residuals import SeriesResiduals
from dalembert.tables import Cell, Table, cell

TESTS = {
    "autocorrelation": "autocorrelation",
    "runs": "runs of signs",
    "normality": "normality",
    "period": "periodic part",
    "size over response": "size over response",
    "size over coordinate": "size over coordinate",
}
"""Title of each test."""
SIGNIFICANT = 0.001
"""Probability of a test below which it is marked."""
MOST_OUTLIERS = 50
INFLUENTIAL = 10
"""Samples of the largest influence."""


def diagnostic_tables(
    series: Sequence[SeriesResiduals], outliers: Sequence[Outlier], parameters: Sequence[str]
) -> Iterator[Table]:
    """Yield the tests of each channel, the outliers if there are any, and the influential samples if known."""
    caption = "Probability of the residuals of each channel in independent noise"
    names = ("channel", "values", *TESTS.values())
    rows = [(item.name, len(item.residuals), *(_probability(item, test) for test in TESTS)) for item in series]
    yield Table.of_rows("residual-tests", caption, names, rows, detail=True)
    if outliers:
        names = ("channel", "experiment", "at", "unit", "standard deviations", "p-value", "parameter", "change by it")
        rows = [
            (
                item.channel,
                item.experiment,
                item.at,
                item.unit,
                cell(item.size, digits=3),
                cell(item.p_value, digits=2),
                item.parameter,
                cell(item.change, digits=2),
            )
            for item in outliers[:MOST_OUTLIERS]
        ]
        yield Table.of_rows("outliers", "Outliers, the largest first", names, rows, detail=True)
    samples = []
    for item in series:
        known = np.flatnonzero(np.isfinite(item.distance))
        samples += [(item, row) for row in known[np.argsort(-item.distance[known], kind="stable")[:INFLUENTIAL]]]
    samples = sorted(samples, key=lambda pair: -pair[0].distance[pair[1]])[:INFLUENTIAL]
    if samples:
        names = ("channel", "at", "unit", "leverage", "Cook's distance", "parameter", "change by it")
        rows = []
        for item, row in samples:
            most = int(np.argmax(np.abs(np.nan_to_num(item.changes[row]))))
            numbers = (cell(float(value), digits=3) for value in (item.leverage[row], item.distance[row]))
            change = cell(float(item.changes[row, most]), digits=2)
            rows.append(
                (item.series.name, item.series.along[row], item.series.unit, *numbers, parameters[most], change)
            )
        caption = (
            "Samples with the largest influence. The change is that of the parameter by the sample, in its deviations"
        )
        yield Table.of_rows("influence", caption, names, rows, detail=True)


def _probability(item: SeriesResiduals, test: str) -> Cell:
    if test not in item.p_values:
        return Cell("", "not tested")
    return cell(item.p_values[test], digits=2, mark=item.p_values[test] < SIGNIFICANT)
