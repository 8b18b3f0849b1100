"""Continuation by arc length: a path of solutions over a parameter, past its folds and sharp turns."""

from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from typing import Protocol, TypeVar, cast

import numpy as np
from scipy.optimize import brentq

from dalembert.vibration.balance.harmonic_balance import HarmonicBalance
from dalembert.vibration.balance.newton import Constraint, CrossingPlane, Solution
from dalembert.vibration.balance.tangents import bordered, orientation
from dalembert.vibration.interface.condensed_structure import norm

STEADY = 0.9
"""Cosine of the angle between directions of a path, below which a step was too long."""
EASY = 4
"""Newton iterations of a step up to which the next step is longer."""
SHORTEST = 1e-7
"""Smallest step relative to the largest. Continuation stops below it."""
SHARP = 1e-3
"""Step, as part of the longest, from which on the path may have a sharp turn."""
CLOSE = 1e-5
"""Step, as part of the longest, from which on a turn is near enough for tangents of places ahead."""
REACHES = (1.0, 4.0, 16.0, 64.0)
"""Steps beyond a sharp turn, in parts of the one that failed before it."""
CLOSED, JOINED = "closed", "joined"
AWAY = 2.0
"""Distance from its first point, in steps, from which on a path may come back to it."""
FAR = 5.0
"""Distance of the point after a step, in steps, from which on it is one of another path, if it is also farther than
the size of the motion. Behind a corner a path may be farther than some of the short steps there."""
STILL = 1e-3
"""Motion, as part of what the forces would cause on the stiffness of the structure alone, that counts as none."""
MOST_POINTS = 20_000
POINTS = 300
"""Steps that together must be as long as the longest step; else the path makes no progress."""
Found = TypeVar("Found")


class PathProblem(Protocol):
    """Equations with a parameter, such as the frequency, over which paths are followed."""

    @property
    def method(self) -> HarmonicBalance: ...

    def solve(
        self, unknowns: np.ndarray, omega: float, samples: int, plane: Constraint | None = None, /
    ) -> Solution: ...

    def placed(self, unknowns: np.ndarray, omega: float, samples: int, /) -> Solution: ...

    def first(self, omega: float, /) -> Solution: ...


ACROSS_FOLD, MANY_ROWS = "fold", "rows"


@dataclass(frozen=True)
class PathPoint:
    """A point of a curve. ``fold``: whether the curve has a fold here, or where the turn is sharp, just before;
    ``returned``: whether the curve comes back here to the frequencies that were asked for; ``stable``: 1, 0, or -1
    where it is not known; ``marker``: kind of the bifurcation that lies here, or nothing; ``unjudged``: why stability
    is not known: ACROSS_FOLD if a fold lies between the motion and its perturbations, or MANY_ROWS; ``end``: why the
    path ends here inside its range: "closed" where it comes back to its first point, "joined" where a branch comes to
    the curve that it left.
    """

    solution: Solution
    fold: bool = False
    returned: bool = False
    stable: int = -1
    marker: str = ""
    unjudged: str = ""
    end: str = ""


@dataclass(frozen=True)
class Progress:
    """The last steps of a path, whose longest step is ``longest``."""

    longest: float
    steps: deque[float] = field(default_factory=lambda: deque(maxlen=POINTS))

    def ends(self, step: float) -> bool:
        """Add a step; return whether the last ones lead nowhere."""
        self.steps.append(step)
        return len(self.steps) == POINTS and sum(self.steps) < self.longest


