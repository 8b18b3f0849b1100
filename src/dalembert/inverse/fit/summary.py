"""A fit as text."""

import numpy as np

from dalembert.inverse.fit.fit import Fit
from dalembert.results import fixed_lines


def summary(fit: Fit) -> str:
    """Table of parameters with deviations, unit and bounds; then fitness, effort, status and warnings."""
    rows = [("parameter", "value", "± deviation", "unit", "bounds")]
    for item, value, deviation in zip(fit.parameters, fit.values, fit.deviations, strict=True):
        known = "unknown" if np.isnan(deviation) else f"{deviation:.2g}"
        rows.append((item.name, f"{value:.7g}", known, item.unit, f"{item.lower:.6g} to {item.upper:.6g}"))
    facts = [
        f"method       {fit.method}",
        f"fitness      {fit.fitness:.6g} (weighted sum of squares of {int(fit.data.present.sum())} values)",
        f"simulations  {fit.simulations}",
        f"starts       {len(fit.starts)}",
        *integration_facts(fit),
        *fixed_lines(fit),
    ]
    experiments = experiments_table(fit)
    told = [fit.status, *([] if fit.validation is None else [str(fit.validation)]), *fit.identifiability().sentences]
    told += map(str, fit.findings)
    return "\n".join([*table(rows), "", *facts, "", *experiments, *halves_table(fit), *told])


def integration_facts(fit: Fit) -> list[str]:
    """Lines on the bias by the integrator and on the misfit with converged steps; none without an estimate."""
    found = fit.integration
    if found is None or found.failed:
        return []
    biases = ", ".join(
        f"{item.name} {f'{bias:.2g} {item.unit}'.rstrip()}"
        for item, bias in zip(fit.parameters, found.bias, strict=True)
    )
    return [
        f"integrator   bias of the values {biases} (by one simulation {found.how})",
        f"             fitness with converged steps {found.fitness:.6g}, with corrected values {found.corrected:.6g}",
    ]


def experiments_table(fit: Fit) -> list[str]:
    """Lines of a table of experiments and their residuals, with an empty one after it; none for a single one."""
    if not fit.experiments:
        return []
    rows = [("experiment", "channel", "samples", "rms residual", "")]
    for item in fit.experiments:
        for column, channel in enumerate(item.data.channels):
            own = item.residuals[item.data.present[:, column], column]
            rms = f"{np.sqrt(np.mean(own**2)):.4g}"
            rows.append((item.name, channel, str(len(own)), rms, "" if item.fitted else "predicted"))
    return [*table(rows), ""]


def halves_table(fit: Fit) -> list[str]:
    """Lines of a table of the parameters of the halves, with an empty one after it; none where they agree."""
    found = fit.halves
    if found is None or not np.any(found.drifting):
        return []
    rows = [("parameter", "first half", "second half", "difference / deviation")]
    for k, name in enumerate(fit.parameters.names):
        first, second = (
            "not determined" if np.isnan(value) else f"{value:.5g} ± {deviation:.2g}"
            for value, deviation in zip(found.values[:, k], found.deviations[:, k], strict=True)
        )
        size = found.differences[k]
        rows.append((name, first, second, "" if np.isnan(size) else f"{size:.2g}"))
    return [*table(rows), ""]


def table(rows: list[tuple[str, ...]]) -> list[str]:
    """Lines of a table, its first row the head.

    >>> print(*table([("name", "value"), ("mass", "2")]), sep="\\n")
    name  value
    ───────────
    mass  2
    """
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows]
    return [lines[0], "─" * (sum(widths) + 2 * (len(widths) - 1)), *lines[1:]]
