"""Newton's method for the equations of harmonic balance, at a frequency or on a plane across a path.

The forces have kinks, at which Newton's method takes the derivative of one side (a semismooth method); a line search on
the residual keeps it from jumping between the sides.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any, Protocol, TypeVar

import numpy as np

from dalembert.vibration.balance.balance import Balance, Evaluation
from dalembert.vibration.balance.harmonic_balance import HarmonicBalance
from dalembert.vibration.balance.receptance_balance import ReceptanceBalance
from dalembert.vibration.balance.tangents import Tangent, bordered
from dalembert.vibration.interface.condensed_structure import CondensedStructure, norm
from dalembert.vibration.interface.receptances import ReceptancePoint

Point = CondensedStructure | ReceptancePoint
AnyBalance = Balance | ReceptanceBalance
DAMPINGS = (1.0, 0.5, 0.25, 0.125, 0.03125)
"""Parts of a Newton step of the line search, until the residual falls."""
PATIENCE, PROGRESS = 10, 0.7
"""Newton's method stops if this many iterations do not reduce the least residual to this part."""
Trial = TypeVar("Trial")
ROUNDING = 100 * np.finfo(float).eps
VERIFIED = 1e-8
"""Residual, as part of the forces, above which no rounding is an excuse: nothing is balanced there."""


class Constraint(Protocol):
    """A further equation, for a further unknown: the frequency, or another parameter. ``size``, ``width``: scales of
    the unknowns and of the parameter.
    """

    @property
    def size(self) -> float: ...

    @property
    def width(self) -> float: ...

    def distance(self, unknowns: np.ndarray, omega: float, point: Point) -> float:
        """Return what has to be zero, without dimension."""
        ...

    def slope(self, unknowns: np.ndarray, omega: float, point: Point) -> np.ndarray:
        """Return its derivatives by the scaled unknowns and the scaled parameter, (unknowns + 1,)."""
        ...

    def numbers(self) -> list[np.ndarray]:
        """Return all that it depends on."""
        ...


@dataclass(frozen=True)
class CrossingPlane:
    """A plane across a path in scaled unknowns: direction · (y - place) = 0, with y = (U/size, ω/width). ``direction``
    (unknowns + 1,); ``unknowns`` (q, coefficients), ``omega``: a point on the plane.
    """

    direction: np.ndarray
    unknowns: np.ndarray
    omega: float
    size: float
    width: float

    def distance(self, unknowns: np.ndarray, omega: float, point: Point) -> float:
        """Return the distance of a point from the plane."""
        moved = np.append((unknowns - self.unknowns).ravel() / self.size, (omega - self.omega) / self.width)
        return float(self.direction @ moved)

    def slope(self, unknowns: np.ndarray, omega: float, point: Point) -> np.ndarray:
        """Return the direction, which is the same everywhere."""
        return self.direction

    def numbers(self) -> list[np.ndarray]:
        """Return all that it depends on."""
        return [self.direction, self.unknowns, np.array([self.omega, self.size, self.width])]


@dataclass(frozen=True)
class Solution:
    """Last iterate of Newton's method, converged or not. ``unknowns`` (q, coefficients); ``scale``: size of the forces
    that are in balance, N; ``error``: residual as part of the forces; ``sampling_error``: change of the residual with
    twice the samples, as part of the forces; ``distance``: from the plane across the path on which it was sought, in
    the plane's scales; 0 without a plane; ``load``: part of the varying forces that acts.
    """

    omega: float
    unknowns: np.ndarray
    point: Point
    evaluation: Evaluation
    tangent: Tangent
    scale: float
    iterations: int
    error: float
    converged: bool
    samples: int
    sampling_error: float = np.nan
    distance: float = 0.0
    load: float = 1.0

    @property
    def left(self) -> float:
        """Norm of the residual, N."""
        return norm(self.evaluation.residual) * self._newtons

    @property
    def acting(self) -> float:
        """Norm of the loads, N."""
        return self.point.load * self._newtons

    @property
    def _newtons(self) -> float:
        """Forces by residuals: by receptances these are displacements, of rows as stiff as contacts."""
        return 1.0 if isinstance(self.point, CondensedStructure) else float(self.point.stuck.reference.max(initial=0.0))

    @property
    def condensed(self) -> CondensedStructure:
        """The condensed structure of a solution by dynamic stiffnesses."""
        if isinstance(self.point, CondensedStructure):
            return self.point
        raise TypeError("the solution is one by receptances, without a condensed structure")

    def rate(self) -> np.ndarray:
        """dU/dω along the path, (q, coefficients)."""
        return -self.tangent.solve(self.tangent.slope[:, :, None], self.tangent.forcing)[:, :, 0]


