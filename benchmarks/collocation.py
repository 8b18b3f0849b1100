"""The two-link arm by collocation: the published fireflies beside Gauss and Newton and other minimisers."""

from functools import partial
from pathlib import Path

import numpy as np

import dalembert as da
from benchmarks.timing import interleaved, report
from dalembert.study import load

ARM = Path(__file__).parents[1] / "studies" / "two-link-arm" / "simulate.toml"
STEP, END = 0.01, 2.0
SOLVERS = {
    "Gauss-Newton": da.Collocation(STEP),
    "fireflies as published": da.Collocation(STEP, da.Firefly()),
    "SciPy's least squares": da.Collocation(STEP, da.LeastSquares()),
    "Gauss-Newton, order 4": da.Collocation(STEP, degree=3, gauss_points=2),
    "Gauss-Newton, order 6": da.Collocation(STEP, degree=4, gauss_points=3),
    "generalized-alpha": da.GeneralizedAlpha(STEP),
}


def energy_error(motion: da.Trajectory) -> float:
    """Largest relative error of the energy."""
    total = motion.energies["total"]
    return float(np.max(np.abs(total / total[0] - 1)))


def main() -> None:
    """Time the first two seconds by each; the ratios of longer motions are the same."""
    system = load(ARM).system()
    runs = {name: partial(da.simulate, system, END, solver=solver) for name, solver in SOLVERS.items()}
    times = interleaved(runs, repeats=3)
    rows: list[dict[str, object]] = [
        {
            "method": name,
            "milliseconds a step": 1e3 * seconds * STEP / END,
            "ratio to Gauss-Newton": seconds / times["Gauss-Newton"],
            "energy error": energy_error(runs[name]()),
        }
        for name, seconds in times.items()
    ]
    report("collocation", f"Two-link arm: {END:g} s at {1e3 * STEP:g} ms", rows)
