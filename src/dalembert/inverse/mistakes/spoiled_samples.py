"""Samples that were lost, are clipped, or repeat the one before."""

from collections.abc import Iterator, Sequence
from functools import partial

import numpy as np

from dalembert.findings import Finding
from dalembert.inverse.mistakes.patterns import FEWEST, plateaus, runs
from dalembert.inverse.mistakes.record import NONE, FittedRecord, Mistake, Verdict, without
from dalembert.inverse.noise.correlation.series import Series


def dropouts(record: FittedRecord) -> Iterator[Mistake]:
    """Yield the mistake for all series with zeros."""
    lost = {signal: record.data_of(signal) == 0 for signal in record.series}
    zeros = {signal: zero for signal, zero in lost.items() if FEWEST <= np.count_nonzero(zero) < len(zero)}
    if zeros:
        rows = np.concatenate([signal.rows[zero] for signal, zero in zeros.items()])
        counts = [int(np.count_nonzero(zero)) for zero in zeros.values()]
        finding = partial(_dropout_finding, list(zeros), counts)
        yield Mistake(partial(without, rows), finding, NONE, blamed=rows, visible=True)


def _dropout_finding(series: Sequence[Series], counts: Sequence[int], verdict: Verdict) -> Finding:
    most = int(np.argmax(counts))
    return Finding(
        "zero-dropouts",
        "warning",
        {"channel": series[most].name, "samples": counts[most], "explained": verdict.explained},
        f"{counts[most]} samples of {series[most].name!r} are exactly 0, and seem to be lost. {verdict.sentence}",
        "Leave the lost samples out: empty cells with missing = 'leave-out' in the study file, NaN in Python.",
    )


def clipped(record: FittedRecord) -> Iterator[Mistake]:
    """Yield the mistake for all series with several values at their largest or smallest value."""
    ends = {signal: mask for signal in record.series if np.any(mask := plateaus(record.data_of(signal)))}
    if ends:
        rows = np.concatenate([signal.rows[mask] for signal, mask in ends.items()])
        counts = [int(np.count_nonzero(mask)) for mask in ends.values()]
        levels = [float(np.max(np.abs(record.data_of(signal)[mask]))) for signal, mask in ends.items()]
        finding = partial(_clipped_finding, list(ends), counts, levels)
        yield Mistake(partial(without, rows), finding, NONE, blamed=rows, visible=True)


def _clipped_finding(
    series: Sequence[Series], counts: Sequence[int], levels: Sequence[float], verdict: Verdict
) -> Finding:
    most = int(np.argmax(counts))
    return Finding(
        "clipped-samples",
        "warning",
        {"channel": series[most].name, "samples": counts[most], "level": levels[most], "explained": verdict.explained},
        f"{counts[most]} samples of {series[most].name!r} are at the end of their range, up to {levels[most]:.4g}, and "
        f"seem to be clipped. {verdict.sentence}",
        "Measure with a larger range, or leave these samples out: empty cells with missing = 'leave-out' in the study "
        "file, NaN in Python.",
    )


def repeated_samples(record: FittedRecord) -> Iterator[Mistake]:
    """Yield the mistake for all series with repeated values."""
    repeats = {signal: _repeats(record.data_of(signal)) for signal in record.series}
    firsts = {signal: first for signal, first in repeats.items() if _count(first) >= FEWEST}
    if firsts:
        rows = np.concatenate([signal.rows for signal in firsts])
        sources = np.concatenate([signal.rows[first] for signal, first in firsts.items()])
        counts = list(map(_count, firsts.values()))
        finding = partial(_repeated_finding, list(firsts), counts)
        yield Mistake(partial(_held_values, rows, sources), finding, NONE, visible=True)


def _repeats(data: np.ndarray) -> np.ndarray:
    """Number of the first value of each run; values that are lost or clipped are no runs."""
    return np.where((data == 0) | plateaus(data), np.arange(len(data)), runs(data))


def _count(first: np.ndarray) -> int:
    return int(np.count_nonzero(first != np.arange(len(first))))


def _held_values(rows: np.ndarray, sources: np.ndarray, response: np.ndarray, _: float) -> np.ndarray:
    shown = response.copy()
    shown[rows] = response[sources]
    return shown


def _repeated_finding(series: Sequence[Series], counts: Sequence[int], verdict: Verdict) -> Finding:
    most = int(np.argmax(counts))
    return Finding(
        "repeated-samples",
        "warning",
        {"channel": series[most].name, "samples": counts[most], "explained": verdict.explained},
        f"{counts[most]} samples of {series[most].name!r} repeat the sample before. {verdict.sentence}",
        "Leave the repeated samples out: empty cells with missing = 'leave-out' in the study file, NaN in Python.",
    )
