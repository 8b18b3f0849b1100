"""Write the page about a whole run of the tests, from its log with ``-v --durations=0``: ``whole_run.py LOG``."""

import re
import sys
from collections import Counter
from pathlib import Path

from run_log import results, seconds

PAGE = Path(__file__).parents[1] / "docs" / "whole-run.md"
_TOTAL = re.compile(r"^=+ (.* in [0-9.]+s.*?) =+$", re.MULTILINE)
_PROCESSOR = re.compile(r"^(\d+)m([0-9.]+)s (\d+)m([0-9.]+)s$", re.MULTILINE)
COLUMNS = ("PASSED", "SKIPPED", "FAILED", "ERROR")
LONGEST = 15


def folder_of(test: str) -> str:
    """Return the folder of a test, two levels deep; examples in docstrings and pages by their root."""
    parts = test.split("::")[0].split("/")
    return "/".join(parts[:2]) if parts[0] == "tests" else parts[0]


def page(log: str) -> str:
    """Return the page: counts of results for each folder, and the tests that take longest."""
    counts = Counter((folder_of(test), result) for test, result in results(log).items())
    minutes = [60 * float(user) + float(more) + 60 * float(system) + float(rest)
               for user, more, system, rest in _PROCESSOR.findall(log)]  # fmt: skip
    rows = [
        (folder, *(str(counts[folder, column]) for column in COLUMNS))
        for folder in sorted({folder for folder, _ in counts})
    ]
    longest = [(test, f"{duration:.0f}") for test, duration in seconds(log).most_common(LONGEST)]
    return "\n".join(
        [
            "# A whole run of the tests",
            "",
            "*Written by `tools/whole_run.py` from the log of `make verify`.*",
            "",
            f"{_TOTAL.findall(log)[-1]}; {max(minutes, default=0.0):.0f} s of processor time on two cores.",
            "",
            *_table(("tests of", "passed", "skipped", "failed", "errors"), rows),
            "",
            *[f"Failed: `{test}`." for test, result in results(log).items() if result in ("FAILED", "ERROR")],
            "",
            "The tests that take longest, with their set-up:",
            "",
            *_table(("test", "s"), longest),
            "",
        ]
    )


def _table(head: tuple[str, ...], rows: list[tuple[str, ...]]) -> list[str]:
    lines = [head, ("---",) * len(head), *rows]
    return [f"| {' | '.join(cell.replace('|', '/') for cell in line)} |" for line in lines]


if __name__ == "__main__":
    PAGE.write_text(page(Path(sys.argv[1]).read_text()))
    print(PAGE)
