"""Clocks of records that are shifted, too fast or too slow."""

from collections.abc import Iterator
from functools import partial

import numpy as np

from dalembert.findings import Finding
from dalembert.inverse.mistakes.clocks import RESOLUTION, Clock, clocks
from dalembert.inverse.mistakes.record import FittedRecord, Mistake, Verdict

LONGEST_DELAY = 0.25
"""Longest delay, as a part of the record."""

DELAYS = 48
"""Most delays that are tried on each side."""


def late_clock(record: FittedRecord) -> Iterator[Mistake]:
    """Yield the mistake for the clock of each experiment, of all, and of each channel. Delays by less than a twelfth of
    a period leave residuals that are proportional to the rate of the response: the finding ``suspect-delay`` estimates
    them better.
    """
    for clock in clocks(record, channels=True):
        step = clock.period / RESOLUTION
        count = int(min(DELAYS, LONGEST_DELAY * clock.length // step))
        if count:
            numbers = step * np.arange(-count, count + 1)
            late = partial(_late, clock)
            yield Mistake(late, partial(_delay_finding, clock), numbers[numbers != 0], least=step, shown_at=late)


def _late(clock: Clock, response: np.ndarray, delay: float, rows: np.ndarray | None = None) -> np.ndarray:
    return clock.read(response, lambda along: along - delay, rows)


def _delay_finding(clock: Clock, verdict: Verdict) -> Finding:
    late, size = verdict.number > 0, f"{abs(verdict.number):.3g}"
    several = len({signal.experiment for signal in clock.series}) > 1
    whose = f"of {clock.name!r}" if clock.name else "of all records" if several else "of the record"
    return Finding(
        "suspect-clock",
        "warning",
        {"record": clock.name, "delay": verdict.number, "explained": verdict.explained},
        f"The times {whose} seem to be {size} s {'late' if late else 'early'}. {verdict.sentence}",
        _of_channel(clock, verdict.number) if clock.name == clock.series[0].name else _of_record(clock, verdict.number),
    )


def _of_record(clock: Clock, delay: float) -> str:
    table = f"the table of experiment {clock.name!r}" if clock.name else "[data]"
    return (
        f"Check when the motion begins. If it begins at this time, write start = {delay:.3g} in {table}, or use "
        f"since({delay:.3g}) in Python."
    )


def _of_channel(clock: Clock, delay: float) -> str:
    if delay > 0:
        bounds = f"[{delay / 2:.2g}, {1.5 * delay:.2g}]"
        return f"Identify the delay of its sensor: [sensors] {clock.series[0].channel!r} = {{ delay = {bounds} }}."
    return "Check its times, and the delays of the other channels."


LARGEST_RATE = 0.1
"""Largest relative error of a clock."""

RATES = 40
"""Most errors that are tried on each side."""


def clock_rate(record: FittedRecord) -> Iterator[Mistake]:
    """Yield the mistake for the clock of each experiment, and of all."""
    for clock in clocks(record, channels=False):
        step = clock.period / RESOLUTION / clock.length  # the error at the end of the record
        count = int(min(RATES, np.ceil(LARGEST_RATE / step)))
        numbers = min(step, LARGEST_RATE / count) * np.arange(-count, count + 1)
        stretched = partial(_stretched, clock)
        yield Mistake(stretched, partial(_rate_finding, clock), numbers[numbers != 0], shown_at=stretched)


def _stretched(clock: Clock, response: np.ndarray, error: float, rows: np.ndarray | None = None) -> np.ndarray:
    return clock.read(response, lambda along: along / (1 + error), rows)


def _rate_finding(clock: Clock, verdict: Verdict) -> Finding:
    percent = f"{100 * abs(verdict.number):.3g} %"
    whose = f" of {clock.name!r}" if clock.name else ""
    return Finding(
        "suspect-clock-rate",
        "warning",
        {"record": clock.name, "error": verdict.number, "explained": verdict.explained},
        f"The clock{whose} seems to be {percent} too {'fast' if verdict.number > 0 else 'slow'}. {verdict.sentence}",
        f"Check the sampling rate. If it is wrong, divide the times by {1 + verdict.number:.5g}.",
    )
