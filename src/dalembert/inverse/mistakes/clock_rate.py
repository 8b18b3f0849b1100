"""The clock of a record is too fast or too slow."""

from collections.abc import Iterator
from functools import partial

import numpy as np

from dalembert.findings import Finding
from dalembert.inverse.mistakes.clocks import RESOLUTION, Clock, clocks
from dalembert.inverse.mistakes.record import FittedRecord, Mistake, Verdict

LARGEST = 0.1
"""Largest relative error of a clock."""

STEPS = 40
"""Most errors that are tried on each side."""


def clock_rate(record: FittedRecord) -> Iterator[Mistake]:
    """Yield the mistake for the clock of each experiment, and of all."""
    for clock in clocks(record, channels=False):
        step = clock.period / RESOLUTION / clock.length  # the error at the end of the record
        count = int(min(STEPS, np.ceil(LARGEST / step)))
        numbers = min(step, LARGEST / count) * np.arange(-count, count + 1)
        stretched = partial(_stretched, clock)
        yield Mistake(stretched, partial(_finding, clock), numbers[numbers != 0], shown_at=stretched)


def _stretched(clock: Clock, response: np.ndarray, error: float, rows: np.ndarray | None = None) -> np.ndarray:
    return clock.read(response, lambda along: along / (1 + error), rows)


def _finding(clock: Clock, verdict: Verdict) -> Finding:
    percent = f"{100 * abs(verdict.number):.3g} %"
    whose = f" of {clock.name!r}" if clock.name else ""
    return Finding(
        "suspect-clock-rate",
        "warning",
        {"record": clock.name, "error": verdict.number, "explained": verdict.explained},
        f"The clock{whose} seems to be {percent} too {'fast' if verdict.number > 0 else 'slow'}. {verdict.sentence}",
        f"Check the sampling rate. If it is wrong, divide the times by {1 + verdict.number:.5g}.",
    )
