"""Modes of a structure: at rest, over the speed of rotation, and after a reduction."""

import numpy as np

from dalembert.report import charts
from dalembert.report.headline import headline_of
from dalembert.report.options import ReportOptions
from dalembert.report.registry import sections_of
from dalembert.report.scene.shape import MOST
from dalembert.report.section import Motion, Plot, Section
from dalembert.structure import Campbell, ModeShapes, ReductionErrors
from dalembert.tables import percent, shown


@sections_of(ModeShapes)
def mode_shapes(modes: ModeShapes, options: ReportOptions) -> list[Section]:
    """The modes."""
    how = "The slider goes through the modes; thin lines: at rest; dark: nodal lines. Drag to turn the view."
    how += f" Drawn are the first {MOST}." if len(modes.frequencies) > MOST else ""
    film = Motion("mode-shapes", charts.mode_shapes(modes), how)
    return [headline_of(modes), Section("Mode shapes", (film, *modes.tables()))]


@sections_of(Campbell)
def campbell(diagram: Campbell, options: ReportOptions) -> list[Section]:
    """The Campbell diagram, critical speeds, and frequencies at each speed."""
    whirls = "Solid lines: modes that whirl forward; dashed: backward; dotted: along a line."
    plot = Plot("campbell", charts.campbell(diagram), whirls)
    return [headline_of(diagram), Section("Modes over the speed", (plot, *diagram.tables()))]


@sections_of(ReductionErrors)
def reduction_errors(errors: ReductionErrors, options: ReportOptions) -> list[Section]:
    """The errors of frequencies and shapes."""
    return [headline_of(errors), reduced(errors)]


def reduced(errors: ReductionErrors) -> Section:
    """The section on a reduction."""
    text = f"The lowest {len(errors.full)} frequencies of the reduced structure are at most "
    text += f"{percent(np.max(errors.relative), 2)} too high, and their shapes are similar by "
    text += f"{shown(float(np.min(errors.similarity)), digits=4)} and more."
    plot = Plot("reduction-errors", charts.reduction_errors(errors), "What is zero to rounding is not drawn.")
    return Section("Reduction", (text, plot, *errors.tables()))
