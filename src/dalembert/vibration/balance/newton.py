"""Newton's method for the equations of harmonic balance, at a frequency or on a plane across a path.

The forces have kinks, at which Newton's method takes the derivative of one side (a semismooth method); a line search on
the residual keeps it from jumping between the sides.
"""

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from dalembert.vibration.balance.balance import Balance, Evaluation
from dalembert.vibration.balance.condensation import Point, norm
from dalembert.vibration.balance.harmonic_balance import HarmonicBalance
from dalembert.vibration.balance.tangents import Tangent, bordered

DAMPINGS = (1.0, 0.5, 0.25, 0.125, 0.03125)
"""Parts of a Newton step of the line search, until the residual falls."""
PATIENCE, PROGRESS = 10, 0.7
"""Newton's method stops if this many iterations do not reduce the least residual to this part."""
COARSE = 1e-6
"""Residual of the linear system of a step, as part of its right-hand side, where that is iterated."""
ROUNDING = 100 * np.finfo(float).eps
VERIFIED = 1e-8
"""Residual, as part of the forces, above which no rounding is an excuse: nothing is balanced there."""


class Condensed(Protocol):
    """A condensed structure at each value of the parameter of a path, ω or another."""

    def at(self, omega: float, /) -> Point: ...


@dataclass(frozen=True)
class Plane:
    """A plane across a path in scaled unknowns: direction · (y - place) = 0, with y = (U/size, ω/width).

    Parameters
    ----------
    direction : array, shape (unknowns + 1,)
    unknowns : array, shape (q, coefficients)
    omega : float
        A place on the plane.
    size, width : float
        Scales of U and of ω.
    """

    direction: np.ndarray
    unknowns: np.ndarray
    omega: float
    size: float
    width: float

    def distance(self, unknowns: np.ndarray, omega: float) -> float:
        """Return the distance of a point from the plane."""
        moved = np.append((unknowns - self.unknowns).ravel() / self.size, (omega - self.omega) / self.width)
        return float(self.direction @ moved)


@dataclass(frozen=True)
class Solution:
    """Last iterate of Newton's method, converged or not.

    Parameters
    ----------
    omega : float
    unknowns : array, shape (q, coefficients)
    point : Point
    evaluation : Evaluation
    tangent : Tangent
    iterations : int
    error : float
        Residual as part of the forces.
    converged : bool
    samples : int
    sampling_error : float
        Change of the residual with twice the samples, as part of the forces.
    """

    omega: float
    unknowns: np.ndarray
    point: Point
    evaluation: Evaluation
    tangent: Tangent
    iterations: int
    error: float
    converged: bool
    samples: int
    sampling_error: float = np.nan

    def rate(self) -> np.ndarray:
        """dU/dω along the path, (q, coefficients)."""
        return -self.tangent.solve(self.tangent.slope[:, :, None], COARSE)[:, :, 0]


@dataclass(frozen=True)
class _Place:
    """A trial."""

    unknowns: np.ndarray
    omega: float
    point: Point
    evaluation: Evaluation
    tangent: Tangent | None
    scale: float
    floor: float
    distance: float
    error: float


def correct(
    balance: Balance,
    condensation: Condensed,
    method: HarmonicBalance,
    unknowns: np.ndarray,
    omega: float,
    plane: Plane | None = None,
    point: Point | None = None,
) -> Solution:
    """Solve by Newton's method from a guess, at ω or on a plane. ``point`` is the structure at ω if it is known."""

    def place(unknowns: np.ndarray, omega: float, point: Point | None, step: bool = True) -> _Place:
        point = condensation.at(omega) if point is None else point
        evaluation, tangent = evaluated(balance, point, unknowns) if step else (balance.at(point, unknowns), None)
        scale = point.load + norm(evaluation.forces) or 1.0
        floor = ROUNDING * point.stiffest * norm(unknowns)
        distance = 0.0 if plane is None else plane.distance(unknowns, omega)
        error = math.hypot(norm(evaluation.residual) / scale, distance)
        return _Place(unknowns, omega, point, evaluation, tangent, scale, floor / scale, distance, error)

    at, converged = place(unknowns, omega, point), False
    errors = [at.error]
    while True:
        converged = at.error <= max(method.tolerance, min(at.floor, VERIFIED))
        if converged or len(errors) > method.iterations or _stalls(errors):
            break
        step = _step(at, plane)
        if step is None:
            break
        trials = []
        for part in DAMPINGS:
            moved, turned = at.unknowns + part * step[0], at.omega + part * step[1]
            # Most steps go all the way; after one that does not, the Jacobian is made only where the search ends.
            trials.append(place(moved, turned, at.point if plane is None else None, step=part == 1.0))
            if trials[-1].error <= (1 - 0.1 * part) * at.error:
                break
        finite = [trial for trial in trials if np.isfinite(trial.error)]
        if not finite:
            break
        at = min(finite, key=lambda trial: trial.error)
        at = at if at.tangent is not None else place(at.unknowns, at.omega, at.point)
        errors.append(at.error)
    assert at.tangent is not None
    return Solution(
        at.omega, at.unknowns, at.point, at.evaluation, at.tangent, len(errors) - 1, at.error, converged,
        balance.series.samples,
    )  # fmt: skip


def evaluated(balance: Balance, point: Point, unknowns: np.ndarray) -> tuple[Evaluation, Tangent]:
    """Residual and forces at unknowns, with the tangent."""
    tangent = balance.tangent(point, unknowns)
    return balance.at(point, unknowns, tangent), tangent


def _stalls(errors: list[float]) -> bool:
    """Whether residuals stagnate: Newton's method alternates between the sides of kinks."""
    if not np.isfinite(errors[-1]):
        return True
    return len(errors) > PATIENCE and min(errors[-PATIENCE:]) > PROGRESS * min(errors[:-PATIENCE])


def _step(at: _Place, plane: Plane | None) -> tuple[np.ndarray, float] | None:
    """Newton's step of U and ω; None where the matrix is singular."""
    residual = at.evaluation.residual
    assert at.tangent is not None
    try:
        if plane is not None:
            scales = plane.size, plane.width, at.scale
            top = -residual / at.scale
            change, turned = bordered(at.tangent, plane.direction, scales, top, -at.distance, COARSE)
            return change * plane.size, turned * plane.width
        return -at.tangent.solve(residual[:, :, None], COARSE)[:, :, 0], 0.0
    except np.linalg.LinAlgError:
        return None
