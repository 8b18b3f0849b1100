"""How often 95 % intervals contain the truth, for three kinds of noise that is estimated with the parameters.

``python -m benchmarks coverage`` takes 500 seeds on all cores; the environment variable ``SEEDS`` another number.
"""

import os
import sys
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

from benchmarks.timing import report

SEEDS = 500
TESTS = Path(__file__).parents[1] / "tests"


def main() -> None:
    """Write the shares by deviations, profiles and the posterior, a row for each kind of noise and parameter."""
    sys.path.append(str(TESTS))
    from noise_coverage import CASES

    seeds = int(os.environ.get("SEEDS", SEEDS))
    with ProcessPoolExecutor() as pool:
        rows = [row for number in range(len(CASES)) for row in _rows(pool, number, seeds)]
    report("coverage", "Coverage of 95 % intervals where the noise is estimated with the parameters", rows)


def _rows(pool: ProcessPoolExecutor, number: int, seeds: int) -> Iterator[dict[str, object]]:
    from noise_coverage import CASES, METHODS, TRUTH

    found = list(pool.map(contained, [number] * seeds, range(seeds), chunksize=5))
    for name in TRUTH:
        row: dict[str, object] = {"noise": CASES[number].name, "parameter": name}
        for method in (*METHODS, "posterior"):
            row[f"coverage by {method}, %"] = 100 * sum(one[method, name] for one in found) / seeds
        yield row | {"seeds": seeds}


def contained(number: int, seed: int) -> dict[tuple[str, str], bool]:
    """Whether the intervals of one seed contain the truth, by method and parameter."""
    from noise_coverage import CASES, contains

    return contains(CASES[number], seed, posterior=True)