def along(
    equations: PathProblem,
    begin: float,
    end: float,
    start: Solution | None,
    behind: float = 0.0,
    onward: np.ndarray | None = None,
) -> Iterator[PathPoint]:
    """Points along the curve from one frequency to another, by arc length, with its folds. ``onward``: a direction to
    whose side it begins, (unknowns + 1,); that of the frequencies if not given. A path that comes back to its first
    point ends there.
    """
    known = start if start is not None else equations.first(begin)
    yield PathPoint(known)
    if not known.converged:
        return
    # Scaled unknowns (U/size, ω/width): a tenth of the range counts as much as a motion of the present size. One width
    # for the whole path, so that steps compare; the size follows the motion.
    width = abs(end - begin) / 10
    longest = 10 * equations.method.resolution
    low, high = sorted((begin - behind * (end - begin), end))
    if onward is None:
        onward = np.zeros(known.unknowns.size + 1)
        onward[-1] = np.sign(end - begin)
    step, points, progress = longest / 4, 1, Progress(longest)
    path = PathTangent(known, direction_at(known, onward, width), width)
    first, gone = path, 0.0
    while points < MOST_POINTS:
        solution, direction = path.step(equations, step)
        # Behind a corner, such as a contact that opens at once, no shorter step converges: halving would only creep up
        # to it. The branch behind is sought from its own tangent.
        if direction is None and step <= SHARP * longest:
            beyond = path.turned(equations, solution, step, ahead=step <= CLOSE * longest)
            if beyond is not None:
                yield PathPoint(beyond.known, fold=bool(beyond.direction[-1] * path.direction[-1] < 0))
                path, points = beyond, points + 1
                continue
        bent = direction is not None and float(path.direction @ direction) < STEADY
        if direction is None or (bent and step > longest * 1e-2):
            step /= 2
            if step < SHORTEST * longest:
                yield PathPoint(solution)
                return
            continue
        # The path leaves the range: its last point is on the border, from a guess between the points on both sides.
        if not low <= solution.omega <= high:
            border = low if solution.omega < low else high
            last = equations.solve(*on_border(path.known, solution, border), solution.samples)
            yield PathPoint(last)
            return
        # dω/ds changes its sign: a fold lies within this step, and its point comes before the step's end.
        folds = bool(direction[-1] * path.direction[-1] < 0)
        fold = _fold(equations, path, step) if folds else None
        if fold is not None:
            yield PathPoint(fold, fold=True)
        gone = max(gone, first.distance(solution))
        if gone > AWAY * step and first.meets(solution, direction, step):
            yield PathPoint(solution, fold=folds and fold is None, end=CLOSED)
            return
        yield PathPoint(solution, fold=folds and fold is None)
        points += 1
        if progress.ends(step):
            return
        path = PathTangent(solution, direction_at(solution, direction, width), width)
        # The number of iterations measures how much the path bends in a step.
        step = min(longest, step * (1.5 if solution.iterations <= EASY else 0.7))


@dataclass(frozen=True)
class PathTangent:
    """A point of a curve and the direction of the curve there, in scaled unknowns."""

    known: Solution
    direction: np.ndarray
    width: float

    @property
    def size(self) -> float:
        return _size(self.known)

    def distance(self, solution: Solution) -> float:
        """Return the distance of a point in scaled unknowns."""
        moved = norm(solution.unknowns - self.known.unknowns) / self.size
        return float(np.hypot(moved, (solution.omega - self.known.omega) / self.width))

    def meets(self, solution: Solution, direction: np.ndarray | None, length: float) -> bool:
        """Return True if a step of a length to a point passes here, in the same direction."""
        alike = direction is not None and float(direction @ self.direction) > STEADY
        return alike and self.distance(solution) <= length

    def step(self, equations: PathProblem, length: float) -> tuple[Solution, np.ndarray | None]:
        """Return the point after a step, and the direction there in the scales of this point; None if not converged."""
        # The guess y + s t is corrected on the plane t · (y' - y - s t) = 0 across the path (pseudo-arc length).
        # Pseudo-arc length (Keller): a plane across the tangent keeps the added equation linear; `STEADY` refuses steps
        # that bend too much for it.
        guess, omega = self._guess(length)
        plane = CrossingPlane(self.direction, guess, omega, self.size, self.width)
        solution = equations.solve(guess, omega, self.known.samples, plane)
        # The plane may cross another path far away.
        if not solution.converged or self.distance(solution) > max(FAR * length, 1.0):
            return solution, None
        try:
            return solution, direction_at(solution, self.direction, self.width, self.size)
        except np.linalg.LinAlgError:  # a shorter step may end beside the singular point
            return solution, None

    def turned(self, equations: PathProblem, failed: Solution, length: float, ahead: bool) -> "PathTangent | None":
        """Return the path behind a sharp turn.

        Its tangent is that where a step over the turn failed, or, with ``ahead``, that of places ahead: on the old side
        of a kink the tangent where it failed is the old one. It is oriented by the sign of the determinant with the
        direction as a row, which a path keeps.
        """
        sign = _sign(self.known, self.direction, self.width, self.size)
        if not sign:
            return None
        # Pieces of a piecewise smooth map meet at a kink. On the new one the tangent solves J dU + ∂R/∂ω dω = 0 with
        # its Jacobian. It can be taken at any place of the piece (the pivots of piecewise linear homotopies: Allgower
        # and Georg, Numerical Continuation Methods, 1990, chapter 12).
        for reach in (0.0, *(REACHES if ahead else ())):
            place = failed if reach == 0.0 else self._ahead(equations, reach * length)
            beyond = self._tangent_of(place, sign)
            if beyond is None or (reach and float(beyond @ self.direction) > STEADY):
                continue
            path = self._along(equations, beyond, length, sign)
            if path is None and float(beyond @ self.direction) < 0:
                # Several kinks at once, as those of a symmetric motion, may change the sign: forwards then.
                path = self._along(equations, -beyond, length, 0.0)
            if path is not None:
                return path
        return None

    def _ahead(self, equations: PathProblem, length: float) -> Solution:
        """Return the balance at the guess of a step. It is not a solution."""
        return equations.placed(*self._guess(length), self.known.samples)

    def _guess(self, length: float) -> tuple[np.ndarray, float]:
        """Return the unknowns and the frequency at a distance along the tangent."""
        moved = self.direction[:-1].reshape(self.known.unknowns.shape) * (length * self.size)
        return self.known.unknowns + moved, self.known.omega + self.direction[-1] * length * self.width

    def _tangent_of(self, place: Solution, sign: float) -> np.ndarray | None:
        """Return the tangent at a place, oriented; None if there is none."""
        try:
            beyond = direction_at(place, self.direction, self.width, self.size)
        except np.linalg.LinAlgError:
            return None
        if not np.all(np.isfinite(beyond)):
            return None
        # A path of regular points keeps the sign of det(J, ∂R/∂ω; t): it chooses between both senses of the tangent.
        beyond *= sign * _sign(place, beyond, self.width, self.size)
        return beyond if np.any(beyond) else None

    def _along(self, equations: PathProblem, beyond: np.ndarray, length: float, sign: float) -> "PathTangent | None":
        """Return the path at the end of a step along a tangent behind a turn; None if no step reaches it. ``sign``: of
        the determinant there; 0 for any.
        """
        for reach in REACHES:
            # Longer and longer steps along that tangent, until one reaches the branch behind.
            solution, direction = replace(self, direction=beyond).step(equations, reach * length)
            if direction is None or float(direction @ beyond) < STEADY:
                continue
            if not sign or _sign(solution, direction, self.width, self.size) == sign:
                return PathTangent(solution, direction_at(solution, direction, self.width), self.width)
        return None


