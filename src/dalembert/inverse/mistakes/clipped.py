"""Samples at the end of the range of a sensor."""

from collections.abc import Iterator, Sequence
from functools import partial

import numpy as np

from dalembert.findings import Finding
from dalembert.inverse.mistakes.patterns import plateaus
from dalembert.inverse.mistakes.record import NONE, FittedRecord, Mistake, Verdict, without
from dalembert.inverse.noise.correlation.series import Series


def clipped(record: FittedRecord) -> Iterator[Mistake]:
    """Yield the mistake for all series with several values at their largest or smallest value."""
    ends = {
        signal: clipped_values for signal in record.series if np.any(clipped_values := plateaus(record.data_of(signal)))
    }
    if ends:
        rows = np.concatenate([signal.rows[clipped_values] for signal, clipped_values in ends.items()])
        counts = [int(np.count_nonzero(clipped_values)) for clipped_values in ends.values()]
        levels = [
            float(np.max(np.abs(record.data_of(signal)[clipped_values]))) for signal, clipped_values in ends.items()
        ]
        finding = partial(_finding, list(ends), counts, levels)
        yield Mistake(partial(without, rows), finding, NONE, blamed=rows, visible=True)


def _finding(series: Sequence[Series], counts: Sequence[int], levels: Sequence[float], verdict: Verdict) -> Finding:
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
