"""States of motion, their difference formulas and their interpolation between steps.

The formulas of a step of generalized-alpha are those of `docs/theory/generalized-alpha.md`.
"""

from typing import Any, NamedTuple

import numpy as np

from dalembert.kernels.kernel import inlined, inner
from dalembert.kernels.words import Reals, Reals2, Reals3


class MotionState(NamedTuple):
    """A state: unknowns x (N + 1: coordinates, multipliers, zero), velocities, accelerations, algorithmic ones.

    The same four arrays hold a state's derivative along one direction of the parameters.
    """

    x: Reals
    v: Reals
    a: Reals
    w: Reals


class MotionStates(NamedTuple):
    """A stack of states: arrays (states, N + 1)."""

    x: Reals2
    v: Reals2
    a: Reals2
    w: Reals2


class Histories(NamedTuple):
    """A stack of stacks of states: arrays (-, states, N + 1)."""

    x: Reals3
    v: Reals3
    a: Reals3
    w: Reals3


class Coefficients(NamedTuple):
    """Of one step of generalized-alpha: dq and dv by the new acceleration, and what makes the step."""

    step: float
    dq: float
    dv: float
    alpha_m: float
    alpha_f: float
    beta: float
    gamma: float


def resting(*shape: int) -> Any:
    """States of zeros: a `MotionState`, or with more axes what serves as `MotionStates` or as `Histories`."""
    return MotionState(np.zeros(shape), np.zeros(shape), np.zeros(shape), np.zeros(shape))


@inner
def clear(array):
    """Fill a vector with zeros."""
    for i in range(len(array)):
        array[i] = 0


@inner
def copy(source, target):
    """Copy one state into another."""
    for i in range(len(source.x)):
        target.x[i], target.v[i], target.a[i], target.w[i] = source.x[i], source.v[i], source.a[i], source.w[i]


@inlined
def row(stack, d):
    """State ``d`` of a stack of states."""
    return MotionState(stack.x[d], stack.v[d], stack.a[d], stack.w[d])


@inlined
def rows(stack, d):
    """Stack ``d`` of a stack of stacks."""
    return MotionStates(stack.x[d], stack.v[d], stack.a[d], stack.w[d])


@inner
def coefficients(step, spectral_radius):
    """Coefficients of generalized-alpha (Arnold and Bruels 2007) for a step and a spectral radius at infinity.

    ``dq`` = dq_{n+1} / d(acceleration) = beta h^2 (1 - alpha_f) / (1 - alpha_m), ``dv`` = gamma h times the same ratio.
    """
    # Chung and Hulbert's choice: second order, and for the spectral radius at infinity the least damping of low
    # frequencies.
    alpha_m = (2 * spectral_radius - 1) / (spectral_radius + 1)
    alpha_f = spectral_radius / (spectral_radius + 1)
    gamma = 0.5 + alpha_f - alpha_m
    beta = 0.25 * (gamma + 0.5) ** 2
    # By the first formula dw = share da; q and v change by it through Newmark's formulas.
    share = (1 - alpha_f) / (1 - alpha_m)
    return Coefficients(step, step * step * beta * share, step * gamma * share, alpha_m, alpha_f, beta, gamma)


@inner
def advance(n, c, old, new):
    """Fill the new algorithmic accelerations w, coordinates q and velocities v from the new accelerations a. ``n``:
    number of coordinates; ``c``: the step h and the method's coefficients; ``old``, ``new``: states (x for q, v, a, w)
    at both ends of the step, of which ``new.a`` is given. The results are linear in ``old`` and ``new.a``:

    (1 - alpha_m) w_{n+1} + alpha_m w_n = (1 - alpha_f) a_{n+1} + alpha_f a_n,
    q_{n+1} = q_n + h v_n + h^2 ((1/2 - beta) w_n + beta w_{n+1}), v_{n+1} = v_n + h ((1 - gamma) w_n + gamma w_{n+1}).
    """
    h = c.step
    scale = 1.0 / (1.0 - c.alpha_m)
    own, past = (1.0 - c.alpha_f) * scale, c.alpha_f * scale
    lag = c.alpha_m * scale
    half, beta = h * h * (0.5 - c.beta), h * h * c.beta
    early, late = h * (1.0 - c.gamma), h * c.gamma
    for i in range(n):
        # The new algorithmic acceleration first: coordinates and velocities need it.
        w0 = old.w[i]
        w1 = own * new.a[i] + past * old.a[i] - lag * w0
        new.w[i] = w1
        new.x[i] = old.x[i] + h * old.v[i] + half * w0 + beta * w1
        new.v[i] = old.v[i] + early * w0 + late * w1


@inner
def shift(n, c, change, state):
    """Take a change off the accelerations of an advanced state, with what it changes of the rest."""
    # The formulas are linear: a correction is taken off all parts without a look at the old state.
    share = (1.0 - c.alpha_f) / (1.0 - c.alpha_m)
    for i in range(n):
        state.a[i] -= change[i]
        state.w[i] -= share * change[i]
        state.v[i] -= c.dv * change[i]
        state.x[i] -= c.dq * change[i]


@inner
def interpolate(n, h, s, old, new, x, v, a):
    """State at the fraction ``s`` of a step ``h``: cubic for coordinates and velocities, linear for the rest."""
    if s > 1.0 - 1e-9:
        for i in range(len(x)):
            x[i], v[i], a[i] = new.x[i], new.v[i], new.a[i]
        return
    # Hermite's cubic through the values and rates of both ends. Velocities are interpolated alike, not as its
    # derivative, which would lose an order.
    s0, s1 = 1 - 3 * s * s + 2 * s**3, 3 * s * s - 2 * s**3
    t0, t1 = h * (s - 2 * s * s + s**3), h * (s**3 - s * s)
    for i in range(n):
        x[i] = s0 * old.x[i] + t0 * old.v[i] + s1 * new.x[i] + t1 * new.v[i]
        v[i] = s0 * old.v[i] + t0 * old.a[i] + s1 * new.v[i] + t1 * new.a[i]
        a[i] = (1 - s) * old.a[i] + s * new.a[i]
    for i in range(n, len(x)):
        x[i] = (1 - s) * old.x[i] + s * new.x[i]


@inner
def subtract(n, correction, state):
    """Take a correction off the accelerations and multipliers, which are also the algorithmic accelerations."""
    for i in range(n):
        state.a[i] -= correction[i]
        state.w[i] = state.a[i]
    for i in range(n, len(state.x) - 1):
        state.x[i] -= correction[i]
