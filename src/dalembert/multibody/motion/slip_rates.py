"""Findings on smoothed friction whose slip rate does not suit the motion."""

from collections.abc import Iterator

import numpy as np

from dalembert.findings import Finding
from dalembert.multibody.components.base_joint import Smoothing
from dalembert.multibody.model.system import BaseSystem

CROSSING = 1.0  # steps, at least, in which the motion should cross the smoothed zone
SMOOTH = 3.0  # steps in a crossing with the proposed slip rate
CREEP = 2e-3  # part of the joint's motion that may be creep where friction should hold it
LARGE = 0.05  # part of the joint's largest rate that a slip rate should not exceed
SLOW = 1e-3  # part of the joint's largest rate; friction stops a vibration that is slower within a few reversals
REVERSALS = 5  # of a slow rate between neighbouring samples, from which the stick phase is not that of the law
STAY = 10.0  # crossings at the mean acceleration, after which friction holds the joint


def rubbing(system: BaseSystem) -> dict[str, Smoothing]:
    """Return how joints with Coulomb friction smooth it, by their names."""
    return {joint.name: joint.smoothing for joint in system.joints if joint.smoothing}


def slip_findings(
    name: str, smoothing: Smoothing, times: np.ndarray, rates: np.ndarray, step: float | None
) -> Iterator[Finding]:
    """Yield whether a joint creeps or chatters where friction should hold it, or crosses its zone in too few steps.
    ``times``, ``rates`` (samples,): s and rad/s or m/s; ``step``: s, None for a solver that chooses its steps. The zone
    is -slip to slip. The joint creeps while its rate stays within twice the zone for ten times as long as a crossing
    takes at the root mean square of the acceleration. Samples farther apart than a step do not show the crossing.
    """
    slip, setting, unit = float(np.real(smoothing.slip)), smoothing.setting, smoothing.unit
    largest = float(np.max(np.abs(rates)))
    if largest == 0 or len(times) < 2:
        return
    angle, duration = _held(slip, times, rates)
    # The range of the joint's angle or position, rad or m.
    steps = np.diff(times) * (rates[1:] + rates[:-1]) / 2
    travel = float(np.ptp(np.concatenate([[0.0], np.cumsum(steps)]))) or 1.0
    creep = angle / travel
    most = CREEP / 2 * travel / duration if duration else np.inf  # the rate of creep is about the slip rate
    if creep > CREEP:
        proposed = _rounded(min(slip / 2, most))
        values = {"joint": name, setting: slip, "largest_rate": largest, "creep": creep, "proposed": proposed}
        message = (
            f"Joint {name!r} creeps where friction should hold it, by {100 * creep:.2g} % of its range of motion: its "
            f"{setting} {slip:.3g} {unit} is too large."
        )
        advice = f"Set {setting} to {proposed:.2g} {unit} or less."
        yield Finding("slip-rate", "warning", values, message, advice)
        return
    # How often a rate that is slow, but outside the smoothed zone, changes its sign from sample to sample.
    sizes = np.abs(rates)
    slow = (sizes > 2 * slip) & (sizes < SLOW * np.max(sizes))
    reversals = int(np.sum(slow[1:] & slow[:-1] & (rates[1:] * rates[:-1] < 0)))
    if reversals >= REVERSALS:
        yield Finding(
            "stick-chatter",
            "warning",
            {"joint": name, setting: slip, "reversals": reversals},
            f"Joint {name!r} chatters where friction should hold it: its rate changes its sign {reversals} times from "
            f"sample to sample, at more than twice its {setting} of {slip:.3g} {unit}. It may slip early.",
            f"Use RadauIIA, which follows the {setting}, or a larger {setting}.",
        )
    # The largest change of the rate in a step that crosses zero or an edge of the zone; 0 for none.
    inside = np.abs(rates) < slip
    across = (rates[:-1] * rates[1:] < 0) | (inside[1:] != inside[:-1])
    change = float(np.max(np.abs(np.diff(rates)), where=across, initial=0.0))
    if step is None or np.max(np.diff(times)) > 1.5 * step or not change or 2 * slip / change >= CROSSING:
        return
    proposed = max(slip, _rounded(min(SMOOTH / 2 * change, most, LARGE * largest)))
    finer = min(step, _rounded(0.9 * step * 2 * proposed / change / CROSSING))
    values = {
        "joint": name, setting: slip, "largest_rate": largest, "steps": 2 * slip / change, "proposed": proposed,
        "step": finer,
    }  # fmt: skip
    message = (
        f"The motion crosses the smoothed friction of joint {name!r} in {2 * slip / change:.2g} steps: its {setting} "
        f"is {slip:.3g} {unit}. The response is rough over the parameters, and fits may converge slowly."
    )
    to_do = [f"set {setting} to {proposed:.2g} {unit}"] * (proposed > slip) + [f"use steps of {finer:.2g} s"] * (
        finer < step
    )
    yield Finding("slip-rate", "note", values, message, f"For a fit, {' and '.join(to_do)}.")


def _held(slip: float, times: np.ndarray, rates: np.ndarray) -> tuple[float, float]:
    """Return the change of position and the duration, s, of all intervals in which friction holds the joint."""
    spacing = np.diff(times)
    acceleration = np.sqrt(np.mean((np.diff(rates) / spacing) ** 2))
    slow = np.concatenate([[False], np.abs(rates) < 2 * slip, [False]])
    edges = np.flatnonzero(slow[1:] != slow[:-1]).reshape(-1, 2)
    least = STAY * 4 * slip / acceleration if acceleration else 0.0
    held = [slice(begin, end) for begin, end in edges if times[end - 1] - times[begin] > least]
    angle = sum(np.trapezoid(np.abs(rates[part]), times[part]) for part in held)
    return float(angle), float(sum(np.ptp(times[part]) for part in held))


def _rounded(value: float) -> float:
    return float(f"{value:.2g}")
