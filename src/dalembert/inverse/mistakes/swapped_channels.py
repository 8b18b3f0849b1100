"""Two channels of a record are swapped."""

from collections.abc import Iterator, Sequence
from functools import partial
from itertools import combinations

import numpy as np

from dalembert.findings import Finding
from dalembert.inverse.mistakes.record import NONE, FittedRecord, Mistake, Verdict
from dalembert.inverse.noise.correlation.series import Series

MOST = 12
"""Channels of an experiment up to which all pairs are tested."""


def swapped_channels(record: FittedRecord) -> Iterator[Mistake]:
    """Yield the mistake for each pair of channels with the same samples, in one experiment and in all."""
    pairs: dict[tuple[str, str], list[tuple[Series, Series]]] = {}
    for several in record.experiments.values():
        if len(several) > MOST:
            continue
        for first, second in combinations(several, 2):
            if np.array_equal(first.along, second.along):
                pairs.setdefault((first.channel, second.channel), []).append((first, second))
                yield _mistake([(first, second)])
    yield from (_mistake(pair) for pair in pairs.values() if len(pair) > 1)


def _mistake(pairs: Sequence[tuple[Series, Series]]) -> Mistake:
    rows = [np.concatenate([pair[side].rows for pair in pairs]) for side in (0, 1)]
    return Mistake(partial(_swapped, *rows), partial(_finding, pairs), NONE)


def _swapped(first: np.ndarray, second: np.ndarray, response: np.ndarray, _: float) -> np.ndarray:
    shown = response.copy()
    shown[first], shown[second] = response[second], response[first]
    return shown


def _finding(pairs: Sequence[tuple[Series, Series]], verdict: Verdict) -> Finding:
    first, second = pairs[0]
    where = f" of experiment {first.experiment!r}" if first.experiment and len(pairs) == 1 else ""
    return Finding(
        "suspect-swap",
        "warning",
        {
            "channel": first.channel,
            "other": second.channel,
            "experiment": first.experiment if len(pairs) == 1 else "",
            "explained": verdict.explained,
        },
        f"The data of {first.channel!r} and {second.channel!r}{where} seem to be swapped. {verdict.sentence}",
        f"Check the columns of the file. If they are swapped, swap the columns of {first.channel!r} and "
        f"{second.channel!r} in columns{where}.",
    )
