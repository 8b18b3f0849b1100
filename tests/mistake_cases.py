"""Small studies that provoke the sentences on mistakes in records."""

from typing import Any

import numpy as np

import dalembert as da
from record_mistakes import TIMES, fitted, oscillates, plain
from report_case import Case


def _late(x: float, y: float, several: int = 1) -> Any:
    """The fit of an oscillation whose channels are late by x and y, in all experiments."""
    values = oscillates(TIMES - x)[0], oscillates(TIMES - y)[1]
    noise = 0.02 * np.random.default_rng(1).standard_normal((several, 2, len(TIMES)))
    data = [da.Measurements.of(TIMES, {"x": values[0] + one[0], "y": values[1] + one[1]}) for one in noise]
    if several == 1:
        return da.identify(plain(), data[0], starts=1)
    return da.identify([da.Experiment(f"run{k}", plain(), one) for k, one in enumerate(data)], starts=1)


MISTAKE_CASES = {
    "a wrong sign": Case(
        lambda: fitted("function", "sign", 0.9, 1),
        ("The data of 'y' seem to have the wrong sign.", "write [sensors] 'y' = { gain = [-1, -1] } in the study file"),
    ),
    "a wrong sign in one of two experiments": Case(
        lambda: fitted("function, two experiments", "sign", 0.9, 1),
        ("If it is reversed, negate the values of 'y' in the data of experiment 'run0'.",),
    ),
    "swapped channels": Case(
        lambda: fitted("function", "swap", 0.9, 1),
        ("The data of 'x' and 'y' seem to be swapped.", "swap the columns of 'x' and 'y' in columns."),
    ),
    "swapped channels of one of two experiments": Case(
        lambda: fitted("function, two experiments", "swap", 0.9, 1),
        ("in columns of experiment 'run0'.",),
    ),
    "a late record": Case(
        lambda: _late(0.3, 0.3),
        (
            "The times of the record seem to be 0.3 s late.",
            "write start = 0.3 in [data]",
            "or use since(0.3) in Python",
        ),
    ),
    "a late experiment": Case(
        lambda: fitted("function, two experiments", "late", 0.9, 1),
        ("The times of 'run0' seem to be", "in the table of experiment 'run0'"),
    ),
    "late experiments": Case(lambda: _late(0.3, 0.3, 2), ("The times of all records seem to be 0.3 s late.",)),
    "a late channel": Case(
        lambda: _late(0.0, 0.3),
        ("The times of 'y' seem to be", "[sensors] 'y' = { delay = [0.15, 0.45] }."),
    ),
    "an early channel": Case(lambda: _late(0.0, -0.3), ("Check its times, and the delays of the other channels.",)),
    "a fast clock": Case(
        lambda: fitted("function", "rate", 0.9, 1),
        ("The clock seems to be", "% too fast.", "Check the sampling rate. If it is wrong, divide the times by 1.0"),
    ),
    "clipped samples": Case(
        lambda: fitted("function", "clipped", 0.9, 1),
        ("of 'y' are at the end of their range, up to", "Measure with a larger range, or leave these samples out"),
    ),
    "lost samples": Case(
        lambda: fitted("function", "zeros", 0.9, 1),
        ("of 'y' are exactly 0, and seem to be lost.", "Leave the lost samples out"),
    ),
    "repeated samples": Case(
        lambda: fitted("function", "repeated", 0.9, 1),
        ("of 'y' repeat the sample before.", "Leave the repeated samples out"),
    ),
}
