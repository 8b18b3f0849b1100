"""The place at which a system rests under its static forces, where its elements alone may hold it."""

from dataclasses import replace

import numpy as np
from scipy.optimize import brentq

from dalembert.vibration.balance.balance import Balance
from dalembert.vibration.fourier import Fourier
from dalembert.vibration.interface.condensation import Point, norm

STEPS = 50
"""Newton steps, at most."""
BALANCED = 1e-10
"""Residual, as part of the static forces, of a place of rest."""
DOUBLINGS = 40
"""Of a step, after which nothing stops the motion."""


@np.errstate(over="ignore", invalid="ignore")
def at_rest(balance: Balance, point: Point) -> np.ndarray:
    """Return the unknowns (q, coefficients) of the place of rest, or where the search for it ended.

    Newton's method with an exact line search on the potential energy, whose slope along a step is that of the forces.
    Where no element is touched, the energy falls on a line, and the search ends at the element that stops the motion.
    """
    # Harmonic 0 alone: four samples of a constant, which the sums take as any other motion.
    still = Balance(balance.lowered, Fourier((0,), 4), balance.events)
    mean = replace(
        point, frequencies=point.frequencies[:1], stiffness=point.stiffness[:1], slope=0 * point.slope[:1],
        force=point.force[:1], force_slope=0 * point.force_slope[:1], kept={},
    )  # fmt: skip
    places = np.zeros(still.shape)
    for _ in range(STEPS):
        evaluation, tangent = still.linearised(mean, places)
        if norm(evaluation.residual) <= BALANCED * (mean.load + norm(evaluation.forces)):
            break
        try:
            step = -tangent.solve(evaluation.residual[:, :, None])[:, :, 0]
        except np.linalg.LinAlgError:
            break
        # Line search on the energy E, whose slope along a step s is R(x + p s) · s. A residual norm would not do: it
        # does not fall while no stop is touched.
        part = _lowest(still, mean, places, step)
        if part is None:
            break
        places = places + part * step
    return np.pad(places, ((0, 0), (0, balance.series.count - 1)))


def _lowest(still: Balance, mean: Point, places: np.ndarray, step: np.ndarray) -> float | None:
    """Return the part of a step with the least energy; None if the energy falls without end."""

    def slope(part: float) -> float:
        return float(np.sum(still.at(mean, places + part * step).residual * step))

    first, part = slope(0.0), 1.0
    for _ in range(DOUBLINGS):
        there = slope(part)
        if abs(there) <= BALANCED * abs(first):
            return part
        # E falls first and rises here: its minimum lies between. A step that does not fall at first has none to find.
        if there > 0:
            return float(brentq(slope, 0.0, part)) if first < 0 else None  # pyright: ignore[reportArgumentType]
        part *= 2
    return None
