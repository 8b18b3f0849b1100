"""Responses against data."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from dalembert.inverse import ExperimentFit, Fit
from dalembert.report import charts
from dalembert.report.look import LIGHT, plain
from dalembert.report.plot import Plot
from dalembert.report.quantities import by_quantity, labelled, unit
from dalembert.report.sections.samples import samples
from dalembert.report.sections.section import Section
from dalembert.report.table import Cell, Table, cell, noted

HOW = "Lines are computed with the identified values, circles are data; below, computed minus measured."
LEAVES = "At the dashed line the residuals leave the noise: from there on the model does not follow the data."
SHADED = "The shaded part was not fitted."


@dataclass(frozen=True)
class Comparison(Section):
    """Computed and measured responses, a figure for each quantity, and how large the residuals are."""

    name: ClassVar[str] = "comparison"
    heading: ClassVar[str] = "Response and data"
    fit: Fit

    @property
    def validation(self) -> str:
        """How what was not fitted is predicted, in a sentence; empty if all was fitted."""
        return validation(self.fit)

    @property
    def plots(self) -> tuple[Plot, ...]:
        return plots(self.fit, "responses", misfits=misfits(self.fit))

    @property
    def table(self) -> Table:
        rows = [tuple(row) for row in residual_cells(self.fit)]
        at = labelled(f"largest at {self.fit.data.coordinate.name}", self.fit.data.coordinate.unit)
        columns = ("channel", "rms residual", "largest residual", at, "deviation of the data", "unit")
        return noted(Table("residuals", "Residuals", columns, rows))

    @property
    def samples(self) -> Table | None:
        """All samples, for download, unless they are too many for a page."""
        return all_samples(self.fit, "responses")


def validation(fit: Fit) -> str:
    """How what was not fitted is predicted, in a sentence; empty if all was fitted."""
    return "" if fit.validation is None else str(fit.validation)


def misfits(fit: Fit, experiment: str = "") -> dict[str, float]:
    """Return where the model begins to leave the data of an experiment, by channel."""
    found = (item.values for item in fit.findings if item.code == "model-misfit")
    return {item["channel"]: item["at"] for item in found if item["experiment"] == experiment}


def plots(
    compared: Fit | ExperimentFit, name: str, lead: str = "", misfits: Mapping[str, float] | None = None
) -> tuple[Plot, ...]:
    """A figure for each quantity, named ``name-1`` …, its title after ``lead``, with the places of ``misfits``."""
    channels = compared.data.channels
    found = []
    for place, group in enumerate(by_quantity(channels), start=1):
        chosen = [channels[number] for number in group]
        figure = charts.responses(compared, chosen, title=lead + ", ".join(plain(name) for name in chosen))
        begins = first_predicted(compared)
        if begins is not None:
            figure.add_vrect(x0=begins, x1=compared.data.coordinate.values[-1], fillcolor=LIGHT.muted, opacity=0.12)
        marks = [at for channel, at in (misfits or {}).items() if channel in chosen]
        for at in marks:
            figure.add_vline(x=at, row=2, col=1, line={"color": LIGHT.ink, "width": 1.5, "dash": "dash"})  # pyright: ignore[reportArgumentType]
        caption = [HOW, *([SHADED] if begins is not None else []), *([LEAVES] if marks else [])]
        found.append(Plot(f"{name}-{place}", figure, " ".join(caption)))
    return tuple(found)


def first_predicted(compared: Fit | ExperimentFit) -> float | None:
    """Where the samples at the end that were not fitted begin; None where there are none, or only such."""
    fitted = np.flatnonzero(np.any(compared.weights > 0, axis=1))
    along = compared.data.coordinate.values
    return (
        None if len(fitted) == 0 or fitted[-1] == len(along) - 1 else float(along[fitted[-1] : fitted[-1] + 2].mean())
    )


def residual_cells(compared: Fit | ExperimentFit) -> list[list[Cell]]:
    """Cells of each channel: its name, rms and largest residual, where that is, deviation of the data, and unit."""
    data = compared.data
    residuals = np.where(np.isfinite(compared.residuals), compared.residuals, 0.0)  # 0 where a value is missing
    counts = np.count_nonzero(np.isfinite(data.values), axis=0)
    deviations = np.full(len(data.channels), np.nan) if data.deviations is None else data.deviations
    return [
        [
            cell(channel),
            cell(float(np.sqrt(np.sum(residuals[:, column] ** 2) / counts[column])), digits=4),
            cell(float(np.abs(residuals[:, column]).max()), digits=4),
            cell(float(data.coordinate.values[np.abs(residuals[:, column]).argmax()])),
            cell(float(deviations[column])),
            cell(unit(channel)),
        ]
        for column, channel in enumerate(data.channels)
    ]


def all_samples(compared: Fit | ExperimentFit, name: str) -> Table | None:
    """Measured and computed samples, unless they are too many for a page."""
    data = compared.data
    series = {"measured": data.values, "computed": compared.response}
    return samples(name, data.coordinate, data.channels, series)
