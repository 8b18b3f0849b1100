"""The response of a fit compared with the data, and its residuals."""

import re
from collections.abc import Iterable

import numpy as np

from dalembert.inverse import CrossValidation, ExperimentFit, Fit, RegularisedFit
from dalembert.quantities import by_quantity
from dalembert.report import charts
from dalembert.report.charts.identification.residual_diagnostics import doubted
from dalembert.report.look import LIGHT, plain
from dalembert.report.section import Download, Plot, Section, samples
from dalembert.tables import Table

HOW = "Lines are computed with the identified values, circles are data; below, computed minus measured."
LEAVES = "At the dashed line the residuals leave the noise: from there on the model does not follow the data."
SHADED = "The shaded part was not fitted."
DIAGNOSTICS_HOW = (
    "Residuals are computed minus measured values in standard deviations of their channel. Dotted lines contain 95 % "
    "of the autocorrelations of independent noise. Samples far to the right in the last panel determine the fit most."
)
LEAST = 10
"""Fewest values of a channel that is drawn and tested."""


def compared(fit: Fit, tables: Iterable[Table]) -> Section:
    """Computed and measured responses, of each experiment a figure for each quantity, and the residuals."""
    validation = "" if fit.validation is None else str(fit.validation)
    if not fit.experiments:
        shown = (*_plots(fit, fit, "responses"), *tables, _samples(fit, "responses"))
        return Section("Response and data", (validation, *shown))
    plots, downloads = [], []
    for number, item in enumerate(fit.experiments, start=1):
        lead = f"{plain(item.name)}{'' if item.fitted else ' (predicted)'}: "
        plots += _plots(fit, item, f"experiment-{number}", lead, item.name)
        file = re.sub(r"[^\w-]", "-", item.name)
        downloads.append(_samples(item, f"responses-{number}-{file}", f" of {item.name}"))
    return Section("Experiments", (validation, *plots, *tables, *downloads))


def compared_simply(fit: RegularisedFit | CrossValidation, tables: Iterable[Table], how: str = HOW) -> Section:
    """Computed and measured responses without marks, and the residuals."""
    plots = [
        Plot(f"responses-{place}", charts.responses(fit, chosen, title=", ".join(map(plain, chosen))), how)
        for place, chosen in enumerate(by_quantity(fit.data.channels), start=1)
    ]
    return Section("Response and data", (*plots, *tables, _samples(fit, "responses")))


def _plots(fit: Fit, shown: Fit | ExperimentFit, name: str, lead: str = "", experiment: str = "") -> list[Plot]:
    """A figure for each quantity, named ``name-1`` …, its title after ``lead``, with the places of misfits."""
    findings = [item.values for item in fit.findings if item.code == "model-misfit"]
    misfits = {item["channel"]: item["at"] for item in findings if item["experiment"] == experiment}
    plots, begins = [], first_predicted(shown)
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


def _samples(shown: Fit | ExperimentFit | RegularisedFit | CrossValidation, name: str, of: str = "") -> Download:
    """Measured and computed samples, unless they are too many for a page."""
    data, words = shown.data, f"Download all samples{of} as CSV"
    return samples(name, data.coordinate, data.channels, {"measured": data.values, "computed": shown.response}, words)


def residuals(fit: Fit) -> list[Section]:
    """The section on residuals; none where no channel has ten values."""
    diagnostics = fit.diagnostics()
    if all(len(item.residuals) < LEAST for item in diagnostics.series):
        return []
    drawn = doubted(diagnostics)
    choose = " Click a name in the legend to show or hide a channel." if len(diagnostics.series) > 1 else ""
    blocks = [
        ""
        if diagnostics.tested
        else "The residuals are not tested: they are rounding errors, or not those of a minimum.",
        f"The figure has the {len(drawn)} channels that the tests doubt most."
        if len(diagnostics.series) > len(drawn)
        else "",
        Plot("residual-diagnostics", charts.residual_diagnostics(diagnostics), f"{DIAGNOSTICS_HOW}{choose}"),
        *diagnostics.tables(),
    ]
    return [Section("Residuals", blocks)]
