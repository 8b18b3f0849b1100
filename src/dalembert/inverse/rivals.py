"""Other minima that the data cannot tell from the best one."""

import numpy as np

from dalembert.inverse.descent import End
from dalembert.inverse.events import StartEnd
from dalembert.inverse.problem import Problem

ALIKE = 4.0
"""Variances of the noise, two deviations, by which the misfits of two minima may differ before the data tell."""


def rivals(problem: Problem, best: End) -> list[StartEnd]:
    """Starts that ended elsewhere with a misfit that is no worse, to two deviations of the noise; the best one first.

    Elsewhere is where the linearised response differs from that at ``best`` by more than two deviations of the noise.
    """
    freedom = problem.compared - len(best.point)
    if best.linearisation is None or freedom <= 0:
        return []
    slopes, alike = problem.slopes(best.linearisation), ALIKE * best.fitness / freedom
    ended = sorted(problem.journal.starts, key=lambda start: start.fitness)
    return [
        start
        for start in ended
        if start.fitness - best.fitness < alike
        and np.sum((slopes @ (problem.search.points(start.end) - best.point)) ** 2) > alike
    ]