def line_search(trial: Callable[[float], Trial], error: float) -> Trial | None:
    """Return the trial at the longest part of a step that reduces the error, else the best one; None if none is finite.

    A part p is long enough with a reduction to :math:`1 - p/10` of the error (Armijo's rule).
    """
    trials: list[Any] = []
    for part in DAMPINGS:
        trials.append(trial(part))
        if trials[-1].error <= (1 - 0.1 * part) * error:
            break
    # At a kink the residual may rise behind every part. The best one is taken then: Newton's method needs to cross to
    # the other side, and a rule that demands a fall would stop here.
    return min(
        (candidate for candidate in trials if np.isfinite(candidate.error)),
        key=lambda candidate: candidate.error,
        default=None,
    )


@np.errstate(over="ignore", invalid="ignore")  # a trial may lie beyond what a law is for: the search returns
def correct(
    balance: AnyBalance,
    structure: Callable[[float], Point],
    method: HarmonicBalance,
    unknowns: np.ndarray,
    omega: float,
    plane: Constraint | None = None,
    point: Point | None = None,
) -> Solution:
    """Solve by Newton's method from a guess, at ω or on a plane. ``structure`` returns the condensed structure at a
    value of ω, or of another parameter of the path; ``point`` is that at ω if it is known; ``plane``: an equation for
    ω.
    """

    def place(unknowns: np.ndarray, omega: float, point: Any, step: bool = True) -> Solution:
        point = structure(omega) if point is None else point
        return placed(balance, point, method, unknowns, omega, plane, step, len(errors))

    def moved(at: Solution, step: tuple[np.ndarray, float], part: float) -> Solution:
        # Most steps go all the way; after one that does not, the Jacobian is made only where the search ends.
        known = at.point if plane is None else None
        return place(at.unknowns + part * step[0], at.omega + part * step[1], known, step=part == 1.0)

    errors: list[float] = []
    at = place(unknowns, omega, point)
    errors.append(at.error)
    # Semismooth Newton: at a kink the tangent is that of one side, which still converges, since pieces are finite in
    # number (Qi and Sun, Mathematical Programming 58, 1993). The line search stops it from alternating.
    while not (at.converged or len(errors) > method.iterations or _stalls(errors)):
        step = _step(at, plane)
        if step is None:
            break
        best = line_search(partial(moved, at, step), at.error)
        if best is None:
            break
        at = best if best.tangent is not None else place(best.unknowns, best.omega, best.point)
        errors.append(at.error)
    return at


def placed(
    balance: AnyBalance,
    point: Point,
    method: HarmonicBalance,
    unknowns: np.ndarray,
    omega: float,
    plane: Constraint | None = None,
    step: bool = True,
    iterations: int = 0,
) -> Solution:
    """Evaluate the balance at a place, after some iterations. ``step``: with its tangent."""
    of: Any = balance  # its points are those that its structure returns
    linearised: Any = of.linearised(point, unknowns) if step else (of.at(point, unknowns), None)
    evaluation, tangent = linearised
    distance = 0.0 if plane is None else plane.distance(unknowns, omega, point)
    scale = evaluation.scale
    # On a plane two equations hold, R = 0 and distance = 0, both without dimension: one error for both.
    error = math.hypot(norm(evaluation.residual) / scale, distance)
    # Terms as large as Z U cancel in R, so that a residual of some 100 eps of them is rounding. `VERIFIED` limits the
    # excuse: with a stiff penalty rounding would otherwise pass motions that are not in balance.
    rounding = min(ROUNDING * max(point.stiffest * norm(unknowns), evaluation.terms) / scale, VERIFIED)
    converged = error <= max(method.tolerance, rounding)
    return Solution(
        omega, unknowns, point, evaluation, tangent, scale, iterations, error, converged, balance.series.samples,
        distance=distance,
    )  # fmt: skip


def _stalls(errors: list[float]) -> bool:
    """Whether residuals stagnate: Newton's method alternates between the sides of kinks."""
    # A law beyond its domain returns no finite force; no part of this step is better.
    if not np.isfinite(errors[-1]):
        return True
    return len(errors) > PATIENCE and min(errors[-PATIENCE:]) > PROGRESS * min(errors[:-PATIENCE])


def _step(at: Solution, plane: Constraint | None) -> tuple[np.ndarray, float] | None:
    """Newton's step of U and ω; None where the matrix is singular."""
    residual = at.evaluation.residual
    try:
        if plane is not None:
            scales = plane.size, plane.width, at.scale
            top = -residual / at.scale
            # J dU + ∂R/∂ω dω = -R, bordered by the derivatives of the further equation.
            row = plane.slope(at.unknowns, at.omega, at.point)
            change, turned = bordered(at.tangent, row, scales, top, -at.distance, at.tangent.forcing)
            return change * plane.size, turned * plane.width
        return -at.tangent.solve(residual[:, :, None], at.tangent.forcing)[:, :, 0], 0.0
    except np.linalg.LinAlgError:
        return None
