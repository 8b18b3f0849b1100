"""Modes of a rotating system over its speed."""

import numpy as np

from dalembert.report import charts
from dalembert.report.asked import Asked
from dalembert.report.digits import counted, shown
from dalembert.report.headline import Headline
from dalembert.report.quantities import labelled
from dalembert.report.registry import sections_of
from dalembert.report.section import Fold, Plot, Section
from dalembert.report.table import Table
from dalembert.structure import Campbell


@sections_of(Campbell)
def campbell(diagram: Campbell, asked: Asked) -> list[Section]:
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
