"""How much errors grow along motions, and when multiple shooting is the way to fit them."""

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from dalembert.errors import DalembertError
from dalembert.findings import Finding
from dalembert.forward import StateChart, restartable
from dalembert.inverse.experiments.tracks import Track, tracks
from dalembert.inverse.identification.assess import Optimum
from dalembert.inverse.problem.problem import MisfitProblem
from dalembert.inverse.shooting.natural_cuts import MOST_STATES

CHAOTIC = 100.0
"""Growth of a small change of the initial state from which on a misfit has many false minima."""

PIECES = 10
"""Parts of a motion whose sensitivities are multiplied."""


def growing_errors(optimum: Optimum) -> Iterator[Finding]:
    """Yield the finding that errors grow much along a motion, at the values of a doubtful fit by least squares."""
    end, floor = optimum.end, optimum.floor
    doubtful = optimum.correlation_is_detected or floor.known or not end.success
    if not optimum.by_squares or optimum.settings.shooting is not None or end.misfit <= floor.misfit or not doubtful:
        return
    growth = error_growth(optimum.problem, optimum.vector)
    if growth < CHAOTIC:
        return
    message = (
        f"A small change of the initial state grows {growth:.2g} times along the motion, so that the misfit has many "
        "false minima."
    )
    advice = "Fit in segments: write shooting = true in [identify], or shooting=MultipleShooting() in Python."
    yield Finding("errors-grow", "warning", {"growth": growth}, message, advice)


def error_growth(problem: MisfitProblem, vector: np.ndarray) -> float:
    """Return how much a small change of the initial state grows along a motion, the largest of all; 1 where unknown.

    States are measured in parts of their ranges.
    """
    growths = [1.0]
    for track in tracks(problem):
        try:
            growths.append(_growth(track, vector[track.wiring]))
        except DalembertError:  # a motion that cannot be simulated, or begun anew
            continue
        problem.journal.simulations += 2 + len(track.wiring)
    return float(np.nanmax(growths))


def _growth(track: Track, vector: np.ndarray) -> float:
    model, times, number = restartable(track.model), track.times, len(track.model.channels)
    if model is None or len(times) <= PIECES:
        return 1.0
    start = model.state_chart(vector)
    if len(start.names) > MOST_STATES:
        return 1.0
    whole = model.restarted(0.0, times, None, model.state_chart(vector, whole=True)).evaluate(vector[None])
    states = whole.values[0][:, number:]
    if not np.all(np.isfinite(states)):
        return 1.0
    places = np.rint(np.linspace(0, len(times) - 1, PIECES + 1)).astype(int)
    charts = [model.state_chart(vector, states[place], like=start) for place in places]
    ranges = [_ranges(chart, states) for chart in charts]
    passed = np.eye(len(start.names))
    for (begin, chart, was), (end, after, now) in pairwise(zip(places, charts, ranges, strict=True)):
        piece = model.restarted(float(times[begin]), [float(times[end] - times[begin])], chart, after)
        _, jacobian = piece.linearise(np.concatenate([vector, chart.values]))
        slopes = jacobian[-1, number:, len(vector) :]
        passed = slopes * was / now[:, None] @ passed
    return float(np.linalg.norm(passed, 2))


def _ranges(chart: StateChart, states: np.ndarray) -> np.ndarray:
    """Ranges of a chart's numbers (numbers,) over states (samples, state): no coordinate, no rate has a tiny one."""
    ranges = np.ptp(chart.read(states), axis=0)
    half = len(ranges) // 2
    return np.maximum(ranges, np.repeat([0.01 * ranges[:half].max(), 0.01 * ranges[half:].max()], half) + 1e-300)
