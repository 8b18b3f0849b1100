"""Identified parameters: estimates, and what is known beyond the fit."""

from collections.abc import Iterable

import numpy as np

from dalembert.inverse import Fit, Population, Prediction, Profiles
from dalembert.multibody import Trajectory
from dalembert.parameters import Parameter
from dalembert.report import charts
from dalembert.report.charts.identification.parameters import on_bound
from dalembert.report.headline import Headline
from dalembert.report.options import ReportOptions
from dalembert.report.registry import sections_of
from dalembert.report.section import Listed, Plot, Section
from dalembert.report.sections.identification.assessment import predicted, profiled
from dalembert.report.sections.identification.population import varied
from dalembert.report.sections.identification.response import compared, experiments, residuals
from dalembert.report.sections.identification.search import identifiability, identified, search, shooting
from dalembert.report.sections.motion.trajectory import diagnostics, mechanisms
from dalembert.tables import Cell, Table, cell, cells, counted, few_values, noted, shown, with_deviation


def estimates(fit: Fit) -> Section:
    """The identified values, and those of the two halves of the records where they are known."""
    caption = "Each value where it lies between its bounds; bars are two standard deviations."
    return Section(
        "Parameters", (_values(fit), *_noise(fit), Plot("parameters", charts.parameters(fit), caption), *_halves(fit))
    )


def _values(fit: Fit) -> Table:
    stuck, items = on_bound(fit), list(fit.parameters)
    values = map(cell, fit.values, fit.deviations)
    columns: dict[str, Iterable[object]] = {
        "parameter": [item.name for item in items],
        "value": [Cell(one.value, one.text, bool(mark)) for one, mark in zip(values, stuck, strict=True)],
        "standard deviation": cells(fit.deviations, 2),
    }
    if not np.array_equal(fit.plain_deviations, fit.deviations, equal_nan=True):
        columns["for independent residuals"] = cells(fit.plain_deviations, 2)
    if np.all(np.isfinite(fit.integration_bias)):
        columns["bias by the integrator"] = cells(fit.integration_bias, 2)
    columns |= {
        "unit": [item.unit for item in items],
        "lower bound": [float(item.lower) for item in items],
        "upper bound": [float(item.upper) for item in items],
        "note": [cell("on its bound" if mark else "", mark=bool(mark)) for mark in stuck],
    }
    table = Table.of("parameters", "Identified values", columns)
    fixed = [_fixed(item, table.columns) for item in fit.parameters.fixed]
    return noted(Table(table.name, table.caption, table.columns, [*table.rows, *fixed]))


def _noise(fit: Fit) -> list[Table]:
    """Parameters of noise that was estimated with those of the model."""
    found = fit.noise
    if found is None or found.known:
        return []
    items = list(found.parameters)
    columns: dict[str, Iterable[object]] = {
        "parameter": [item.name for item in items],
        "value": map(cell, found.values, found.deviations),
        "standard deviation": cells(found.deviations, 2),
        "unit": [item.unit for item in items],
        "lower bound": [float(item.lower) for item in items],
        "upper bound": [float(item.upper) for item in items],
    }
    return [noted(Table.of("noise", "Noise, estimated with the parameters", columns))]


def _fixed(item: Parameter, columns: Iterable[str]) -> tuple[Cell, ...]:
    """Row of a fixed parameter."""
    known = {"parameter": item.name, "value": float(item.lower), "unit": item.unit, "note": "fixed"}
    return tuple(cell(known.get(column, "")) for column in columns)


def _halves(fit: Fit) -> list[Table]:
    """Values of the first and of the second half of the records, where they are known."""
    found = fit.halves
    if found is None:
        return []
    columns: dict[str, Iterable[object]] = {"parameter": [item.name for item in fit.parameters]}
    for half, values, deviations in zip(("first", "second"), found.values, found.deviations, strict=True):
        columns[f"{half} half"] = map(cell, values, deviations)
        columns[f"deviation, {half}"] = cells(deviations, 2)
    columns["difference / deviation"] = [
        cell(size, digits=2, mark=bool(mark)) for size, mark in zip(found.differences, found.drifting, strict=True)
    ]
    columns["unit"] = [item.unit for item in fit.parameters]
    how = "fitted to each half" if found.refitted else "one step from the values of the whole record"
    return [noted(Table.of("halves", f"First and second half of the record ({how})", columns))]


@sections_of(Fit)
def fit(result: Fit, options: ReportOptions) -> list[Section]:
    """Estimates, the response against the data, the residuals, the motion, the search, and what is known beyond."""
    moving, profiles, predictions = options.each(Trajectory), options.first(Profiles), options.each(Prediction)
    population = options.first(Population)
    data = {"": result.data, **{item.name: item.data for item in result.experiments}}
    return [
        _headline(result),
        estimates(result),
        experiments(result) if result.experiments else compared(result),
        *residuals(result),
        *mechanisms(moving, options.points, data),
        *search(result),
        *([] if result.nodes is None else [shooting(result, result.nodes)]),
        identifiability(result),
        *([varied(population, Listed([str(one) for one in population.findings]))] if population is not None else []),
        *([profiled(profiles)] if profiles is not None else []),
        *([predicted(predictions)] if predictions else []),
        *([diagnostics(moving)] if moving else []),
    ]


def _headline(result: Fit) -> Headline:
    converged = sum(start.success for start in result.starts)
    facts = {
        **few_values(result.parameters, map(with_deviation, result.values, result.deviations)),
        "misfit": shown(result.misfit, digits=3),
        "simulations": counted(result.simulations),
    }
    if len(result.starts) > 1:
        facts["starts converged"] = f"{converged} of {len(result.starts)}"
    return identified(result, "Identified parameters", facts)
