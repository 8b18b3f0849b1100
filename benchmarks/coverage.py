"""How often 95 % intervals contain the truth, for three kinds of noise that is estimated with the parameters.

``python -m benchmarks coverage`` takes 500 seeds; the environment variable ``SEEDS`` another number.
"""

import os
import sys
from pathlib import Path

from benchmarks.timing import report

SEEDS = 500
TESTS = Path(__file__).parents[1] / "tests"


def main() -> None:
    """Write the shares by deviations and by profiles, a row for each kind of noise and parameter."""
    sys.path.append(str(TESTS))
    from noise_coverage import CASES, METHODS, TRUTH, covered

    seeds = int(os.environ.get("SEEDS", SEEDS))
    rows: list[dict[str, object]] = []
    for case in CASES:
        found = covered(case, range(seeds), METHODS)
        for name in TRUTH:
            shares = {f"coverage by {method}, %": 100 * found[method, name] for method in METHODS}
            rows.append({"noise": case.name, "parameter": name, **shares, "seeds": seeds})
    report("coverage", "Coverage of 95 % intervals where the noise is estimated with the parameters", rows)
