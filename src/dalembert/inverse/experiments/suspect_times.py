"""Records whose sampling does not suit the time scales of the response: times in another unit."""

import numpy as np

from dalembert.data import Measurements
from dalembert.findings import Finding

INTERVALS, POINTS = 4, 100
"""Sampling intervals in which the response is looked at, and its points in each."""

SMOOTH = 0.2
"""Mean square of successive differences over the variance below which data change smoothly; noise has 2."""

FEWEST = 10
"""Samples of a channel that are judged."""

SWINGS = 4
"""Turning points of the response in a sampling interval from which data cannot be smooth: two periods."""

HYSTERESIS = 0.05
"""Part of its range by which a response changes before it has turned."""

SETTLED, MOVING = 0.02, 0.5
"""Parts of their ranges below which a response is at rest, and above which data are not."""


def first_times(data: Measurements) -> np.ndarray:
    """Return the times (times,) of a response that :func:`time_unit_findings` judges."""
    stamps = data.coordinate.values
    end = min(max(float(stamps[0]), 0.0) + INTERVALS * _step(stamps), float(stamps[-1]))
    return np.linspace(0.0, end, INTERVALS * POINTS + 1)


def time_unit_findings(data: Measurements, times: np.ndarray, response: np.ndarray) -> tuple[Finding, ...]:
    """Return a finding on the first channel that changes smoothly where the response does not follow.

    The response swings several times between two samples, or settles within the first of them.

    Parameters
    ----------
    data : Measurements
    times : array, shape (times,)
        As :func:`first_times` gives them.
    response : array, shape (times, channels)
        Of the channels of the data.

    Examples
    --------
    >>> stamps = np.arange(200) * 5.0  # milliseconds, read as seconds
    >>> data = Measurements.of(stamps, {"x": np.cos(4e-3 * stamps)})
    >>> times = first_times(data)
    >>> [finding.code for finding in time_unit_findings(data, times, np.cos(4 * times)[:, None])]
    ['suspect-time-unit']
    """
    for column, name in enumerate(data.channels):
        there = data.present[:, column]
        values, stamps = data.continuous[there, column], data.coordinate.values[there]
        if len(values) < FEWEST or not _is_smooth(values):
            continue
        step = _step(stamps)
        swings = _turning_points(response[times <= max(step, times[1]), column])  # later ones may have died away
        if swings >= SWINGS or _has_settled(values, times, response[:, column], step):
            return (_finding(name, step, swings),)
    return ()


def _step(stamps: np.ndarray) -> float:
    return float(np.median(np.diff(stamps))) if len(stamps) > 1 else 0.0


def _is_smooth(values: np.ndarray) -> bool:
    return bool(np.mean(np.diff(values) ** 2) < SMOOTH * np.var(values))


def _turning_points(response: np.ndarray) -> int:
    """Number of turning points of a response (times,), without those of small changes."""
    limit, count, direction = HYSTERESIS * np.ptp(response), 0, 0
    extreme = response[0]
    for value in response[1:]:
        if direction * (value - extreme) >= 0 and direction != 0:
            extreme = value
        elif abs(value - extreme) > limit:
            count += direction != 0
            direction, extreme = (1 if value > extreme else -1), value
    return count


def _has_settled(values: np.ndarray, times: np.ndarray, response: np.ndarray, step: float) -> bool:
    """Whether a response moves in the first interval alone, as much as the data, which move later."""
    later = times >= step
    first = np.ptp(response[~later]) if np.any(~later) else 0.0
    at_rest = np.sum(later) > POINTS and np.ptp(response[later]) < SETTLED * first
    return bool(at_rest and first > np.ptp(values) / 10 and np.ptp(values[2:]) > MOVING * np.ptp(values))


def _finding(channel: str, step: float, swings: int) -> Finding:
    does = f"swings about {swings / 2:.3g} times" if swings >= SWINGS else "settles"
    return Finding(
        "suspect-time-unit",
        "warning",
        {"channel": channel, "step": step, "swings": swings / 2},
        f"The samples of {channel!r} are {step:.3g} s apart and change smoothly, and the response at the first guesses "
        f"{does} between two of them. Is the unit of the times another one, such as ms?",
        "Give the unit of the column of times in units. If it is right, start closer to the true values.",
    )
