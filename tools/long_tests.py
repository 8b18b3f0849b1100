"""Write the list of tests that only `make verify` runs, from the log of a whole run with ``--durations=0 -v``.

A test that takes more than a second is on the list. Each file keeps its fastest test in `make test`. Example studies
are all in it.
"""

import sys
from collections import defaultdict
from pathlib import Path

from run_log import results, seconds

LIST = Path(__file__).parents[1] / "tests" / "long_tests.txt"
LONGEST = 1.0  # s, with set-up and the kernels that it is the first to compile
ALWAYS = "tests/studies/"
"""Tests of example studies, which each change must pass."""


def long_tests(log: str) -> list[str]:
    """Return the tests that take longer than `LONGEST`, but for the fastest of each file."""
    durations, files = seconds(log), defaultdict(list)
    for test in results(log):
        files[test.split("::")[0]].append(test)
    kept = {min(tests, key=lambda test: durations[test]) for tests in files.values()}
    return sorted(
        test for test, duration in durations.items()
        if duration > LONGEST and test not in kept and test.startswith("tests/") and not test.startswith(ALWAYS)
    )  # fmt: skip


if __name__ == "__main__":
    listed = set(LIST.read_text().splitlines()) if LIST.exists() else set()
    LIST.write_text("\n".join(sorted(listed | set(long_tests(Path(sys.argv[1]).read_text())))) + "\n")
