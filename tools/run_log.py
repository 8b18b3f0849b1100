"""Results and durations of tests, from the log of a run with ``-v --durations=0``."""

import re
from collections import Counter

_RESULT = re.compile(r"^(?:\[gw\d+\] \[ *\d+%\] )?(PASSED|FAILED|SKIPPED|ERROR) (\S+::.*?) *$", re.MULTILINE)
_DURATION = re.compile(r"^([0-9.]+)s (?:call|setup|teardown) +(\S.*)$", re.MULTILINE)


def results(log: str) -> dict[str, str]:
    """Return the result of each test."""
    return {test: result for result, test in _RESULT.findall(log)}


def seconds(log: str) -> Counter[str]:
    """Return what each test took, with set-up and the kernels that it was the first to compile."""
    durations: Counter[str] = Counter()
    for duration, test in _DURATION.findall(log):
        durations[test] += float(duration)
    return durations
