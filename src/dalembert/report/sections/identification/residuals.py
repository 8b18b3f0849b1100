"""Diagnostics of the residuals: tests of each channel, figures, outliers and the most influential samples."""

from collections.abc import Sequence

import numpy as np

from dalembert.inverse import Fit, ResidualDiagnostics, SeriesResiduals
from dalembert.report import charts
from dalembert.report.charts.identification.residual_diagnostics import VISIBLE, doubted
from dalembert.report.section import Block, Fold, Plot, Section
from dalembert.report.table import Cell, Table, cell

LEAST = 10
"""Fewest values of a channel that is drawn and tested."""

SIGNIFICANT = 0.001
"""Probability of a test from which it is marked."""

MOST_OUTLIERS = 50
INFLUENTIAL = 10
HOW = (
    "Residuals are computed minus measured values in standard deviations of their channel. Dotted lines contain 95 % "
    "of the autocorrelations of independent noise. Samples far to the right in the last panel determine the fit most."
)
CHOOSE = "Click a name in the legend to show or hide a channel."
_TESTS = {
    "autocorrelation": "autocorrelation",
    "runs": "runs of signs",
    "normality": "normality",
    "period": "periodic part",
    "size over response": "size over response",
    "size over coordinate": "size over coordinate",
}


def residuals(fit: Fit) -> list[Section]:
    """The section on residuals; none where no channel has ten values."""
    found = fit.diagnostics()
    if all(len(one.residuals) < LEAST for one in found.series):
        return []
    return [Section("Residuals", list(_blocks(found)))]


def _blocks(found: ResidualDiagnostics) -> list[Block]:
    many = len(found.series) > len(doubted(found))
    caption = " ".join([HOW, *([CHOOSE] if len(found.series) > 1 else [])])
    blocks: list[Block] = [
        "" if found.tested else "The residuals are not tested: they are rounding errors, or not those of a minimum.",
        f"The figure has the {len(doubted(found))} channels that the tests doubt most." if many else "",
        Plot("residual-diagnostics", charts.residual_diagnostics(found), caption),
        Fold(_tests(found), most=3 * VISIBLE, rows="channels"),
    ]
    if found.outliers:
        blocks.append(Fold(_outliers(found), most=10, rows="outliers"))
    if (influential := _influential(found)) is not None:
        blocks.append(influential)
    return blocks


def _tests(found: ResidualDiagnostics) -> Table:
    """Probabilities of the tests, a row for each channel."""
    columns = {"channel": [one.name for one in found.series], "values": [len(one.residuals) for one in found.series]}
    columns |= {title: [_probability(one, test) for one in found.series] for test, title in _TESTS.items()}
    return Table.of("residual-tests", "Probability of the residuals of each channel in independent noise", columns)


def _probability(one: SeriesResiduals, test: str) -> Cell:
    if test not in one.p_values:
        return Cell("", "not tested")
    return cell(one.p_values[test], digits=2, mark=one.p_values[test] < SIGNIFICANT)


def _outliers(found: ResidualDiagnostics) -> Table:
    names = ("channel", "experiment", "at", "unit", "standard deviations", "p-value", "parameter", "change by it")
    rows = [
        (
            one.channel,
            one.experiment,
            one.at,
            one.unit,
            cell(one.size, digits=3),
            cell(one.p_value, digits=2),
            one.parameter,
            cell(one.change, digits=2),
        )
        for one in found.outliers[:MOST_OUTLIERS]
    ]
    return Table.of_rows("outliers", "Outliers, the largest first", names, rows)


def _influential(found: ResidualDiagnostics) -> Table | None:
    """The samples of the largest Cook's distances; None without a Jacobian."""
    samples = [(one, row) for one in found.series for row in _largest(one.distance)]
    samples = sorted(samples, key=lambda pair: -pair[0].distance[pair[1]])[:INFLUENTIAL]
    if not samples:
        return None
    columns: Sequence[str] = ("channel", "at", "unit", "leverage", "Cook's distance", "parameter", "change by it")
    rows = []
    for one, row in samples:
        most = int(np.argmax(np.abs(np.nan_to_num(one.changes[row]))))
        numbers = (cell(float(value), digits=3) for value in (one.leverage[row], one.distance[row]))
        change = cell(float(one.changes[row, most]), digits=2)
        rows.append((one.name, one.series.along[row], one.series.unit, *numbers, found.parameters[most], change))
    caption = "Samples with the largest influence. The change is that of the parameter by the sample, in its deviations"
    return Table.of_rows("influence", caption, columns, rows)


def _largest(values: np.ndarray) -> np.ndarray:
    """Indices of the largest finite values."""
    known = np.flatnonzero(np.isfinite(values))
    return known[np.argsort(-values[known], kind="stable")[:INFLUENTIAL]]
