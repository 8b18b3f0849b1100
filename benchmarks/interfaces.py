"""A lap joint of many contact pairs by receptances: processor time of a point, beside a product of matrices.

The unit is one product of a dense matrix of 3,039 rows with 15 columns, timed in the same run.
"""

import resource
import sys
from multiprocessing import get_context
from time import process_time

import numpy as np
from tests.lap_joint import bars, lap_joint, tip

from benchmarks import timing
from dalembert import HarmonicBalance, frequency_response

CASES = (
    (4, 2, 3, 4.0),
    (4, 2, 7, 4.0),
    (8, 4, 3, 4.0),
    (12, 6, 7, 4.0),
    (18, 8, 7, 4.0),
    (26, 12, 7, 4.0),
    (26, 12, 7, 6.0),
)
"""Elements along and across the overlap, harmonics, force (N)."""
PATHS = ((4, 2, 3, 4.0), (26, 12, 7, 4.0))
"""Cases that are followed by arc length, too, with about 200 points."""
ROWS, COLUMNS = 3039, 15
FREQUENCIES = np.linspace(69.4, 72.27, 21)
RESOLUTION = 0.008


def main() -> list[dict[str, object]]:
    rows = [row for case in CASES for row in (_apart(*case, events) for events in (False, True))]
    timing.report("interfaces", "Lap joint of two bars on contact pairs alone, 21 points over its resonance", rows)
    paths = [_apart(*case, False, True) for case in PATHS]
    timing.report("interface-paths", "The same joint by arc length", paths)
    return [*rows, *paths]


def _apart(*case: object) -> dict[str, object]:
    """A row from a process of its own, whose largest memory is that of the case."""
    with get_context("spawn").Pool(1) as pool:
        return pool.apply(_row, case)


def _row(along: int, across: int, harmonics: int, force: float, events: bool, path: bool = False) -> dict[str, object]:
    mesh, between = bars(along, across)
    system, times = lap_joint(mesh, mesh, between, force, 10_000.0), []
    unit, begin = _unit(), process_time()
    method = HarmonicBalance(harmonics, samples=128, events=events, solver="receptance", resolution=RESOLUTION)
    way = {"continuation": "arc-length"} if path else {}
    curve = frequency_response(
        system, (FREQUENCIES[0], FREQUENCIES[-1]) if path else FREQUENCIES, method,
        observe=[f"{tip(mesh)}.z"], check=False, on_point=lambda _: times.append(process_time()), **way,
    )  # fmt: skip
    megabytes = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / (2**20 if sys.platform == "darwin" else 2**10)
    return {
        "pairs": len(between), "harmonics": harmonics, "force, N": force, "events": "yes" if events else "no",
        "a point, products": float(np.diff(times).mean()) / unit, "a point, s": float(np.diff(times).mean()),
        "set-up and first point, products": (times[0] - begin) / unit,
        "Newton iterations": float(curve.iterations[1:].mean()), "points found": int(curve.converged.sum()),
        "memory, MB": megabytes,
    }  # fmt: skip


def _unit() -> float:
    chance = np.random.default_rng(0)
    matrix, columns = chance.normal(size=(ROWS, ROWS)), chance.normal(size=(ROWS, COLUMNS))
    matrix @ columns
    begin = process_time()
    for _ in range(10):
        matrix @ columns
    return (process_time() - begin) / 10


if __name__ == "__main__":
    main()
