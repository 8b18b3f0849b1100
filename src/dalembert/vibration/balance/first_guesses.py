"""Guesses of a first solution: the place of rest, sticking or missing contacts, the end of a path over the force."""

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from itertools import islice
from typing import Any

import numpy as np
from scipy.optimize import brentq

from dalembert.vibration.balance.arc_length import along
from dalembert.vibration.balance.balance import Balance
from dalembert.vibration.balance.harmonic_balance import HarmonicBalance
from dalembert.vibration.balance.newton import AnyBalance, Constraint, Point, Solution, correct, placed
from dalembert.vibration.balance.receptance_balance import ReceptanceBalance
from dalembert.vibration.fourier import Fourier
from dalembert.vibration.interface.condensed_structure import CondensedStructure, norm
from dalembert.vibration.interface.lowering import ELASTIC
from dalembert.vibration.interface.receptances import ReceptancePoint

STEPS = 50
"""Newton steps, at most."""
BALANCED = 1e-10
"""Residual, as part of the static forces, of a place of rest."""
DOUBLINGS = 40
"""Of a step, after which nothing stops the motion."""
FIRST_LOAD = 0.01
"""Part of the force at the start of the path, at which pressed contacts stick."""
RESOLUTION = 0.1
"""Resolution of the path, whose points are not kept."""
MOST_STEPS = 120
"""Points after which continuation stops."""


def first_guesses(balance: AnyBalance, method: HarmonicBalance, point: Point) -> Iterator[np.ndarray]:
    """Yield guesses of a first point; the later ones are made if those before lead to no solution."""
    if isinstance(point, ReceptancePoint):
        # The motion while all contacts stick, that without contacts, then a path over the varying forces.
        assert isinstance(balance, ReceptanceBalance)  # that of the point
        yield balance.stuck(point)
        with suppress(np.linalg.LinAlgError):  # contacts alone hold a part
            yield balance.without_contacts(point)
        if method.halvings:
            yield Loading(balance, replace(method, resolution=RESOLUTION), point).last()
        return
    assert isinstance(balance, Balance)  # that of the point
    lowered = balance.lowered
    pressed = any(block.normal and block.kind == ELASTIC for block in lowered.blocks)
    if not point.held and (lowered.laws or lowered.functions):
        # 1. Only elements hold a part: the place of rest under the static forces, from which stops are touched or
        # not.
        yield at_rest(balance, point)
    # 2. Closed contacts that stick, as under small varying forces; zero without such contacts.
    yield balance.stuck(point) if pressed else np.zeros(balance.shape)
    try:
        # 3. The motion without contacts, to which large forces are close.
        free = np.linalg.solve(point.stiffness, point.force[:, :, None])[:, :, 0]
    except np.linalg.LinAlgError:  # springs without a linear part hold the structure
        free = (np.linalg.pinv(point.stiffness) @ point.force[:, :, None])[:, :, 0]
    moved = balance.series.coefficients(free)
    yield moved
    # 4. A path over the varying forces from 1 % to all of them: the dearest guess, so a late one.
    if method.halvings:
        yield Loading(balance, replace(method, resolution=RESOLUTION), point).last()
    # 5. Rigid contacts just touched by the motion without them.
    if any(block.normal and block.kind != ELASTIC for block in lowered.blocks):
        yield balance.touching(moved)


@np.errstate(over="ignore", invalid="ignore")
def at_rest(balance: Balance, point: CondensedStructure) -> np.ndarray:
    """Return the unknowns (q, coefficients) of the place of rest, or where the search for it ended. Newton's method
    with an exact line search on the potential energy, whose slope along a step is that of the forces. Where no element
    is touched, the energy falls on a line, and the search ends at the element that stops the motion.
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


def _lowest(still: Balance, mean: CondensedStructure, places: np.ndarray, step: np.ndarray) -> float | None:
    """Return the part of a step with the least energy; None if the energy falls without end."""

    def slope(part: float) -> float:
        return float(np.sum(still.at(mean, places + part * step).residual * step))

    first, part = slope(0.0), 1.0
    for _ in range(DOUBLINGS):
        end_slope = slope(part)
        if abs(end_slope) <= BALANCED * abs(first):
            return part
        # E falls first and rises here: its minimum lies between. A step that does not fall at first has none to find.
        if end_slope > 0:
            return float(brentq(slope, 0.0, part)) if first < 0 else None  # pyright: ignore[reportArgumentType]
        part *= 2
    return None


@dataclass(frozen=True)
class Loading:
    """The equations at one frequency, with the part of the varying forces as the parameter in place of the frequency.
    Static forces act from the beginning: they may press the contacts. ``point``: there, with the whole force.
    """

    balance: AnyBalance
    method: HarmonicBalance
    point: Point

    def at(self, load: float) -> Point:
        """The structure with a part of the varying forces, and its derivatives by that."""
        return self.point.loaded(load)

    def solve(self, unknowns: np.ndarray, load: float, samples: int, plane: Constraint | None = None) -> Solution:
        """Newton's method from a guess."""
        return correct(self.balance, self.at, self.method, unknowns, load, plane)

    def placed(self, unknowns: np.ndarray, load: float, samples: int) -> Solution:
        """Return the balance and its tangent at a place, without an iteration."""
        return placed(self.balance, self.at(load), self.method, unknowns, load)

    def first(self, load: float) -> Solution:
        """Return the solution from closed contacts that stick."""
        balance: Any = self.balance
        return self.solve(balance.stuck(self.at(load)), load, balance.series.samples)

    def last(self) -> np.ndarray:
        """Return the unknowns at the end of the path over the force: at full force if the path reaches it."""
        unknowns = np.zeros(self.balance.shape)
        # A path may turn back, through none of the force even, before it comes to all of it.
        for point in islice(along(self, -1.0, 1.0, self.first(FIRST_LOAD)), MOST_STEPS):
            if point.solution.converged:
                unknowns = point.solution.unknowns
        return unknowns
