"""Periodic motions as zeros of what a period changes, by Newton's method with Krylov subspaces.

The derivative of what a period makes of a state along a direction is taken by a difference, so each direction costs a
period; few are needed, since most motions die out within one.
"""

from collections.abc import Callable
from typing import Any, NamedTuple, cast

import numpy as np
from scipy.sparse.linalg import LinearOperator, gmres

Period = Callable[[np.ndarray], tuple[np.ndarray, float]]
"""Gives the state a period after a state, and the size of the change."""
PARTS = (1.0, 0.5, 0.25, 0.125)
"""Parts of a Newton step that are tried before a plain period is."""
DIFFERENCE = 1e-7
"""Step of the differences, as part of the state."""
DIRECTIONS = 60
"""Most directions of a Newton step."""


class Shot(NamedTuple):
    """A state, and the periods that were gone through to find it."""

    state: np.ndarray
    periods: int


def shoot(period: Period, state: np.ndarray, tolerance: float, most: int) -> Shot:
    """A state (unknowns,) that a period returns to, from a guess; a state with the least change if there is none.

    Parameters
    ----------
    period : callable
    state : array, shape (unknowns,)
        In scales in which its parts are comparable.
    tolerance : float
        Of the change.
    most : int
        Periods.
    """
    (after, change), run = period(state), 1
    while change > tolerance and run < most:
        off, calls = after - state, []
        step, _ = gmres(
            _slope(period, state, after), -off, rtol=1e-4, restart=min(DIRECTIONS, len(state)), maxiter=1,
            callback=calls.append, callback_type="pr_norm",
        )  # fmt: skip
        run += len(calls) + 2
        for part in PARTS:
            place = state + part * step
            (end, moved), run = period(place), run + 1
            if np.linalg.norm(end - place) < (1 - 0.1 * part) * np.linalg.norm(off):
                state, after, change = place, end, moved
                break
        else:
            state, (after, change), run = after, period(after), run + 1
    return Shot(state, run)


def _slope(period: Period, state: np.ndarray, after: np.ndarray) -> Any:
    """Derivative of what a period changes, as an operator on directions."""
    size = float(np.linalg.norm(after)) or 1.0

    def along(direction: np.ndarray) -> np.ndarray:
        step = DIFFERENCE * size / (float(np.linalg.norm(direction)) or 1.0)
        return (period(state + step * direction)[0] - after) / step - direction

    return cast(Any, LinearOperator)((len(state), len(state)), matvec=along, dtype=float)
