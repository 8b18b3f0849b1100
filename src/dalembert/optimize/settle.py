"""The end of a descent in the identifiable directions alone."""

from dataclasses import replace

import numpy as np

from dalembert.optimize.identifiable_part import identifiable_part
from dalembert.optimize.linear_model import LinearModel
from dalembert.optimize.minimum import Minimum
from dalembert.optimize.path import Creeps, SearchPath
from dalembert.optimize.stopping import SMOOTH, Stopped, Stopping

HALVINGS = 10  # times that a step is halved at most


def settle(path: SearchPath, at: Creeps, stopping: Stopping, shortest: float) -> Minimum:
    """Return where Gauss and Newton's steps end that leave out the directions which are not identifiable.

    These directions are computed anew at each point. ``shortest`` is the length of the shortest step.
    """
    problem = path.problem
    x, r, slopes, left_out = at.x, at.residual, at.slopes, np.empty((0, len(at.x)))
    try:
        while True:
            # The directions turn as the point moves, so they are computed at each point.
            part = identifiable_part(problem, x, r, slopes)
            left_out = part.left_out * problem.unit
            down, up = (problem.low - x) / problem.unit, (problem.high - x) / problem.unit
            stopping.at(r, part.slopes, down, up)
            x, r = _after(path, x, r, LinearModel(r, part.slopes, down, up).step(0.0), stopping, shortest)
            slopes = path.slopes_at(x)
    except Stopped as end:
        minimum = path.minimum(end)
    if not len(left_out):
        return minimum
    return replace(minimum, message=f"{minimum.message}, in the identifiable directions", left_out=left_out)


def _after(
    path: SearchPath, x: np.ndarray, r: np.ndarray, step: np.ndarray, stopping: Stopping, shortest: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return the point (parameters,) after a step, halved until the sum of squares falls, and its residual."""
    for _ in range(HALVINGS):
        if np.linalg.norm(step) < shortest:
            break
        point = np.clip(x + path.problem.unit * step, path.problem.low, path.problem.high)
        residual = path.residual_at(point)
        if residual @ residual <= r @ r:
            return point, residual
        if stopping.foreseen < SMOOTH:
            break
        stopping.tried(path.best)
        step = step / 2
    raise stopping.at_rest(SMOOTH)
