"""The chaotic two-link arm: ten digits by high orders beside the five of generalized-alpha."""

from functools import partial
from pathlib import Path

import numpy as np

import dalembert as da
from benchmarks.timing import interleaved, report
from dalembert.study import load

ARM = Path(__file__).parents[1] / "studies" / "two-link-arm" / "simulate.toml"
TIMES = np.arange(6.0)
CHANNELS = ["upper.centre.angle", "lower.centre.angle"]
EXACT = da.RadauIIA(1e-11, stages=7)
SOLVERS = {
    "generalized-alpha": da.GeneralizedAlpha(2.2e-4, spectral_radius=0.95),
    "Radau IIA, order 5": da.RadauIIA(3e-10, stages=3),
    "Radau IIA, order 9": da.RadauIIA(3e-8),
    "Radau IIA, order 13": da.RadauIIA(1e-9, stages=7),
}


def main() -> None:
    """Time five seconds of motion by each; errors are of both angles at whole seconds, as parts of the largest one."""
    system = load(ARM).system()
    runs = {name: partial(da.simulate, system, TIMES[-1], solver, TIMES) for name, solver in SOLVERS.items()}
    times = interleaved(runs, repeats=31)
    exact = da.simulate(system, TIMES[-1], EXACT, TIMES).channels(CHANNELS)
    rows: list[dict[str, object]] = []
    for name, seconds in times.items():
        motion = runs[name]()
        rows.append(
            {
                "method": name,
                "steps": int(motion.run.counts[0]),
                "milliseconds": 1e3 * seconds,
                "ratio to generalized-alpha": seconds / times["generalized-alpha"],
                "relative error": float(np.abs(motion.channels(CHANNELS) - exact).max() / np.abs(exact).max()),
            }
        )
    report("digits", f"Two-link arm: {TIMES[-1]:g} s, digits against time", rows)
