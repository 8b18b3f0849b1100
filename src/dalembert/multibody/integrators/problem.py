"""What the compiled integrators are given, and what they answer."""

from typing import NamedTuple

import numpy as np

DONE, NEWTON_FAILED, SINGULAR, TOO_MANY_STEPS, DIVERGED = range(5)


class Problem(NamedTuple):
    """What does not change from sample to sample: sizes, scales, where matrix entries go, LAPACK, times.

    ``n`` coordinates; ``scale`` (N + 1,); ``slots`` and ``layout`` of the Newton matrix; those of the sensitivities,
    whose matrix is renewed at each step; ``times`` of the output. ``edges`` (samples, -) of the smooth stretches of
    motion, and how many ``stretches`` each sample has. ``projected``: whether velocities are moved onto the constraints
    wherever accelerations are solved for.
    """

    n: int
    scale: np.ndarray
    slots: tuple
    layout: tuple
    exact_slots: tuple
    exact_layout: tuple
    times: np.ndarray
    edges: np.ndarray
    stretches: np.ndarray
    projected: bool = False


class Log(NamedTuple):
    """Of one run: steps, Newton iterations, factorisations, rejected steps; iterations a step while room lasts."""

    counts: np.ndarray
    iterations: np.ndarray
    ends: np.ndarray
