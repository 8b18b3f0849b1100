"""Equilibria along a load, past limit points, with the loads at which they become unstable."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.linalg import eigh, null_space
from scipy.optimize import root_scalar
from scipy.sparse import bmat, csr_matrix
from scipy.sparse.linalg import splu

from dalembert.argument_readers import names_of
from dalembert.arguments import takes_checked
from dalembert.errors import InputError, SolveError, shown
from dalembert.multibody.model.evaluate import residual, tangent
from dalembert.multibody.model.lowered import Lowered, scales
from dalembert.multibody.model.lowering import lower
from dalembert.multibody.model.observe import observer
from dalembert.multibody.model.system import BaseSystem
from dalembert.multibody.start.equilibrium_start import resting_place
from dalembert.multibody.start.mixed_points import MixedPoints
from dalembert.multibody.start.statics import placed_at_start

_DIFFERENCE = 1e-6
"""Step of the load, as part of its range, for the derivative of the forces: it directs the search alone."""
_MOST_ITERATIONS = 12
_FEW_ITERATIONS = 4
"""Iterations after which a step keeps its length; with fewer it grows, with more it shrinks."""
_SHORTEST = 1e-4
"""Part of the first step: the path ends where it needs a shorter one."""
_LONGEST = 4.0
"""The longest step, in first steps."""
_CLOSED = 1e-10
"""Newton's correction, over the scales, at which an equilibrium counts as reached."""
_ROUNDING = 1e-13
"""Eigenvalue, as part of the largest one, of a motion without stiffness."""


@dataclass(frozen=True, eq=False)
class CriticalPoint:
    """An equilibrium at which the stiffness against a motion vanishes.

    Parameters
    ----------
    load : float
    kind : {"limit", "branch"}
        At a limit point the load turns; at a branch point other equilibria begin: the structure buckles.
    x : array, shape (N + 1,)
        As of an :class:`Equilibrium`.
    shape : array, shape (N + 1,)
        The motion without stiffness; its entry of largest magnitude is 1. Rows of multipliers are zero.
    """

    load: float
    kind: str
    x: np.ndarray
    shape: np.ndarray


@dataclass(frozen=True, eq=False)
class EquilibriumPath:
    """Equilibria along a load, as :func:`equilibrium_path` returns them.

    Parameters
    ----------
    loads : array, shape (points,)
    stable : array of bool, shape (points,)
        Whether every motion that the joints leave free has a positive stiffness.
    critical : tuple of CriticalPoint
        In the order of the path.
    x : array, shape (points, N + 1)
        States, as of an :class:`Equilibrium`.
    """

    loads: np.ndarray
    stable: np.ndarray
    critical: tuple[CriticalPoint, ...]
    x: np.ndarray
    build: Callable[[float], BaseSystem]

    def channels(self, names: Sequence[str]) -> np.ndarray:
        """Values of channels along the path, (points, channels)."""
        names, values = names_of(names, "EquilibriumPath", "channels"), []
        for load, x in zip(self.loads, self.x, strict=True):
            system, still = self.build(float(load)), np.zeros((1, len(x)))
            lowered = lower(system)
            own = observer(system, lowered, names)
            values.append(own.read(lowered, lowered.real, (x[None], still, still), np.zeros(1))[0])
        return np.array(values)


