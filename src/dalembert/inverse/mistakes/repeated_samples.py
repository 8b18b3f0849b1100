"""Samples that repeat the one before: a logger that was slower than its clock."""

from collections.abc import Iterator, Sequence
from functools import partial

import numpy as np

from dalembert.findings import Finding
from dalembert.inverse.mistakes.patterns import FEWEST, plateaus, runs
from dalembert.inverse.mistakes.record import NONE, FittedRecord, Mistake, Verdict
from dalembert.inverse.noise.correlation.series import Series


def repeated_samples(record: FittedRecord) -> Iterator[Mistake]:
    """Yield the mistake for all series with repeated values."""
    repeats = {signal: _repeats(record.data_of(signal)) for signal in record.series}
    firsts = {signal: first for signal, first in repeats.items() if _count(first) >= FEWEST}
    if firsts:
        rows = np.concatenate([signal.rows for signal in firsts])
        sources = np.concatenate([signal.rows[first] for signal, first in firsts.items()])
        finding = partial(_finding, list(firsts), list(map(_count, firsts.values())))
        yield Mistake(partial(_kept, rows, sources), finding, NONE, visible=True)


def _repeats(data: np.ndarray) -> np.ndarray:
    """Number of the first value of each run; values that are lost or clipped are no runs."""
    return np.where((data == 0) | plateaus(data), np.arange(len(data)), runs(data))


def _count(first: np.ndarray) -> int:
    return int(np.count_nonzero(first != np.arange(len(first))))


def _kept(rows: np.ndarray, sources: np.ndarray, response: np.ndarray, _: float) -> np.ndarray:
    shown = response.copy()
    shown[rows] = response[sources]
    return shown


def _finding(series: Sequence[Series], counts: Sequence[int], verdict: Verdict) -> Finding:
    most = int(np.argmax(counts))
    return Finding(
        "repeated-samples",
        "warning",
        {"channel": series[most].name, "samples": counts[most], "explained": verdict.explained},
        f"{counts[most]} samples of {series[most].name!r} repeat the sample before. {verdict.sentence}",
        "Leave the repeated samples out: empty cells with missing = 'leave-out' in the study file, NaN in Python.",
    )
