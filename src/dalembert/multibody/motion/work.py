"""Work of loads and losses along a motion, by Gauss' rule on the interpolated states."""

import numpy as np

from dalembert.multibody.kernels.states import MotionState
from dalembert.multibody.model.evaluate import energies
from dalembert.multibody.model.lowered import Lowered

_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(3)


def works_of_steps(lowered: Lowered, times: np.ndarray, states: MotionState) -> np.ndarray:
    """Return the work of what is not conservative in each interval between states, J, (samples - 1,). ``times``
    (samples,): s; ``states`` (samples, N + 1). Coordinates and velocities between states are cubic, by their rates and
    accelerations, so the work has an error of fourth order in the intervals, below those of the methods at their steps.
    Multipliers are linear. The points lie inside of the intervals, where no load jumps.

    Strong dampers leave accelerations behind that no step resolves: the cubic then is not the motion. Where its work
    differs from that at the mean velocity by more than the work of the interval and its neighbours, the work at the
    mean velocity counts.
    """
    x, v, a = (np.asarray(own) for own in (states.x, states.v, states.a))
    n, h = lowered.structure.n, np.diff(times)[:, None]
    before, after = a[:-1, :n].copy(), a[1:, :n]
    jumped = np.isin(np.round(times[:-1] / times[-1], 12), np.round(np.array(lowered.jumps) / times[-1], 12))
    jumped[0] = False  # its acceleration is that after the start
    # The acceleration at a jump is that before it: behind it, velocities are quadratic.
    before[jumped] = (2 * (v[1:, :n] - v[:-1, :n]) / h - after)[jumped]
    work = np.zeros(len(h))
    for point, weight in zip(_POINTS, _WEIGHTS, strict=True):
        s = (1 + point) / 2
        s1 = 3 * s * s - 2 * s**3
        t0, t1 = h * (s - 2 * s * s + s**3), h * (s**3 - s * s)
        place = (1 - s) * x[:-1] + s * x[1:]
        place[:, :n] = (1 - s1) * x[:-1, :n] + s1 * x[1:, :n] + t0 * v[:-1, :n] + t1 * v[1:, :n]
        velocity = np.zeros_like(place)
        velocity[:, :n] = (1 - s1) * v[:-1, :n] + s1 * v[1:, :n] + t0 * before + t1 * after
        at = times[:-1] + s * h[:, 0]
        work += 0.5 * weight * h[:, 0] * energies(lowered.real, place, velocity, at, at)[:, 2]
    mean = _work_at_mean_velocity(lowered, times, x)
    size = np.abs(mean)
    size = np.maximum(size, np.maximum(np.append(size[1:], 0.0), np.append(0.0, size[:-1])))
    return np.where(np.abs(work - mean) > size, mean, work)


def _work_at_mean_velocity(lowered: Lowered, times: np.ndarray, x: np.ndarray) -> np.ndarray:
    """The same by the midpoint rule, with the mean velocity of each interval: of second order, but never wild."""
    n, h = lowered.structure.n, np.diff(times)
    velocity = np.zeros_like(x[1:])
    velocity[:, :n] = (x[1:, :n] - x[:-1, :n]) / h[:, None]
    at = (times[:-1] + times[1:]) / 2
    return h * energies(lowered.real, (x[:-1] + x[1:]) / 2, velocity, at, at)[:, 2]