@takes_checked("build")
def equilibrium_path(
    build: Callable[[float], BaseSystem], start: float, end: float, steps: int = 20, most_points: int = 500
) -> EquilibriumPath:
    """Follow the equilibria of a mechanism from one load to another, past limit points.

    The path is followed by its arc length, so that the load may fall along it, as that of an arch that snaps through.
    Between two points of which one has more motions with a negative stiffness, the load is found at which the stiffness
    vanishes. Stiffness that is not symmetric, of follower forces, is judged by its symmetric part.

    Parameters
    ----------
    build : callable
        From the load, or any other number, to a system. Only numbers of components may depend on it.
    start, end : float
        The path begins at the equilibrium nearest to the placement of ``build(start)``, and ends where the load
        reaches ``end``.
    steps : int
        Number of steps in the range of the load, for the length of the first one; later ones adapt.
    most_points : int
        Where the path ends at the latest, as where the load never reaches ``end``.

    Raises
    ------
    InputError
        For a range without a length.
    SolveError
        Where there is no equilibrium at the start, or the path cannot be followed from there.

    References
    ----------
    Keller, H. B.: Numerical solution of bifurcation and nonlinear eigenvalue problems. Applications of Bifurcation
    Theory, 1977.

    Examples
    --------
    Two springs that form a flat arch, pushed down at the apex, snap through:

    >>> from dalembert.multibody import Force, PointMass, Spring, System
    >>> def arch(load):
    ...     system = System(gravity=(0.0, 0.0))
    ...     apex = system.add(PointMass("apex", mass=1.0, position=(0.0, 0.1)))
    ...     for name, x in (("left", -1.0), ("right", 1.0)):
    ...         ground = system.ground.point(x, 0.0)
    ...         _ = system.add(Spring(name, ground, apex.centre, stiffness=1e4, free_length=1.01**0.5))
    ...     _ = system.add(Force("push", apex.centre, y=-load))
    ...     return system
    >>> path = equilibrium_path(arch, 0.0, 10.0)
    >>> [(point.kind, round(float(point.load), 3)) for point in path.critical]
    [('limit', 3.83), ('limit', -3.83)]
    """
    if not (np.isfinite(start) and np.isfinite(end)) or start == end:
        raise InputError(f"equilibrium_path: start and end are {shown(start)} and {shown(end)}; expected two loads")
    follower = _Follower(build, start, end, steps)
    points, critical = [follower.first()], []
    for point in follower.follow(points[0]):
        critical += follower.between(points[-1], point)
        points.append(point)
        if len(points) >= most_points:
            break
    return EquilibriumPath(
        np.array([point.load for point in points]),
        np.array([point.negatives == 0 for point in points]),
        tuple(critical),
        np.array([point.x for point in points]),
        build,
    )


class _Point(NamedTuple):
    """An equilibrium: its load, unknowns (N + 1,), the unit direction of the path there (n + 1,) by scaled coordinates
    and load, and eigenvalues of the scaled stiffness, ascending.
    """

    load: float
    x: np.ndarray
    direction: np.ndarray
    eigenvalues: np.ndarray

    @property
    def negatives(self) -> int:
        """Number of motions with a negative stiffness."""
        return int(np.sum(self.eigenvalues < -_ROUNDING * np.abs(self.eigenvalues).max(initial=0.0)))


