"""Fair clocks: candidates take turns, medians are compared, and what was measured is kept as JSON."""

import json
import os
import platform
import statistics
import time
from collections.abc import Callable, Mapping
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

FOLDER = Path("build") / "benchmarks"


def seconds(function: Callable[[], object]) -> float:
    """Wall-clock time of one call."""
    before = time.perf_counter()
    function()
    return time.perf_counter() - before


def interleaved(candidates: Mapping[str, Callable[[], object]], repeats: int = 7) -> dict[str, float]:
    """Median time of each candidate; they take turns, so that a busy moment of the machine meets all of them.

    Each candidate runs once before the clock starts, so that compilation and first touches are not in its time.
    """
    for candidate in candidates.values():
        candidate()
    times: dict[str, list[float]] = {name: [] for name in candidates}
    for _ in range(repeats):
        for name, candidate in candidates.items():
            times[name].append(seconds(candidate))
    return {name: statistics.median(values) for name, values in times.items()}


def table(title: str, rows: list[dict[str, object]]) -> None:
    """Print the rows below each other, columns aligned."""
    print(f"\n{title}")
    names = list(rows[0])
    cells = [names, *([_text(row.get(name, "")) for name in names] for row in rows)]
    widths = [max(len(line[column]) for line in cells) for column in range(len(names))]
    for line in cells:
        print("  " + "  ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)).rstrip())


def keep(name: str, rows: list[dict[str, object]]) -> None:
    """Write the rows and what they were measured on to build/benchmarks/<name>.json."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    (FOLDER / f"{name}.json").write_text(json.dumps({"machine": _machine(), "rows": rows}, indent=1) + "\n")


def _text(value: object) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def _machine() -> dict[str, object]:
    packages = {}
    for package in ("dalembert", "exudyn", "numba", "numpy", "scipy"):
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
