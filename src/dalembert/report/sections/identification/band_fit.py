"""Intervals identified from bands."""

from collections.abc import Mapping

import numpy as np

from dalembert.inverse import BandFit
from dalembert.quantities import by_quantity, unit
from dalembert.report import charts
from dalembert.report.charts.identification.intervals import reproduced
from dalembert.report.headline import Headline
from dalembert.report.look import plain
from dalembert.report.options import ReportOptions
from dalembert.report.registry import sections_of
from dalembert.report.section import Plot, Section, samples
from dalembert.report.sections.identification.search import identifiability, identified, search
from dalembert.tables import Table, cell, cells, counted, few_values, interval, labelled, marks, noted, shown

NONE = 1e-6
"""Radii below this part of the way between the search bounds are none."""


@sections_of(BandFit)
def band_fit(fit: BandFit, options: ReportOptions) -> list[Section]:
    """Intervals, the bands, and the search."""
    return [_headline(fit), _intervals(fit, options.truth), _bands(fit), *search(fit), identifiability(fit)]


def _headline(fit: BandFit) -> Headline:
    checked = fit.checked_misfit
    facts = {
        **few_values(fit.parameters, map(interval, fit.box.lower, fit.box.upper)),
        "misfit": shown(fit.misfit, digits=3),
        **({} if checked is None else {"misfit by true runs": shown(checked, digits=3)}),
        "simulations": counted(fit.simulations),
    }
    return identified(fit, "Identified intervals", facts)


def _intervals(fit: BandFit, truth: Mapping[str, tuple[float, float]]) -> Section:
    """Middles and radii with standard deviations, the intervals that they make, and the true ones if known."""
    caption = "Each interval where it lies between its search bounds; whiskers are two standard deviations of its ends"
    caption += ", diamonds the true ends." if truth else "."
    return Section("Parameters", (_table(fit, truth), Plot("intervals", charts.intervals(fit, truth), caption)))


def _table(fit: BandFit, truth: Mapping[str, tuple[float, float]]) -> Table:
    names = fit.parameters.names
    true = {
        f"true {side}": [truth.get(name, (np.nan, np.nan))[end] for name in names]
        for end, side in enumerate(("lower", "upper"))
    }
    columns = {
        "parameter": names,
        "lower": fit.box.lower,
        "upper": fit.box.upper,
        **(true if truth else {}),
        "middle": map(cell, fit.middle, fit.middle_deviations),
        "deviation of the middle": cells(fit.middle_deviations, 2),
        "radius": map(cell, fit.radius, fit.radius_deviations),
        "deviation of the radius": cells(fit.radius_deviations, 2),
        "unit": [item.unit for item in fit.parameters],
        "note": marks(_note(fit, k) for k in range(len(names))),
    }
    return Table.of("intervals", "Identified intervals", columns)


def _note(fit: BandFit, k: int) -> str:
    """Whether an interval is one, or a single number as far as the bands tell."""
    if fit.radius[k] <= NONE * (fit.parameters.upper[k] - fit.parameters.lower[k]):
        return "a single number"
    return "possibly a single number" if fit.radius[k] <= 2 * fit.radius_deviations[k] else ""


def _bands(fit: BandFit) -> Section:
    """Given and reproduced bands, a figure for each quantity, and how large the residuals are."""
    bands, found = fit.bands, reproduced(fit)
    how = (
        "Filled: the bands given; dashed: reproduced with the identified intervals; below, reproduced minus "
        "given, lower bounds solid and upper ones dotted. Residuals that no noise explains say that no "
        "intervals give these bands."
    )
    plots = [
        Plot(f"residual-bands-{place}", charts.residual_bands(fit, group, title=", ".join(map(plain, group))), how)
        for place, group in enumerate(by_quantity(bands.channels), start=1)
    ]
    series = {}
    for side, values in found.items():
        series |= {f"{side} given": getattr(bands, side), f"{side} reproduced": values}
    words = "Download all samples as CSV"
    return Section(
        "Bands", (*plots, _residuals(fit), samples("bands", bands.coordinate, bands.channels, series, words))
    )


def _residuals(fit: BandFit) -> Table:
    bands, rows = fit.bands, []
    for column, channel in enumerate(bands.channels):
        for side, found in reproduced(fit).items():
            residual = np.abs(found[:, column] - getattr(bands, side)[:, column])
            sizes = cells((np.sqrt(np.mean(residual**2)), residual.max()), 3)
            rows.append((channel, side, *sizes, bands.coordinate.values[residual.argmax()], unit(channel)))
    at = labelled(f"largest at {bands.coordinate.name}", bands.coordinate.unit)
    names = ("channel", "bound", "rms residual", "largest residual", at, "unit")
    return noted(Table.of_rows("band-residuals", "Residuals of the bounds", names, rows))
