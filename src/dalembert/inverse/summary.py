"""A fit as text."""

import numpy as np

from dalembert.inverse.fit import Fit


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
    ]
    return "\n".join([*table(rows), "", *facts, "", fit.status, *fit.identifiability().sentences])


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
