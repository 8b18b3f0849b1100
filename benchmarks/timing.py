"""Fair clocks: candidates take turns, medians are compared, and what was measured is kept as JSON."""

import json
import os
import platform
import statistics
import time
from collections.abc import Callable, Mapping
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

RESULTS = Path(__file__).with_name("results")


def seconds(function: Callable[[], object], clock: Callable[[], float] = time.perf_counter) -> float:
    """Wall-clock time of one call; or that of another clock, such as the processor's."""
    before = clock()
    function()
    return clock() - before


def interleaved(
    candidates: Mapping[str, Callable[[], object]], repeats: int = 7, clock: Callable[[], float] = time.perf_counter
) -> dict[str, float]:
    """Median time of each candidate; they take turns, so that a busy moment of the machine meets all of them.

    Each candidate runs once before the clock starts, so that compilation and first touches are not in its time.
    """
    for candidate in candidates.values():
        candidate()
    times: dict[str, list[float]] = {name: [] for name in candidates}
    for _ in range(repeats):
        for name, candidate in candidates.items():
            times[name].append(seconds(candidate, clock))
    return {name: statistics.median(values) for name, values in times.items()}


def report(name: str, title: str, rows: list[dict[str, object]], figure: str = "") -> None:
    """Print the rows below each other, and keep them in results/<name>.json with what they were measured on.

    ``figure``: name of a file in docs/pictures that the page shows.
    """
    print(f"\n{title}")
    names = list(rows[0])
    cells = [names, *([text(row.get(name, "")) for name in names] for row in rows)]
    widths = [max(len(line[column]) for line in cells) for column in range(len(names))]
    for line in cells:
        print("  " + "  ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)).rstrip())
    RESULTS.mkdir(exist_ok=True)
    kept = {"title": title, "machine": _machine(), "rows": rows, **({"figure": figure} if figure else {})}
    (RESULTS / f"{name}.json").write_text(json.dumps(kept, indent=1) + "\n")


def text(value: object) -> str:
    """A cell of a table."""
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def _machine() -> dict[str, object]:
    packages = {}
    for package in ("dalembert", "exudyn", "pyharm-os", "pymoo", "cma", "pin", "numba", "numpy", "scipy"):
        try:
            packages[package] = version(package)
        except PackageNotFoundError:
            packages[package] = "absent"
    return {
        "processor": _processor(),
        "cores": os.cpu_count(),
        "python": platform.python_version(),
        "packages": packages,
    }


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return platform.processor()
    return next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), platform.machine())