def _sign(known: Solution, direction: np.ndarray, width: float, size: float) -> float:
    return orientation(known.tangent, direction, (size, width, known.scale))


def _size(known: Solution) -> float:
    """Size of the unknowns; where all contacts stick and these are rounding, a part of what the forces could move."""
    return max(norm(known.unknowns), STILL * known.point.load / (known.point.stiffest or 1.0)) or 1.0


def direction_at(known: Solution, before: np.ndarray, width: float, size: float | None = None) -> np.ndarray:
    """Return the unit tangent of the curve in scaled unknowns, in the sense of the one before."""
    # (J, ∂R/∂ω; t_beforeᵀ) t = (0; 1): the tangent has J dU + ∂R/∂ω dω = 0, and goes to the side of the one before.
    size = size or _size(known)
    change, turned = bordered(known.tangent, before, (size, width, known.scale), np.zeros_like(known.unknowns), 1.0)
    tangent = np.append(change, turned)
    return tangent / np.linalg.norm(tangent)


def on_border(before: Solution, after: Solution, border: float) -> tuple[np.ndarray, float]:
    """Return a guess of the point at which the curve between two points crosses a limit of the frequencies."""
    part = (border - before.omega) / (after.omega - before.omega)
    return before.unknowns + part * (after.unknowns - before.unknowns), border


def _fold(equations: PathProblem, path: PathTangent, step: float) -> Solution | None:
    """Return the fold within a step: the point at which the last component of the direction is zero."""

    def turning(length: float) -> tuple[Solution, float]:
        solution, direction = path.step(equations, length)
        return solution, float("nan") if direction is None else float(direction[-1])

    return zero_between(turning, step, {0.0: (path.known, float(path.direction[-1]))}, 1e-6 * step)


def zero_between(
    trial: Callable[[float], tuple[Found, float]], end: float, tried: dict[float, tuple[Found, float]], tolerance: float
) -> Found | None:
    """Return what a trial between 0 and an end gives where its value is zero; None if a trial gives no value.

    ``tried`` gets all trials, and has those that are known.
    """

    def value(part: float) -> float:
        if part not in tried:
            tried[part] = trial(part)
        return tried[part][1]

    try:
        value(part := float(cast(float, brentq(value, 0.0, end, xtol=tolerance))))
    except (ValueError, RuntimeError):  # a point in between was not found, or lies on another branch
        return None
    return tried[part][0]
