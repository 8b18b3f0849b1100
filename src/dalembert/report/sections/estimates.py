"""Table of the identified parameters."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from dalembert.inverse import Fit
from dalembert.parameters import Parameter
from dalembert.report import charts
from dalembert.report.charts.parameters import on_bound
from dalembert.report.plot import Plot
from dalembert.report.sections.section import Section
from dalembert.report.table import Cell, Table, cell, noted


@dataclass(frozen=True)
class Estimates(Section):
    """Values with standard deviations and bounds; a value on a bound is marked."""

    name: ClassVar[str] = "estimates"
    heading: ClassVar[str] = "Parameters"
    fit: Fit

    @property
    def table(self) -> Table:
        fit = self.fit
        stuck = on_bound(fit)
        columns: dict[str, list[Cell]] = {
            "parameter": [cell(item.name) for item in fit.parameters],
            "value": [
                cell(float(value), deviation, mark=bool(mark))
                for value, deviation, mark in zip(fit.values, fit.deviations, stuck, strict=True)
            ],
            "standard deviation": _short(fit.deviations),
        }
        plain = fit.plain_deviations
        if not np.array_equal(plain, fit.deviations, equal_nan=True):
            columns["for independent residuals"] = _short(plain)
        bias = fit.integration_bias
        if np.all(np.isfinite(bias)):
            columns["bias by the integrator"] = _short(bias)
        columns |= {
            "unit": [cell(item.unit) for item in fit.parameters],
            "lower bound": [cell(float(item.lower)) for item in fit.parameters],
            "upper bound": [cell(float(item.upper)) for item in fit.parameters],
            "note": [cell("on its bound" if mark else "", mark=bool(mark)) for mark in stuck],
        }
        rows = [*zip(*columns.values(), strict=True), *(_fixed(item, tuple(columns)) for item in fit.parameters.fixed)]
        return noted(Table("parameters", "Identified values", tuple(columns), rows))

    @property
    def halves(self) -> Table | None:
        """Values of the first and of the second half of the records; None where they are not known."""
        found = self.fit.halves
        if found is None:
            return None
        columns: dict[str, list[Cell]] = {"parameter": [cell(item.name) for item in self.fit.parameters]}
        for half, values, deviations in zip(("first", "second"), found.values, found.deviations, strict=True):
            columns[f"{half} half"] = [cell(float(v), d) for v, d in zip(values, deviations, strict=True)]
            columns[f"deviation, {half}"] = _short(deviations)
        columns["difference / deviation"] = [
            cell(float(size), digits=2, mark=bool(mark))
            for size, mark in zip(found.differences, found.drifting, strict=True)
        ]
        columns["unit"] = [cell(item.unit) for item in self.fit.parameters]
        how = "fitted to each half" if found.refitted else "one step from the values of the whole record"
        caption = f"First and second half of the record ({how})"
        return noted(Table("halves", caption, tuple(columns), [*zip(*columns.values(), strict=True)]))

    @property
    def plots(self) -> tuple[Plot, ...]:
        caption = "Each value where it lies between its bounds; bars are two standard deviations."
        return (Plot("parameters", charts.parameters(self.fit), caption),)


def _fixed(item: Parameter, columns: tuple[str, ...]) -> tuple[Cell, ...]:
    """Row of a fixed parameter."""
    known = {"parameter": item.name, "value": float(item.lower), "unit": item.unit, "note": "fixed"}
    return tuple(cell(known.get(column, "")) for column in columns)


def _short(numbers: np.ndarray) -> list[Cell]:
    return [cell(float(number), digits=2) for number in numbers]
