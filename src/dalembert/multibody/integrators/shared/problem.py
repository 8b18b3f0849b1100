"""What the compiled integrators are given, and what they answer."""

from typing import NamedTuple

from dalembert.kernels.kernel import inlined
from dalembert.kernels.words import Address, Integers, Reals, Reals2
from dalembert.multibody.kernels.linear import Layout

DONE, NEWTON_FAILED, SINGULAR, TOO_MANY_STEPS, DIVERGED, INEXACT = range(6)
POSITION, VELOCITY, ACCELERATION = range(3)  # levels at which a state satisfies the constraints


class Reduced(NamedTuple):
    """The system that Newton's method solves in ``increments`` and multipliers, see :mod:`reduction`.

    ``slots`` and ``layout`` of a matrix that is kept over steps; those of one that is renewed at each step.
    """

    increments: int
    slots: Integers
    layout: Layout
    exact_slots: Integers
    exact_layout: Layout


class IntegrationProblem(NamedTuple):
    """What does not change from sample to sample: sizes, scales, where matrix entries go, times. ``n`` coordinates;
    ``scale`` (N + 1,); ``exact_slots`` and ``exact_layout`` of a full matrix that is renewed often; ``times`` of the
    output; ``reduced``: the reduced system. ``edges`` (samples, -) of the smooth stretches of motion, and how many
    ``stretches`` each sample has. ``projected``: whether velocities are moved onto the constraints wherever
    accelerations are solved for.
    """

    n: int
    scale: Reals
    exact_slots: Integers
    exact_layout: Layout
    reduced: Reduced
    times: Reals
    edges: Reals2
    stretches: Integers
    projected: bool = False


class SampleModels(NamedTuple):
    """Addresses of models of a sample: in real numbers, with tangents, and complex ones moved along each direction.

    ``turns``: address of the record that counts the turns of angles, 0 for none.
    """

    real: Address
    tangents: Address
    directions: Integers
    turns: Address = 0


class Log(NamedTuple):
    """Of one run: steps, Newton iterations, factorisations, rejected steps; iterations a step while room lasts."""

    counts: Integers
    iterations: Integers
    ends: Reals


@inlined
def note_step(log, iterations, end):
    """Count a step, and keep its iterations and its end, s, while room lasts."""
    number = log.counts[0]
    if number < len(log.iterations):
        log.iterations[number], log.ends[number] = iterations, end
    log.counts[0] += 1
