"""Bounds of the response over a box of parameters."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from dalembert.intervals import Box
from dalembert.report import charts
from dalembert.report.look import plain
from dalembert.report.plot import Plot
from dalembert.report.quantities import by_quantity, labelled, unit
from dalembert.report.sections.samples import samples
from dalembert.report.sections.section import Section
from dalembert.report.table import Cell, Table, cell, noted
from dalembert.uncertainty import Propagation

MEANING = {
    "inner bound": "Runs of the model within the box reach both sides of the band; the true one may be wider",
    "estimate": "Whatever the parameters are within their intervals, the response lies about in the band",
    "enclosure of the surrogate": "Whatever the parameters are within their intervals, the surrogate lies in the band, "
    "and the response as far as the estimated error of the surrogate holds",
}


@dataclass(frozen=True)
class Bounds(Section):
    """The box, a figure of the bounds for each quantity, and how wide they are."""

    name: ClassVar[str] = "bounds"
    heading: ClassVar[str] = "Bounds"
    result: Propagation

    @property
    def plots(self) -> tuple[Plot, ...]:
        channels = self.result.channels
        chosen = [[channels[number] for number in group] for group in by_quantity(channels)]
        return tuple(
            Plot(
                f"bands-{place}",
                charts.bands(self.result, group, title=", ".join(plain(name) for name in group)),
                f"{MEANING[self.result.kind]}; below, how wide the band is.",
            )
            for place, group in enumerate(chosen, start=1)
        )

    @property
    def box(self) -> Table:
        return box_table(self.result.box, "Intervals of the parameters")

    @property
    def table(self) -> Table:
        result, along = self.result, self.result.coordinate
        width = result.upper - result.lower
        corners = at_corners(result)
        rows = [
            (
                cell(channel),
                cell(float(width[:, column].max())),
                cell(float(along.values[width[:, column].argmax()])),
                cell(float(width[:, column].mean())),
                cell("unknown" if result.error is None else float(result.error[:, column].max()), digits=2),
                *([] if corners is None else [_percent(corners[column])]),
                cell(unit(channel, result.units[column])),
            )
            for column, channel in enumerate(result.channels)
        ]
        columns = [
            "channel",
            "largest width",
            labelled(f"at {along.name}", along.unit),
            "mean width",
            "estimated error",
        ]
        columns += [] if corners is None else ["taken at corners of the box"]
        return noted(Table("widths", "Widths", [*columns, "unit"], rows))

    @property
    def reasons(self) -> tuple[str, ...]:
        """Why the error is unknown; empty where it is estimated."""
        return tuple(finding.message for finding in self.result.findings if finding.code == "unknown-error")

    @property
    def samples(self) -> Table | None:
        """All bounds, for download, unless they are too many for a page."""
        result = self.result
        series = {"lower": result.lower, "upper": result.upper}
        return samples("bounds", result.coordinate, result.channels, series)


def _percent(part: float) -> Cell:
    return Cell(float(part), f"{100 * part:.0f} %")


def box_table(box: Box, caption: str, name: str = "box") -> Table:
    """Ends, middle and radius of each interval of a box."""
    middle, radius = (box.lower + box.upper) / 2, (box.upper - box.lower) / 2
    rows = [
        tuple(cell(entry) for entry in (parameter, *map(float, numbers)))
        for parameter, *numbers in zip(box.names, box.lower, box.upper, middle, radius, strict=True)
    ]
    return Table(name, caption, ("parameter", "lower", "upper", "middle", "radius"), rows)


def at_corners(result: Propagation) -> np.ndarray | None:
    """Part of each channel's bounds that are taken at a corner of the box, (channels,); None where it is not known."""
    if result.at_lower is None or result.at_upper is None:
        return None
    at = np.stack([result.at_lower, result.at_upper])
    near = 1e-6 * (result.box.upper - result.box.lower)
    on_end = (at <= result.box.lower + near) | (at >= result.box.upper - near)
    return on_end.all(axis=-1).mean(axis=(0, 1))
