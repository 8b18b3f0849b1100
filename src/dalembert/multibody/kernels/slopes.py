"""Numbers of models along directions, and their slopes: one direction in complex numbers, or eight in dual ones.

Formulas of derivatives are written once for both. A slope is a real number, or eight of them in lanes.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numba.extending import overload

from dalembert.kernels.duals import ENTRIES, DualType, dual_zero, duals2, slopes_of, with_slopes
from dalembert.kernels.kernel import Kernel, inlined, inner
from dalembert.kernels.lanes import WIDTH, LanesType, entry, lane_zeros, lanes2, larger
from dalembert.kernels.views import address_of, complexes2, reals2
from dalembert.kernels.words import Reals3
from dalembert.multibody.kernels.elementary import STEP
from dalembert.multibody.kernels.states import MotionState

Number = complex
"""A complex or a dual number; for its type alone."""


_REST = 1e-90  # size of slopes below which a direction is at rest


class SlopeWork(NamedTuple):
    """Vectors of slopes (-, N + 1, lanes) and of numbers along directions (-, N + 1, doubles), as workspace.

    A complex number has one lane and two doubles, a dual number eight and nine.
    """

    slopes: Reals3
    numbers: Reals3


def slope_work(width: int, slopes: int, numbers: int, together: bool) -> SlopeWork:
    """Return vectors of N + 1 = ``width`` entries, for directions one by one, or eight ``together``."""
    doubles = ENTRIES if together else 2
    return SlopeWork(slope_zeros(together, slopes, width), np.zeros((numbers, width, doubles)))


def slope_zeros(together: bool, *shape: int) -> np.ndarray:
    """Return slopes (*shape, lanes) that are zero."""
    return lane_zeros(*shape) if together else np.zeros((*shape, 1))


@inlined
def one(work):
    """Complex numbers and real slopes of work, as matrices (-, N + 1)."""
    slopes, numbers, width = work.slopes, work.numbers, work.slopes.shape[1]
    return complexes2(address_of(numbers), len(numbers), width), reals2(address_of(slopes), len(slopes), width)


@inlined
def eight(work):
    """Dual numbers and lanes of slopes of work, as matrices (-, N + 1)."""
    slopes, numbers, width = work.slopes, work.numbers, work.slopes.shape[1]
    return duals2(address_of(numbers), len(numbers), width), lanes2(address_of(slopes), len(slopes), width)


def arrays_of(like, work):
    """Numbers and slopes of work, as matrices (-, N + 1), for numbers ``like`` this one."""
    return one(work)


@overload(arrays_of)
def _arrays_of(like, work):
    return (lambda like, work: eight(work)) if isinstance(like, DualType) else lambda like, work: one(work)


@inlined
def _complex_zero():
    return 0j


@inlined
def _dual_zero():
    return dual_zero()


def along_kernels(function: Callable) -> tuple[Kernel, Kernel]:
    """Return kernels of a function for directions one by one, and for eight together.

    Its first argument is a complex or a dual number, whose type decides on `arrays_of` a `SlopeWork`.
    """
    return Kernel(function, _complex_zero), Kernel(function, _dual_zero, is_vector=True)


@inlined
def state_of(slopes):
    """Return the first four vectors of slopes as a state."""
    return MotionState(slopes[0], slopes[1], slopes[2], slopes[3])


def joined(value, slope):
    """Return the number of a value with its slope."""
    return complex(value, STEP * slope)


@overload(joined)
def _joined(value, slope):
    if isinstance(slope, LanesType):
        return lambda value, slope: with_slopes(value, slope)
    return lambda value, slope: complex(value, STEP * slope)


def slope_of(number):
    """Return the slope of a number."""
    return number.imag / STEP


@overload(slope_of)
def _slope_of(number):
    if isinstance(number, DualType):
        return lambda number: slopes_of(number)
    return lambda number: number.imag / STEP


def maximum(x, y):
    """Return the larger number; NaN if one of both is NaN."""
    return y if x == x and not y <= x else x


@overload(maximum)
def _maximum(x, y):
    if isinstance(x, LanesType) or isinstance(y, LanesType):
        return lambda x, y: larger(x, y)
    return maximum


def worst(x):
    """Return the largest number of the lanes, or the only one."""
    return x


@overload(worst)
def _worst(x):
    if not isinstance(x, LanesType):
        return worst

    def of_lanes(x):
        # Once an iteration: its price does not matter.
        largest = entry(x, 0)
        for lane in range(1, WIDTH):
            largest = maximum(largest, entry(x, lane))
        return largest

    return of_lanes


@inner
def share_of(norm, size):
    """Return the largest norm of slopes as a part of the size of the same direction."""
    # A direction at rest has nothing but rounding, and size zero: its share is large, but does not count as divergence,
    # which would end the iteration of all directions of its group.
    return worst(norm / (size + _REST))


@inner
def perturb(n, state, slopes, numbers):
    """State of a model along directions: the real one with its slopes."""
    # Multipliers have no rates: behind the coordinates velocities and accelerations stay zero.
    for i in range(len(state.x)):
        numbers[0, i] = joined(state.x[i], slopes.x[i])
    for i in range(n):
        numbers[1, i], numbers[2, i] = joined(state.v[i], slopes.v[i]), joined(state.a[i], slopes.a[i])


@inner
def read_rows(rows, g, lanes):
    """Fill ``lanes`` (N + 1, lanes) with group ``g`` of rows (directions, N + 1), and zeros where there are none."""
    # Lanes without a direction are zero: what they had before would count in norms.
    for lane in range(lanes.shape[1]):
        d = g * lanes.shape[1] + lane
        for i in range(rows.shape[1]):
            lanes[i, lane] = rows[d, i] if d < len(rows) else 0.0


@inner
def write_rows(lanes, g, rows):
    """Fill group ``g`` of the rows with those in ``lanes``."""
    first = g * lanes.shape[1]
    for lane in range(min(lanes.shape[1], len(rows) - first)):
        for i in range(rows.shape[1]):
            rows[first + lane, i] = lanes[i, lane]


@inner
def read_states(states, g, lanes):
    """Fill ``lanes`` (4, N + 1, lanes) with x, v, a and w (directions, N + 1) of a group of directions."""
    read_rows(states.x, g, lanes[0])
    read_rows(states.v, g, lanes[1])
    read_rows(states.a, g, lanes[2])
    read_rows(states.w, g, lanes[3])


@inner
def write_states(lanes, g, states):
    """Fill the states of a group of directions from ``lanes``."""
    write_rows(lanes[0], g, states.x)
    write_rows(lanes[1], g, states.v)
    write_rows(lanes[2], g, states.a)
    write_rows(lanes[3], g, states.w)
