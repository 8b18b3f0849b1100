"""Responses against data, of one record or of several experiments."""

import re

import numpy as np

from dalembert.inverse import CrossValidation, ExperimentFit, Fit, RegularisedFit
from dalembert.report import charts
from dalembert.report.look import LIGHT, plain
from dalembert.report.quantities import by_quantity, labelled, unit
from dalembert.report.section import Download, Plot, Section
from dalembert.report.sections.samples import samples
from dalembert.report.table import Table, cell, cells, noted

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