class _Follower:
    """The path of one mechanism. Lengths are those of (coordinates over their scales, load over its range)."""

    def __init__(self, build: Callable[[float], BaseSystem], start: float, end: float, steps: int) -> None:
        self.build, self.start, self.end = build, float(start), float(end)
        self.range, self.length = end - start, 1.0 / steps
        self.placed = placed_at_start(build(self.start))
        self.n = self.placed.structure.n
        self.scale = scales(self.placed)[: self.n] * np.sqrt(self.n)  # the root mean square of the coordinates

    def lowered(self, load: float) -> Lowered:
        """The mechanism at a load."""
        lowered = lower(self.build(load))
        if lowered.structure.size != self.placed.structure.size:
            raise InputError(
                f"equilibrium_path: build({load:g}) has {lowered.structure.size} unknowns, and build({self.start:g}) "
                f"{self.placed.structure.size}; expected the same components at all loads"
            )
        return lowered

    def forces(self, lowered: Lowered, x: np.ndarray) -> np.ndarray:
        """The residual at rest, (N,)."""
        still = np.zeros_like(x)
        return residual(lowered, lowered.real, x, still, still)

    def first(self) -> _Point:
        """The equilibrium at the start."""
        x, _ = resting_place(self.placed)
        along = np.zeros(self.n + 1)
        along[-1] = 1.0
        return self._at(self.placed, self.start, x, along)

    def follow(self, point: _Point) -> Iterator[_Point]:
        """Points of the path until the load reaches its end."""
        step = self.length
        while True:
            moved = self._corrected(point, step)
            while moved is None:
                step /= 2
                if step < _SHORTEST * self.length:
                    raise SolveError(
                        f"the path of equilibria ends at the load {point.load:.6g}: no equilibrium was found beyond. "
                        "Another path may cross it there; begin at another load, or add an imperfection"
                    )
                moved = self._corrected(point, step)
            following, iterations = moved
            if (following.load - self.end) * self.range >= 0.0:
                # A step that ends at the load itself.
                last = self._at_load(point, following)
                yield following if last is None else last
                return
            yield following
            point = following
            if (point.load - self.start) / self.range < -2.0:
                return
            grown = float(np.clip((_FEW_ITERATIONS / iterations) ** 0.5, 0.5, 1.5))
            step = min(step * grown, _LONGEST * self.length)

    def between(self, first: _Point, second: _Point) -> list[CriticalPoint]:
        """Points between two others at which a stiffness vanishes."""
        lower_count, higher = sorted((first.negatives, second.negatives))
        turns = first.direction[-1] * second.direction[-1] < 0.0
        way = self._way(first, second)
        critical = []
        for number in range(lower_count, higher):

            def stiffness(step: float, number: int = number) -> float:
                moved = self._corrected(first, step) if step > 0.0 else (first, 0)
                if moved is None:
                    raise SolveError(
                        f"the point without stiffness near the load {first.load:.6g} was not found. Use more steps"
                    )
                return moved[0].eigenvalues[number]

            end = self._step_to(first, second, way)
            if stiffness(0.0) * stiffness(end) < 0.0:
                place = root_scalar(stiffness, bracket=(0.0, end), xtol=1e-9 * way).root
            else:  # one of the two points is the critical one, to rounding
                place = min((0.0, end), key=lambda step: abs(stiffness(step)))
            point = moved[0] if place and (moved := self._corrected(first, place)) else first
            critical.append(self._critical(point, number, turns and higher - lower_count == 1))
        return critical

    def _way(self, first: _Point, second: _Point) -> float:
        """Distance of two points."""
        gap = (second.x[: self.n] - first.x[: self.n]) / self.scale
        return float(np.sqrt(gap @ gap + ((second.load - first.load) / self.range) ** 2))

    def _step_to(self, first: _Point, second: _Point, way: float) -> float:
        """Step along the direction of the first point that leads to the second one."""
        gap = np.append((second.x[: self.n] - first.x[: self.n]) / self.scale, (second.load - first.load) / self.range)
        return max(float(first.direction @ gap), 1e-3 * way)

    def _bordered(self, matrix: csr_matrix, by_load: np.ndarray, direction: np.ndarray) -> csr_matrix:
        """Newton's matrix with the derivative by the load, and the plane across the direction, (N + 1, N + 1)."""
        row = np.zeros((1, len(by_load)))
        row[0, : self.n] = direction[:-1] / self.scale
        corner = np.array([[direction[-1] / self.range]])
        return csr_matrix(bmat([[matrix, by_load[:, None]], [row, corner]]))

    def _by_load(self, lowered: Lowered, load: float, x: np.ndarray) -> np.ndarray:
        """Derivative of the forces by the load, (N,)."""
        h = _DIFFERENCE * self.range
        return (self.forces(self.lowered(load + h), x) - self.forces(lowered, x)) / h

    def _corrected(self, point: _Point, step: float) -> tuple[_Point, int] | None:
        """The point of the path in the plane across the direction, a step ahead, and Newton's iterations."""
        x, load = point.x.copy(), point.load + step * point.direction[-1] * self.range
        x[: self.n] += step * point.direction[:-1] * self.scale
        lowered = self.lowered(load)
        mixed = MixedPoints(lowered)
        for iteration in range(1, _MOST_ITERATIONS + 1):
            still = np.zeros_like(x)
            matrix = self._bordered(
                tangent(mixed.lowered, x, still, (1.0, 0.0, 0.0)), self._by_load(lowered, load, x), point.direction
            )
            change = _solved(matrix, np.append(-self.forces(lowered, x), 0.0))
            if change is None:
                return None
            size = np.abs(change[: self.n] / self.scale).max(initial=abs(change[-1] / self.range))
            if not size < 10.0 * max(step, self.length):
                return None
            mixed.step(x, change[:-1])
            x[:-1] += change[:-1]
            load += change[-1]
            lowered = self.lowered(load)
            if size < _CLOSED:
                return self._at(lowered, load, x, point.direction), iteration
        return None

    def _at_load(self, point: _Point, beyond: _Point) -> _Point | None:
        """The equilibrium at the end of the range, between two points."""
        lowered = self.lowered(self.end)
        share = (self.end - point.load) / (beyond.load - point.load)
        x = point.x + share * (beyond.x - point.x)
        for _ in range(2 * _MOST_ITERATIONS):
            change = _solved(tangent(lowered, x, np.zeros_like(x), (1.0, 0.0, 0.0)), -self.forces(lowered, x))
            if change is None or not np.abs(change[: self.n] / self.scale).max() < 10.0 * self.length:
                return None
            x[:-1] += change
            if np.abs(change[: self.n] / self.scale).max() < _CLOSED:
                return self._at(lowered, self.end, x, beyond.direction)
        return None

    def _at(self, lowered: Lowered, load: float, x: np.ndarray, before: np.ndarray) -> _Point:
        """The point with its direction, which continues that before it, and its stiffness."""
        matrix = tangent(lowered, x, np.zeros_like(x), (1.0, 0.0, 0.0))
        by_load = self._by_load(lowered, load, x)
        way = _solved(self._bordered(matrix, by_load, before), np.append(0.0 * by_load, 1.0))
        if way is None:
            direction = before
        else:
            direction = np.append(way[: self.n] / self.scale, way[-1] / self.range)
            direction = direction / np.linalg.norm(direction)
        return _Point(load, x, direction, self._stiffness(matrix)[0])

    def _stiffness(self, matrix: csr_matrix) -> tuple[np.ndarray, np.ndarray]:
        """Eigenvalues of the scaled stiffness on free motions, ascending, and these motions (n, free)."""
        full, n = matrix.toarray(), self.n
        free = null_space(full[n:, :n] * self.scale) if len(full) > n else np.eye(n)
        free = self.scale[:, None] * free
        own = free.T @ full[:n, :n] @ free
        # In units of the diagonal: stretch and bending of slender beams differ by powers of ten.
        size = np.sqrt(np.maximum(np.abs(np.diagonal(own)), 1e-14 * np.abs(own).max(initial=1e-300)))
        values, vectors = eigh((own + own.T) / (2.0 * np.outer(size, size)))
        return values, free @ (vectors / size[:, None])

    def _critical(self, point: _Point, number: int, turns: bool) -> CriticalPoint:
        matrix = tangent(self.lowered(point.load), point.x, np.zeros_like(point.x), (1.0, 0.0, 0.0))
        shape = np.zeros_like(point.x)
        shape[: self.n] = self._stiffness(matrix)[1][:, number]
        shape /= shape[np.argmax(np.abs(shape))]
        return CriticalPoint(point.load, "limit" if turns else "branch", point.x, shape)


def _solved(matrix: csr_matrix, rhs: np.ndarray) -> np.ndarray | None:
    """The solution of a sparse system; None where it is singular."""
    try:
        answer = splu(matrix.tocsc()).solve(rhs)
    except RuntimeError:  # exactly singular
        return None
    return answer if np.all(np.isfinite(answer)) else None
