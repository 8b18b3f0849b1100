"""Modes of a structure: at rest, over the speed of rotation, and after a reduction."""

import numpy as np

from dalembert.report import charts
from dalembert.report.charts.frequency.shapes import MOST
from dalembert.report.headline import Headline
from dalembert.report.options import ReportOptions
from dalembert.report.registry import sections_of
from dalembert.report.section import Fold, Plot, Section
from dalembert.structure import Campbell, ModeShapes, ReductionErrors
from dalembert.tables import MOST_FACTS, Table, cells, counted, labelled, percent, shown


@sections_of(ModeShapes)
def mode_shapes(modes: ModeShapes, options: ReportOptions) -> list[Section]:
    """The modes."""
    numbers = range(1, len(modes.frequencies) + 1)
    how = "The slider goes through the modes; thin lines: at rest; dark: nodal lines."
    if len(numbers) > MOST:
        how += f" Drawn are the first {MOST}."
    lowest = zip(numbers, modes.frequencies[:MOST_FACTS], strict=False)
    headline = Headline(
        title="Modes",
        verdict="computed",
        status=f"{len(numbers)} natural frequencies and shapes of the undamped structure.",
        facts={f"mode {number}": f"{shown(float(frequency))} Hz" for number, frequency in lowest},
    )
    table = Table.of("modes", "Natural frequencies", {"mode": numbers, "frequency (Hz)": modes.frequencies})
    return [headline, Section("Mode shapes", (Plot("mode-shapes", charts.mode_shapes(modes), how), Fold(table)))]


@sections_of(Campbell)
def campbell(diagram: Campbell, options: ReportOptions) -> list[Section]:
    """The Campbell diagram, critical speeds, and frequencies at each speed."""
    facts = {
        "speeds": counted(len(diagram.speeds)),
        "highest speed": f"{shown(float(diagram.speeds.max()))} rad/s",
        "frame": diagram.frame,
    }
    for own in diagram.critical_speeds[:3]:
        facts[f"critical speed of mode {own.mode}"] = f"{shown(own.speed)} rad/s"
    headline = Headline.of("Campbell diagram", diagram.success, ("computed", "incomplete"), diagram.status, facts)
    whirls = "Solid lines: modes that whirl forward; dashed: backward; dotted: along a line."
    plot = Plot("campbell", charts.campbell(diagram), whirls)
    parts = [plot, *_critical(diagram), Fold(_frequencies(diagram), 0, "values")]
    return [headline, Section("Modes over the speed", tuple(parts))]


def _critical(diagram: Campbell) -> list[Table]:
    found = diagram.critical_speeds
    if not found:
        return []
    columns = {
        "critical speed (rad/s)": [own.speed for own in found],
        "frequency (Hz)": [own.speed / (2.0 * np.pi) for own in found],
        "mode": [own.mode for own in found],
        "whirl": [own.direction for own in found],
    }
    caption = (
        "Critical speeds: a mode has the frequency of the rotation. An unbalance excites those that whirl forward."
    )
    return [Table.of("critical-speeds", caption, columns)]


def _frequencies(diagram: Campbell) -> Table:
    columns = {labelled(diagram.parameter, diagram.unit): diagram.values, "fastest body (rad/s)": diagram.speeds}
    for number, frequencies in enumerate(diagram.frequencies.T, start=1):
        columns[f"mode {number} (Hz)"] = frequencies
        columns[f"damping ratio {number}"] = diagram.damping_ratios[:, number - 1]
    columns["growth (1/s)"] = diagram.growth
    return Table.of("campbell", f"Frequencies in the {diagram.frame} frame", columns)


@sections_of(ReductionErrors)
def reduction_errors(errors: ReductionErrors, options: ReportOptions) -> list[Section]:
    """The errors of frequencies and shapes."""
    headline = Headline(
        title="Reduction",
        verdict="compared",
        status="The lowest modes of the reduced structure beside those of the full one.",
        facts={
            "modes compared": counted(len(errors.full)),
            "largest error of a frequency": percent(np.max(errors.relative)),
            "least similarity of a shape": shown(float(np.min(errors.similarity)), digits=4),
        },
    )
    return [headline, reduced(errors)]


def reduced(errors: ReductionErrors) -> Section:
    """The section on a reduction."""
    told = f"The lowest {len(errors.full)} frequencies of the reduced structure are at most "
    told += f"{percent(np.max(errors.relative), 2)} too high, and their shapes are similar by "
    told += f"{shown(float(np.min(errors.similarity)), digits=4)} and more."
    columns = {
        "mode": range(1, len(errors.full) + 1),
        "full (Hz)": errors.full,
        "reduced (Hz)": errors.reduced,
        "error (%)": cells(100 * np.asarray(errors.relative), 3),
        "similarity of the shapes": errors.similarity,
    }
    plot = Plot("reduction-errors", charts.reduction_errors(errors), "What is zero to rounding is not drawn.")
    table = Table.of("reduction", "Modes of the full and the reduced structure", columns)
    return Section("Reduction", (told, plot, Fold(table)))
