"""The plate with rubbing patches: a curve of 700 points with the split of its time, and its Jacobian by differences."""

import cProfile
import importlib.util
import pstats
import time
from pathlib import Path
from types import ModuleType

import numpy as np

from benchmarks import timing
from dalembert import HarmonicBalance, frequency_response
from dalembert.threads import single_thread
from dalembert.vibration.balance.equations import equations

STUDY = Path(__file__).parents[1] / "studies" / "patched-plate" / "plate.py"
PRELOAD, POINTS, ENDS = 75.0, 700, (394.0, 407.0)
METHOD = HarmonicBalance(harmonics=5, sampling=1e-3)
PARTS = {
    "condensation": ("condensation.py", ("at",)),
    "law of friction": ("contact_sums.py", ("with_slopes", "forces")),
    "linear systems": ("block_tangent.py", ("solve",)),
}
"""Files and functions whose time is a part of the curve's."""


def main() -> list[dict[str, object]]:
    system = _study().build(preload=PRELOAD)
    frequencies = np.linspace(*ENDS, POINTS)
    frequency_response(system, frequencies[:2], METHOD)
    before, profile = time.process_time(), cProfile.Profile(time.process_time)
    curve = profile.runcall(frequency_response, system, frequencies, METHOD, observe=["left", "right"])
    seconds = time.process_time() - before
    stats = pstats.Stats(profile).stats  # type: ignore[attr-defined]
    split = {
        part: sum(entry[3] for (path, _, name), entry in stats.items() if path.endswith(file) and name in names)
        for part, (file, names) in PARTS.items()
    }
    exact, differences = _jacobians(curve.unknowns[POINTS // 2 - 1], float(frequencies[POINTS // 2 - 1]), system)
    row: dict[str, object] = {
        "points": POINTS, "found": int(curve.converged.sum()), "unknowns": int(curve.unknowns[0].size),
        "iterations a point": float(curve.iterations.mean()), "seconds": seconds,
        **{f"{part}, s": value for part, value in split.items()},
        "else, s": seconds - sum(split.values()),
        "exact Jacobian, ms": exact * 1e3, "by differences, ms": differences * 1e3, "ratio": differences / exact,
    }  # fmt: skip
    timing.report(
        "plate", f"Plate with patches, preload {PRELOAD:g} N: a curve of {POINTS} points, processor seconds", [row]
    )
    return [row]


def _jacobians(unknowns: np.ndarray, frequency: float, system: object) -> tuple[float, float]:
    """Seconds for a residual with its exact Jacobian, and for as many residuals as one by differences takes."""
    problem = equations(system, METHOD)  # type: ignore[arg-type]
    with single_thread():
        balance, point = problem.balance(128), problem.condensation.at(2 * np.pi * frequency)
        times = timing.interleaved(
            {
                "exact": lambda: balance.linearised(point, unknowns),
                "residual": lambda: balance.at(point, unknowns),
            }
        )
    return times["exact"], times["residual"] * (unknowns.size + 1)


def _study() -> ModuleType:
    spec = importlib.util.spec_from_file_location("plate", STUDY)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


if __name__ == "__main__":
    main()
