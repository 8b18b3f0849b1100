"""Bands that were given against those that the identified intervals reproduce."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from dalembert.inverse import BandFit
from dalembert.report import charts
from dalembert.report.charts.residual_bands import reproduced
from dalembert.report.look import plain
from dalembert.report.plot import Plot
from dalembert.report.quantities import by_quantity, labelled, unit
from dalembert.report.sections.samples import samples
from dalembert.report.sections.section import Section
from dalembert.report.table import Table, cell, noted


@dataclass(frozen=True)
class GivenBands(Section):
    """Given and reproduced bands, a figure for each quantity, and how large the residuals are."""

    name: ClassVar[str] = "comparison"
    heading: ClassVar[str] = "Bands"
    fit: BandFit

    @property
    def plots(self) -> tuple[Plot, ...]:
        channels = self.fit.bands.channels
        chosen = [[channels[number] for number in group] for group in by_quantity(channels)]
        return tuple(
            Plot(
                f"residual-bands-{place}",
                charts.residual_bands(self.fit, group, title=", ".join(plain(name) for name in group)),
                "Filled: the bands given; dashed: reproduced with the identified intervals; below, reproduced minus "
                "given, lower bounds solid and upper ones dotted. Residuals that no noise explains say that no "
                "intervals give these bands.",
            )
            for place, group in enumerate(chosen, start=1)
        )

    @property
    def table(self) -> Table:
        bands = self.fit.bands
        rows = []
        for column, channel in enumerate(bands.channels):
            for side, found in reproduced(self.fit).items():
                residual = np.abs(found[:, column] - getattr(bands, side)[:, column])
                rows.append(
                    (
                        cell(channel),
                        cell(side),
                        cell(float(np.sqrt(np.mean(residual**2))), digits=3),
                        cell(float(residual.max()), digits=3),
                        cell(float(bands.coordinate.values[residual.argmax()])),
                        cell(unit(channel)),
                    )
                )
        at = labelled(f"largest at {bands.coordinate.name}", bands.coordinate.unit)
        columns = ("channel", "bound", "rms residual", "largest residual", at, "unit")
        return noted(Table("band-residuals", "Residuals of the bounds", columns, rows))

    @property
    def samples(self) -> Table | None:
        """All bounds, given and reproduced, for download, unless they are too many for a page."""
        bands = self.fit.bands
        series = {}
        for side, found in reproduced(self.fit).items():
            series |= {f"{side} given": getattr(bands, side), f"{side} reproduced": found}
        return samples("bands", bands.coordinate, bands.channels, series)
