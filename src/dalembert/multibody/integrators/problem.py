"""What the compiled integrators are given, and what they answer."""

from typing import NamedTuple

from dalembert.kernels.words import Integers, Reals, Reals2
from dalembert.multibody.kernels.linear import Layout

DONE, NEWTON_FAILED, SINGULAR, TOO_MANY_STEPS, DIVERGED = range(5)


class Problem(NamedTuple):
    """What does not change from sample to sample: sizes, scales, where matrix entries go, times.

    ``n`` coordinates; ``scale`` (N + 1,); ``slots`` and ``layout`` of the Newton matrix; those of the sensitivities,
    whose matrix is renewed at each step; ``times`` of the output. ``edges`` (samples, -) of the smooth stretches of
    motion, and how many ``stretches`` each sample has. ``projected``: whether velocities are moved onto the constraints
    wherever accelerations are solved for.
    """

    n: int
    scale: Reals
    slots: Integers
    layout: Layout
    exact_slots: Integers
    exact_layout: Layout
    times: Reals
    edges: Reals2
    stretches: Integers
    projected: bool = False


class Log(NamedTuple):
    """Of one run: steps, Newton iterations, factorisations, rejected steps; iterations a step while room lasts."""

    counts: Integers
    iterations: Integers
    ends: Reals
