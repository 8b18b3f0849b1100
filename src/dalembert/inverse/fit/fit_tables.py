"""Facts and tables of a fit: parameters, noise, halves of the records, residuals, nodes and starts."""

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from dalembert.forward import Coordinate
from dalembert.inverse.experiments.residual_table import COLUMNS, residual_columns, residual_table
from dalembert.inverse.fit.starts_table import starts_table
from dalembert.inverse.misfit.halves import Halves
from dalembert.inverse.problem.combinations import amounts
from dalembert.inverse.problem.nodes import Nodes
from dalembert.parameter import Parameter
from dalembert.parameters import Parameters
from dalembert.tables import Cell, Table, cell, cells, counted, labelled, noted, shown

if TYPE_CHECKING:
    from dalembert.inverse.fit.fit import Fit

ON_BOUND = 1e-6
"""Part of the way between the bounds within which a value counts as on one."""


def fit_facts(fit: "Fit") -> dict[str, str]:
    """Return method, misfit and effort of a fit, and what converged steps of the integrator would change."""
    facts = {
        "method": fit.method,
        "misfit": shown(fit.misfit, digits=3),
        "fitted values": counted(int(np.count_nonzero(fit.weights))),
        "simulations": counted(fit.simulations),
    }
    if len(fit.starts) > 1:
        facts["starts converged"] = f"{sum(start.success for start in fit.starts)} of {len(fit.starts)}"
    if (bias := fit.integration) is not None and not bias.failed:
        facts["bias by the integrator"] = f"{amounts(fit.parameters, bias.bias)} (by one simulation {bias.how})"
        facts["misfit with converged steps"] = shown(bias.misfit, digits=3)
        facts["misfit with corrected values"] = shown(bias.corrected, digits=3)
    return facts


def fit_tables(fit: "Fit") -> Iterator[Table]:
    """Yield the tables of a fit, the most important first."""
    yield _parameters(fit)
    if fit.noise is not None and not fit.noise.known:
        caption = "Noise, estimated with the parameters"
        noise = _values(fit.noise.parameters.items, fit.noise.values, fit.noise.deviations)
        yield noted(Table.of("noise", caption, {**noise, **_bounds(fit.noise.parameters.items)}))
    if fit.halves is not None:
        yield _halves(fit.halves, fit.parameters)
    yield _experiments(fit) if fit.experiments else residual_table(fit)
    if fit.nodes is not None:
        yield _nodes(fit.nodes, [fit, *fit.experiments][-1].data.coordinate)
    if fit.starts:
        yield starts_table(fit.starts, fit.parameters.names)


def on_bound(parameters: Parameters, values: np.ndarray) -> np.ndarray:
    """Return which values lie on a bound (parameters,); of a logarithmic search the logarithms count."""
    shares = parameters.shares(values)
    return (shares <= ON_BOUND) | (shares >= 1 - ON_BOUND)


def _parameters(fit: "Fit") -> Table:
    """Return the identified values, then the fixed ones."""
    stuck, items = on_bound(fit.parameters, fit.values), fit.parameters.items
    columns = _values(items, fit.values, fit.deviations)
    columns["value"] = [Cell(x.value, x.text, bool(mark)) for x, mark in zip(columns["value"], stuck, strict=True)]
    if not np.array_equal(fit.plain_deviations, fit.deviations, equal_nan=True):
        columns["for independent residuals"] = cells(fit.plain_deviations, 2)
    if np.all(np.isfinite(fit.integration_bias)):
        columns["bias by the integrator"] = cells(fit.integration_bias, 2)
    columns |= _bounds(items)
    columns["note"] = [cell("on its bound" if mark else "", mark=bool(mark)) for mark in stuck]
    rows = [
        *zip(*columns.values(), strict=True),
        *(
            tuple(
                {"parameter": x.name, "value": float(x.lower), "unit": x.unit, "note": "fixed"}.get(c, "")
                for c in columns
            )
            for x in fit.parameters.fixed
        ),
    ]
    return noted(Table.of_rows("parameters", "Identified values", tuple(columns), rows))


def _values(items: Sequence[Parameter], values: np.ndarray, deviations: np.ndarray) -> dict[str, list]:
    """Return the columns of names, values and standard deviations."""
    return {
        "parameter": [item.name for item in items],
        "value": [cell(value, deviation) for value, deviation in zip(values, deviations, strict=True)],
        "standard deviation": cells(deviations, 2),
    }


def _bounds(items: Sequence[Parameter]) -> dict[str, list]:
    return {
        "unit": [item.unit for item in items],
        "lower bound": [float(item.lower) for item in items],
        "upper bound": [float(item.upper) for item in items],
    }


def _halves(halves: Halves, parameters: Parameters) -> Table:
    """Return the values of the first and of the second half of the records; in summaries only if they differ."""
    columns: dict[str, Sequence[object]] = {"parameter": parameters.names}
    for half, values, deviations in zip(("first", "second"), halves.values, halves.deviations, strict=True):
        columns[f"{half} half"] = [cell(value, size) for value, size in zip(values, deviations, strict=True)]
        columns[f"deviation, {half}"] = cells(deviations, 2)
    columns["difference / deviation"] = [
        cell(size, digits=2, mark=bool(mark)) for size, mark in zip(halves.differences, halves.drifting, strict=True)
    ]
    columns["unit"] = [item.unit for item in parameters.items]
    how = "fitted to each half" if halves.refitted else "one step from the values of the whole record"
    caption = f"First and second half of the record ({how})"
    return noted(Table.of("halves", caption, columns, detail=not np.any(halves.drifting)))


def _experiments(fit: "Fit") -> Table:
    """Return how large the residuals of each experiment are."""
    rows = []
    for item in fit.experiments:
        note = cell("" if item.fitted else "predicted", mark=not item.fitted)
        rows += [(item.name, *row, note) for row in zip(*residual_columns(item), strict=True)]
    return noted(Table.of_rows("residuals", "Residuals", ("experiment", *COLUMNS, "note"), rows))


def _nodes(nodes: Nodes, along: Coordinate) -> Table:
    """Return the states at which segments meet, and their gaps."""
    columns: dict[str, Iterable[object]] = {"experiment": nodes.experiments} if any(nodes.experiments) else {}
    columns |= {"sample": nodes.samples, labelled(along.name, along.unit): nodes.times}
    for name, unit, values in zip(nodes.states, nodes.units, nodes.begins.T, strict=True):
        columns[labelled(name, unit)] = ["" if np.isnan(value) else value for value in values]
    columns["largest gap"] = cells(np.nanmax(abs(nodes.ends - nodes.begins), axis=1), 2)
    return Table.of("nodes", "States found where segments meet", columns, detail=True)
