"""A channel is measured in the opposite direction."""

from collections.abc import Iterator, Sequence
from functools import partial

import numpy as np

from dalembert.findings import Finding
from dalembert.inverse.mistakes.record import NONE, FittedRecord, Mistake, Verdict
from dalembert.inverse.noise.correlation.series import Series


def wrong_sign(record: FittedRecord) -> Iterator[Mistake]:
    """Yield the mistake for each channel of each experiment, and for each channel in all experiments."""
    for signal in record.series:
        yield _mistake([signal])
    for channel in dict.fromkeys(signal.channel for signal in record.series):
        several = [signal for signal in record.series if signal.channel == channel]
        if len(several) > 1:
            yield _mistake(several)


def _mistake(series: Sequence[Series]) -> Mistake:
    rows = np.concatenate([signal.rows for signal in series])
    return Mistake(partial(_negated, rows), partial(_finding, series), NONE)


def _negated(rows: np.ndarray, response: np.ndarray, _: float) -> np.ndarray:
    shown = response.copy()
    shown[rows] *= -1
    return shown


def _finding(series: Sequence[Series], verdict: Verdict) -> Finding:
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
