"""Channels that are measured in the opposite direction, or swapped."""

from collections.abc import Iterator, Sequence
from functools import partial
from itertools import combinations

import numpy as np

from dalembert.findings import Finding
from dalembert.inverse.mistakes.record import NONE, FittedRecord, Mistake, Verdict
from dalembert.inverse.noise.correlation.series import Series


def wrong_sign(record: FittedRecord) -> Iterator[Mistake]:
    """Yield the mistake for each channel of each experiment, and for each channel in all experiments."""
    for signal in record.series:
        yield _reversal([signal])
    for channel in dict.fromkeys(signal.channel for signal in record.series):
        several = [signal for signal in record.series if signal.channel == channel]
        if len(several) > 1:
            yield _reversal(several)


def _reversal(series: Sequence[Series]) -> Mistake:
    rows = np.concatenate([signal.rows for signal in series])
    return Mistake(partial(_negated, rows), partial(_sign_finding, series), NONE)


def _negated(rows: np.ndarray, response: np.ndarray, _: float) -> np.ndarray:
    shown = response.copy()
    shown[rows] *= -1
    return shown


def _sign_finding(series: Sequence[Series], verdict: Verdict) -> Finding:
    first, alone = series[0], len(series) == 1 and bool(series[0].experiment)
    name = first.name if len(series) == 1 else first.channel
    line = (
        f"write [sensors] {first.channel!r} = {{ gain = [-1, -1] }} in the study file, or negate the values in Python."
    )
    if alone:  # [sensors] is for all experiments
        line = f"negate the values of {first.channel!r} in the data of experiment {first.experiment!r}."
    return Finding(
        "suspect-sign",
        "warning",
        {"channel": name, "experiment": first.experiment if alone else "", "explained": verdict.explained},
        f"The data of {name!r} seem to have the wrong sign. {verdict.sentence}",
        f"Check the direction of the sensor. If it is reversed, {line}",
    )


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
                yield _swap([(first, second)])
    yield from (_swap(pair) for pair in pairs.values() if len(pair) > 1)


def _swap(pairs: Sequence[tuple[Series, Series]]) -> Mistake:
    rows = [np.concatenate([pair[side].rows for pair in pairs]) for side in (0, 1)]
    return Mistake(partial(_swapped, *rows), partial(_swap_finding, pairs), NONE)


def _swapped(first: np.ndarray, second: np.ndarray, response: np.ndarray, _: float) -> np.ndarray:
    shown = response.copy()
    shown[first], shown[second] = response[second], response[first]
    return shown


def _swap_finding(pairs: Sequence[tuple[Series, Series]], verdict: Verdict) -> Finding:
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
