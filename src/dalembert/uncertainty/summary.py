"""Results of propagations as text."""

from collections.abc import Sequence

from dalembert.results import fixed_lines
from dalembert.uncertainty.propagation import Propagation


def summary(result: Propagation) -> str:
    """Table of channels with their widths, and of intervals; then kind, effort and status."""
    widths = [("channel", "unit", "largest width", "mean width", "estimated error")]
    for column, name in enumerate(result.channels):
        width = result.width[:, column]
        error = "unknown" if result.error is None else f"{result.error[:, column].max():.2g}"
        widths.append((name, result.units[column], f"{width.max():.5g}", f"{width.mean():.5g}", error))
    box = [("parameter", "lower", "upper"), *((n, f"{i.lower:.7g}", f"{i.upper:.7g}") for n, i in result.box.items())]
    facts = [
        f"method   {result.method}",
        f"kind     {result.kind}",
        f"runs     {result.runs}" + (f", {len(result.failures)} failed" if result.failures else ""),
        f"seconds  {result.seconds:.2f}",
        *fixed_lines(result, width=8),
    ]
    return "\n".join([*table(widths), "", *table(box), "", *facts, "", result.status, *map(str, result.findings)])


def table(rows: Sequence[Sequence[str]]) -> list[str]:
    """Lines of a text table; the first row is its head."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows]
    return [lines[0], "─" * (sum(widths) + 2 * (len(widths) - 1)), *lines[1:]]
