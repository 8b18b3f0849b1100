"""The times of a record are shifted."""

from collections.abc import Iterator
from functools import partial

import numpy as np

from dalembert.findings import Finding
from dalembert.inverse.mistakes.clocks import RESOLUTION, Clock, clocks
from dalembert.inverse.mistakes.record import FittedRecord, Mistake, Verdict

LONGEST = 0.25
"""Longest delay, as a part of the record."""

STEPS = 48
"""Most delays that are tried on each side."""


def late_clock(record: FittedRecord) -> Iterator[Mistake]:
    """Yield the mistake for the clock of each experiment, of all, and of each channel.

    Delays by less than a twelfth of a period leave residuals that are proportional to the rate of the response: the
    finding ``suspect-delay`` estimates them better.
    """
    for clock in clocks(record, channels=True):
        step = clock.period / RESOLUTION
        count = int(min(STEPS, LONGEST * clock.length // step))
        if count:
            numbers = step * np.arange(-count, count + 1)
            yield Mistake(partial(_late, clock), partial(_finding, clock), numbers[numbers != 0], least=step)


def _late(clock: Clock, response: np.ndarray, delay: float) -> np.ndarray:
    return clock.read(response, [own.along - delay for own in clock.series])


def _finding(clock: Clock, verdict: Verdict) -> Finding:
    late, size = verdict.number > 0, f"{abs(verdict.number):.3g}"
    whose = f"of {clock.name!r}" if clock.name else "of the record" if len(clock.series) == 1 else "of all records"
    return Finding(
        "suspect-clock",
        "warning",
        {"record": clock.name, "delay": verdict.number, "explained": verdict.explained},
        f"The times {whose} seem to be {size} s {'late' if late else 'early'}. {verdict.sentence}",
        f"Check when the motion begins. If it begins at this time, write start = {verdict.number:.3g} in [data], or "
        f"use since({verdict.number:.3g}) in Python.",
    )
