"""Records whose times do not suit the time scales of the response: times in another unit."""

from collections.abc import Callable
from typing import Any

import numpy as np

from dalembert.data import Measurements
from dalembert.errors import DalembertError
from dalembert.findings import Finding
from dalembert.forward import ForwardModel

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

FACTOR = 1e3
"""Times longer that a record is if its times are in s, not in ms."""

FEW, MANY, FASTER, ALIKE = 4, 8, 4.0, 3.0
"""Turning points of data from which they are judged, and to which; how many times fewer the response must have; and the
quotient of numbers of turning points up to which they are alike."""

DRAWN, MOST = 400, 2000
"""Times of a response, and samples of data, that are looked at."""

SIZES = 10.0
"""Quotient of ranges up to which response and data are alike: a guess may be far from the true value."""

GOLDEN = (np.sqrt(5) - 1) / 2

Respond = Callable[[np.ndarray], np.ndarray | None]
"""From times (times,) to the response at the first guesses, shape (times, channels of the data); None if it fails."""


def time_findings(model: ForwardModel, data: Measurements, vector: np.ndarray) -> tuple[Finding, ...]:
    """Return a finding if the times of the data are probably too long or too short, by a factor such as 1000. The
    response at the first guesses ``vector`` (parameters,) is computed at other times than those of the data; models
    that cannot do this have no finding. ``model``: its channels have those of the data.
    """
    stamps = data.coordinate.values
    if data.coordinate.unit != "s" or len(stamps) < FEWEST or not stamps[-1] > 0:
        return ()
    offered: Any = model
    while not hasattr(offered, "at") and hasattr(offered, "model"):  # sensors and other models around a model
        offered = offered.model
    if not hasattr(offered, "at"):
        return ()
    names = [channel.name for channel in offered.channels]
    columns = [names.index(name) for name in data.channels]
    guesses = vector[None, : len(offered.parameters)]

    def respond(times: np.ndarray) -> np.ndarray | None:
        try:
            responses = offered.at(times).evaluate(guesses)
        except DalembertError:  # what computes the response afterwards reports it
            return None
        return responses.values[0][:, columns] if responses.failures[0] is None else None

    times = first_times(data)
    response = respond(times)
    if response is None:
        return ()
    return time_unit_findings(data, times, response) or short_time_findings(data, respond)


def short_time_findings(data: Measurements, respond: Respond) -> tuple[Finding, ...]:
    """Return a finding on the first channel whose response turns as often as the data within 1000 times their time.
    Within the time of the data, the response has at most a quarter of their turning points. So times in s were probably
    read as ms.
    """
    for column, name in enumerate(data.channels):
        present = data.present[:, column]
        values, stamps = data.continuous[present, column], data.coordinate.values[present]
        thin = -(-len(values) // MOST) or 1
        values, stamps = values[::thin], stamps[::thin]
        if len(values) < FEWEST or not _is_smooth(values):
            continue
        turns = _turning_points(values, MANY)
        if len(turns) < FEW:
            continue
        begin, end = max(float(stamps[0]), 0.0), float(stamps[turns[-1]])
        # At even times, a fast response may look slow.
        shares = (np.arange(DRAWN) + 0.5 * (GOLDEN * np.arange(DRAWN) % 1)) / (DRAWN - 0.5)
        times = begin + (end - begin) * shares
        now, later = respond(times), None
        if now is not None and FASTER * len(_turning_points(now[:, column])) <= len(turns):
            later = respond(FACTOR * times)
        if now is None or later is None:
            return ()
        count = len(_turning_points(later[:, column]))
        sizes = np.ptp(later[:, column]) / np.ptp(values)
        if 1 / ALIKE <= count / len(turns) <= ALIKE and 1 / SIZES <= sizes <= SIZES and _is_smooth(later[:, column]):
            return (_short_finding(name, end - begin, len(turns), len(_turning_points(now[:, column])), count),)
    return ()


def first_times(data: Measurements) -> np.ndarray:
    """Return the times (times,) of a response that :func:`time_unit_findings` judges."""
    stamps = data.coordinate.values
    end = min(max(float(stamps[0]), 0.0) + INTERVALS * _step(stamps), float(stamps[-1]))
    return np.linspace(0.0, end, INTERVALS * POINTS + 1)


def time_unit_findings(data: Measurements, times: np.ndarray, response: np.ndarray) -> tuple[Finding, ...]:
    """Return a finding on the first channel that changes smoothly where the response does not follow: the response
    swings several times between two samples, or settles within the first of them. ``times`` (times,): as
    :func:`first_times` gives them. ``response`` (times, channels): of the channels of the data.
    """
    for column, name in enumerate(data.channels):
        present = data.present[:, column]
        values, stamps = data.continuous[present, column], data.coordinate.values[present]
        if len(values) < FEWEST or not _is_smooth(values):
            continue
        step = _step(stamps)
        swings = len(_turning_points(response[times <= max(step, times[1]), column]))  # later ones may have died away
        if swings >= SWINGS or _has_settled(values, times, response[:, column], step):
            return (_finding(name, step, swings),)
    return ()


def _step(stamps: np.ndarray) -> float:
    return float(np.median(np.diff(stamps))) if len(stamps) > 1 else 0.0


def _is_smooth(values: np.ndarray) -> bool:
    return bool(np.mean(np.diff(values) ** 2) < SMOOTH * np.var(values))


def _turning_points(response: np.ndarray, most: float = np.inf) -> list[int]:
    """Places of the first turning points of a response (times,), without those of small changes."""
    limit, turns, direction = HYSTERESIS * np.ptp(response), [], 0
    extreme, place = response[0], 0
    for now, value in enumerate(response.tolist()):
        if direction * (value - extreme) >= 0 and direction != 0:
            extreme, place = value, now
        elif abs(value - extreme) > limit:
            turns += [place] * (direction != 0)
            if len(turns) >= most:
                break
            direction, extreme, place = (1 if value > extreme else -1), value, now
    return turns


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
        {"channel": channel, "step": step, "swings": swings / 2, "factor": 1 / FACTOR},
        f"The samples of {channel!r} are {step:.3g} s apart and change smoothly, and the response at the first guesses "
        f"{does} between two of them. Is the unit of the times another one, such as ms?",
        "Give the unit of the column of times in units. If it is right, start closer to the true values.",
    )


def _short_finding(channel: str, duration: float, turns: int, now: int, later: int) -> Finding:
    return Finding(
        "suspect-time-unit",
        "warning",
        {"channel": channel, "step": duration / turns, "swings": turns / 2, "factor": FACTOR},
        f"The data of {channel!r} turn {turns} times within {duration:.3g} s. The response at the first guesses turns "
        f"{now} times there, and {later} times within {FACTOR * duration:.3g} s. Is the unit of the times another one, "
        "such as s, not ms?",
        "Give the unit of the column of times in units. If it is right, start closer to the true values.",
    )
