"""Samples that are zero because they were lost."""

from collections.abc import Iterator, Sequence
from functools import partial

import numpy as np

from dalembert.findings import Finding
from dalembert.inverse.mistakes.patterns import FEWEST
from dalembert.inverse.mistakes.record import NONE, FittedRecord, Mistake, Verdict, without
from dalembert.inverse.noise.correlation.series import Series


def dropouts(record: FittedRecord) -> Iterator[Mistake]:
    """Yield the mistake for all series with zeros."""
    lost = {signal: record.data_of(signal) == 0 for signal in record.series}
    zeros = {signal: zero for signal, zero in lost.items() if FEWEST <= np.count_nonzero(zero) < len(zero)}
    if zeros:
        rows = np.concatenate([signal.rows[zero] for signal, zero in zeros.items()])
        counts = [int(np.count_nonzero(zero)) for zero in zeros.values()]
        yield Mistake(partial(without, rows), partial(_finding, list(zeros), counts), NONE, blamed=rows, visible=True)


def _finding(series: Sequence[Series], counts: Sequence[int], verdict: Verdict) -> Finding:
    most = int(np.argmax(counts))
    return Finding(
        "zero-dropouts",
        "warning",
        {"channel": series[most].name, "samples": counts[most], "explained": verdict.explained},
        f"{counts[most]} samples of {series[most].name!r} are exactly 0, and seem to be lost. {verdict.sentence}",
        "Leave the lost samples out: empty cells with missing = 'leave-out' in the study file, NaN in Python.",
    )
