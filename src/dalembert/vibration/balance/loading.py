"""A path over the varying forces at one frequency, to a first solution."""

from dataclasses import dataclass, replace
from itertools import islice

import numpy as np

from dalembert.vibration.balance.arc_length import along
from dalembert.vibration.balance.balance import Balance
from dalembert.vibration.balance.harmonic_balance import HarmonicBalance
from dalembert.vibration.balance.newton import Plane, Solution, correct
from dalembert.vibration.interface.condensation import Point

FIRST_LOAD = 0.01
"""Part of the force at the start of the path, at which pressed contacts stick."""
RESOLUTION = 0.1
"""Resolution of the path, whose points are not kept."""
MOST_STEPS = 120
"""Points after which continuation stops."""


@dataclass(frozen=True)
class Loading:
    """The equations at one frequency, with the part of the varying forces as the parameter in place of the frequency.

    Static forces act from the beginning: they may be what presses the contacts.

    ``point``: at the frequency, with all of the force.
    """

    balance: Balance
    method: HarmonicBalance
    point: Point

    def at(self, load: float) -> Point:
        """The structure with a part of the varying forces, and its derivatives by that."""
        # f(p) = f_0 + p f_varying at one frequency: ∂R/∂p = -f_varying, and no matrix depends on p. Static forces stay,
        # as they may be what presses the contacts.
        varying = np.where(self.point.frequencies[:, None] > 0, self.point.force, 0.0)
        return replace(
            self.point, slope=np.zeros_like(self.point.slope),
            force=self.point.force + (load - 1.0) * varying, force_slope=varying, rate=0.0,
        )  # fmt: skip

    def solve(self, unknowns: np.ndarray, load: float, samples: int, plane: Plane | None = None) -> Solution:
        """Newton's method from a guess."""
        return correct(self.balance, self.at, self.method, unknowns, load, plane)

    def first(self, load: float) -> Solution:
        """Return the solution from closed contacts that stick."""
        return self.solve(self.balance.stuck(self.at(load)), load, self.balance.series.samples)

    def last(self) -> np.ndarray:
        """Return the unknowns at the end of the path over the force: at full force if the path reaches it."""
        unknowns = np.zeros(self.balance.shape)
        # A path may turn back, through none of the force even, before it comes to all of it.
        for found in islice(along(self, -1.0, 1.0, self.first(FIRST_LOAD)), MOST_STEPS):
            if found.solution.converged:
                unknowns = found.solution.unknowns
        return unknowns
