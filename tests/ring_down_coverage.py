"""How often 95 % intervals of frequency and damping contain those of the periodic motion, from noisy decays.

``python tests/ring_down_coverage.py`` repeats it with the 400 seeds of the table, and writes the counts into it.
"""

import json
import sys
from concurrent.futures import ProcessPoolExecutor
from functools import cache
from pathlib import Path

import numpy as np

import dalembert as da
from ring_downs import SEVERAL_SLIDERS

TABLE = Path(__file__).parent / "verification" / "references" / "ring_down_coverage.json"
SEEDS, FIRST, NOISE = 400, 2000, 0.12
LEVELS = (0.7, 0.35, 0.18, 0.1)
"""Parts of the first amplitude, near which an interval is looked at."""
NAMES = tuple(f"{name} at {level:g}" for level in LEVELS for name in ("frequency", "damping"))


@cache
def periodic() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Logarithms of amplitudes, frequencies, Hz, and damping ratios of periodic motions."""
    sizes = np.geomspace(0.05, 1.0, 160) * SEVERAL_SLIDERS.start
    return np.log(sizes), *SEVERAL_SLIDERS.periodic(sizes)


def errors(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Errors of the points near the levels, and their standard deviations, (levels, 2) each."""
    mode = da.ring_down(SEVERAL_SLIDERS.record(0, NOISE, seed), quantity="displacement")
    rows = [int(np.argmin(np.abs(np.log(mode.amplitudes / (level * SEVERAL_SLIDERS.start))))) for level in LEVELS]
    logs, frequencies, ratios = periodic()
    places = np.log(mode.amplitudes[rows])
    truth = np.stack([np.interp(places, logs, frequencies), np.interp(places, logs, ratios)], axis=1)
    values = np.stack([mode.frequencies[rows], mode.damping[rows]], axis=1)
    deviations = np.stack([mode.frequency_deviations[rows], mode.damping_deviations[rows]], axis=1)
    return values - truth, deviations


def contains(seed: int) -> list[bool]:
    """Whether each interval contains the truth, by the quantile of the normal distribution."""
    wrong, deviations = errors(seed)
    return (np.abs(wrong) <= 1.959964 * deviations).ravel().tolist()


def main() -> None:
    with ProcessPoolExecutor() as pool:
        results = np.array(list(pool.map(contains, range(FIRST, FIRST + SEEDS), chunksize=10)))
    table = {
        "seeds": SEEDS,
        "first": FIRST,
        "contained": dict(zip(NAMES, results.sum(axis=0).tolist(), strict=True)),
        "in the first ten": results[:10].sum(axis=0).tolist(),
    }
    TABLE.write_text(json.dumps(table, indent=1) + "\n", encoding="utf-8")
    sys.stdout.write(f"{table}\n")


if __name__ == "__main__":
    main()
