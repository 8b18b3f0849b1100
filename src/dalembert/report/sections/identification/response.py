"""The response of a fit compared with the data: residuals, their tests, outliers and influence."""

import re
from collections.abc import Sequence

import numpy as np

from dalembert.inverse import CrossValidation, ExperimentFit, Fit, RegularisedFit, ResidualDiagnostics, SeriesResiduals
from dalembert.quantities import by_quantity, unit
from dalembert.report import charts
from dalembert.report.charts.identification.residual_diagnostics import VISIBLE, doubted
from dalembert.report.look import LIGHT, plain
from dalembert.report.section import Block, Download, Fold, Plot, Section, samples
from dalembert.tables import Cell, Table, cell, cells, labelled, noted

HOW = "Lines are computed with the identified values, circles are data; below, computed minus measured."
LEAVES = "At the dashed line the residuals leave the noise: from there on the model does not follow the data."
SHADED = "The shaded part was not fitted."
NAMES = ("channel", "rms residual", "largest residual", "largest at", "deviation of the data", "unit")


def compared(fit: Fit) -> Section:
    """Computed and measured responses, a figure for each quantity, and how large the residuals are."""
    return Section("Response and data", (_validation(fit), *_plots(fit, fit, "responses"), *_of_one_record(fit)))


def compared_simply(fit: RegularisedFit | CrossValidation, how: str = HOW) -> Section:
    """Computed and measured responses without marks, and how large the residuals are."""
    plots = [
        Plot(f"responses-{place}", charts.responses(fit, chosen, title=", ".join(map(plain, chosen))), how)
        for place, chosen in enumerate(by_quantity(fit.data.channels), start=1)
    ]
    return Section("Response and data", (*plots, *_of_one_record(fit)))


def _of_one_record(shown: Fit | RegularisedFit | CrossValidation) -> tuple[Table, Download]:
    """How large the residuals are, and all samples."""
    along = shown.data.coordinate
    columns = dict(zip(NAMES, _residuals(shown), strict=True))
    at = labelled(f"largest at {along.name}", along.unit)
    table = Table.of("residuals", "Residuals", {at if name == NAMES[3] else name: columns[name] for name in NAMES})
    return noted(table), _samples(shown, "responses", "Download all samples as CSV")


def experiments(fit: Fit) -> Section:
    """Computed and measured responses of each experiment, and how large the residuals are."""
    plots, downloads, rows = [], [], []
    for number, item in enumerate(fit.experiments, start=1):
        lead = f"{plain(item.name)}{'' if item.fitted else ' (predicted)'}: "
        plots += _plots(fit, item, f"experiment-{number}", lead, item.name)
        file = re.sub(r"[^\w-]", "-", item.name)
        words = f"Download all samples of {item.name} as CSV"
        downloads.append(_samples(item, f"responses-{number}-{file}", words))
        note = cell("" if item.fitted else "predicted", mark=not item.fitted)
        rows += [(item.name, *row, note) for row in zip(*_residuals(item), strict=True)]
    table = Table.of_rows("residuals", "Residuals", ("experiment", *NAMES, "note"), rows)
    return Section("Experiments", (_validation(fit), *plots, noted(table), *downloads))


def _validation(fit: Fit) -> str:
    """How what was not fitted is predicted, in a sentence; empty if all was fitted."""
    return "" if fit.validation is None else str(fit.validation)


def _misfits(fit: Fit, experiment: str) -> dict[str, float]:
    """Return where the model begins to leave the data of an experiment, by channel."""
    found = (item.values for item in fit.findings if item.code == "model-misfit")
    return {item["channel"]: item["at"] for item in found if item["experiment"] == experiment}


def _plots(fit: Fit, shown: Fit | ExperimentFit, name: str, lead: str = "", experiment: str = "") -> list[Plot]:
    """A figure for each quantity, named ``name-1`` …, its title after ``lead``, with the places of misfits."""
    plots, misfits, begins = [], _misfits(fit, experiment), first_predicted(shown)
    for place, chosen in enumerate(by_quantity(shown.data.channels), start=1):
        figure = charts.responses(shown, chosen, title=lead + ", ".join(map(plain, chosen)))
        if begins is not None:
            figure.add_vrect(x0=begins, x1=shown.data.coordinate.values[-1], fillcolor=LIGHT.muted, opacity=0.12)
        marks = [at for channel, at in misfits.items() if channel in chosen]
        for at in marks:
            figure.add_vline(x=at, row=2, col=1, line={"color": LIGHT.ink, "width": 1.5, "dash": "dash"})  # pyright: ignore[reportArgumentType]
        caption = [HOW, *([SHADED] if begins is not None else []), *([LEAVES] if marks else [])]
        plots.append(Plot(f"{name}-{place}", figure, " ".join(caption)))
    return plots


def first_predicted(shown: Fit | ExperimentFit) -> float | None:
    """Where the samples at the end that were not fitted begin; None where there are none, or only such."""
    fitted = np.flatnonzero(np.any(shown.weights > 0, axis=1))
    along = shown.data.coordinate.values
    if len(fitted) == 0 or fitted[-1] == len(along) - 1:
        return None
    return float(along[fitted[-1] : fitted[-1] + 2].mean())


def _residuals(shown: Fit | ExperimentFit | RegularisedFit | CrossValidation) -> tuple:
    """Columns of the channels: rms and largest residual, where that is, deviation of the data, and unit."""
    data = shown.data
    residuals = np.where(np.isfinite(shown.residuals), shown.residuals, 0.0)  # 0 where a value is missing
    counts = np.count_nonzero(np.isfinite(data.values), axis=0)
    largest = np.abs(residuals)
    return (
        data.channels,
        cells((np.sqrt(np.sum(column**2) / count) for column, count in zip(residuals.T, counts, strict=True)), 4),
        cells(largest.max(axis=0), 4),
        data.coordinate.values[largest.argmax(axis=0)],
        np.full(len(data.channels), np.nan) if data.deviations is None else data.deviations,
        map(unit, data.channels),
    )


def _samples(shown: Fit | ExperimentFit | RegularisedFit | CrossValidation, name: str, words: str) -> Download:
    """Measured and computed samples, unless they are too many for a page."""
    data = shown.data
    return samples(name, data.coordinate, data.channels, {"measured": data.values, "computed": shown.response}, words)


LEAST = 10
"""Fewest values of a channel that is drawn and tested."""

SIGNIFICANT = 0.001
"""Probability of a test from which it is marked."""

MOST_OUTLIERS = 50
INFLUENTIAL = 10
DIAGNOSTICS_HOW = (
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
    caption = " ".join([DIAGNOSTICS_HOW, *([CHOOSE] if len(found.series) > 1 else [])])
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
