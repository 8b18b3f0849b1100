"""Equilibria along a load, past limit points, with the loads at which they become unstable."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy.optimize import root_scalar
from scipy.sparse import bmat, csr_matrix
from scipy.sparse.linalg import splu

from dalembert.argument_readers import names_of
from dalembert.arguments import takes_checked
from dalembert.errors import InputError, SolveError, shown
from dalembert.multibody.components.planar.markers import GROUND
from dalembert.multibody.model.evaluate import residual, tangent
from dalembert.multibody.model.lowered import Lowered, scales
from dalembert.multibody.model.lowering import lower
from dalembert.multibody.model.observe import observer
from dalembert.multibody.start.equilibrium_start import resting_place
from dalembert.multibody.start.mixed_points import MixedPoints
from dalembert.multibody.start.path_result import (
    AWAY,
    BRANCH,
    END,
    LIMIT,
    LOST,
    POINTS,
    SYMMETRIC_PART,
    Build,
    CriticalPoint,
    EquilibriumPath,
    observed,
)
from dalembert.multibody.start.static_stability import Stability, stability
from dalembert.multibody.start.statics import placed_at_start

_DIFFERENCE = 1e-6
"""Step of the load, as part of its range, for the derivative of the forces: it directs the search alone."""
_MOST_ITERATIONS = 12
_FEW_ITERATIONS = 4
"""Iterations after which a step keeps its length; with fewer it grows, with more it shrinks."""
_SHORTEST = 1e-6
"""Part of the first step: the path ends where it needs a shorter one."""
_FAR = 2.0
"""Of the range: a path whose load goes back by more ends."""
_LONGEST = 2.0
"""The longest step, in first steps."""
_BALANCED = 1e-11
"""Forces that are left, as part of those of the range of the load, at which they are rounding."""
_CLOSED = 1e-10
"""Newton's correction, over the scales, at which an equilibrium counts as reached."""
_LEAST_COSINE = 0.9
"""Of the angle between the directions of two points that follow each other: a larger turn asks for a shorter step."""
_FARTHEST = 0.1
"""Distance of a point from its prediction, in steps: farther off lies another path."""
_ASYMMETRY = 1e-8
"""Of a stiffness, relative, beyond rounding: loads that follow the motion."""


OnPoint = Callable[[float, bool], None]


@takes_checked("build")
def equilibrium_path(
    build: Build,
    start: float,
    end: float,
    steps: int = 20,
    most_points: int = 500,
    *,
    channels: Sequence[str] = (),
    parameter: str = "load",
    unit: str = "",
    on_point: OnPoint | None = None,
) -> EquilibriumPath:
    """Follow the equilibria of a mechanism from one load to another, past limit points.

    The path is followed by its arc length, so that the load may fall along it, as that of an arch that snaps through.
    Between two points of which one has more motions with a negative stiffness, the load is found at which the stiffness
    vanishes.

    Parameters
    ----------
    build : callable
        From the load, or any other number, to a system. Only numbers of components may depend on it. It is called with
        loads outside the range too, as where a step ends beyond it.
    start, end : float
        The path begins at the equilibrium nearest to the placement of ``build(start)``, and ends where the load
        reaches ``end``.
    steps : int
        Number of steps in the range of the load, for the length of the first one; later ones adapt.
    most_points : int
        Where the path ends at the latest, as where the load never reaches ``end``; at least 2.
    channels : sequence of str
        Channels that the result keeps; its figures show them over the load.
    parameter, unit : str
        Name and unit of the load, for tables and figures.
    on_point : callable, optional
        Is called with the load of each point, and whether it is stable.

    Returns
    -------
    EquilibriumPath

    Raises
    ------
    InputError
        For a range without a length, for unknown channels, and for reduced bodies: their bending stiffness does not
        follow axial forces.
    SolveError
        Where no equilibrium is found at the start, or at the end of the shortest step.

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
    if not callable(build):
        raise InputError(f"equilibrium_path: build is {shown(build)}; expected a function from the load to a system")
    if not (np.isfinite(start) and np.isfinite(end)) or start == end:
        raise InputError(f"equilibrium_path: start and end are {shown(start)} and {shown(end)}; expected two loads")
    if steps < 1 or most_points < 2:
        raise InputError(
            f"equilibrium_path: steps is {steps} and most_points {most_points}; expected 1 or more steps, and 2 or "
            "more points"
        )
    names = names_of(channels, "equilibrium_path", "channels")
    follower = _Follower(build, start, end, steps)
    units = tuple(channel.unit for channel in observer(build(follower.start), follower.placed, names).channels)
    points, critical, ended = [follower.first()], [], POINTS
    while True:
        if on_point:
            on_point(points[-1].load, points[-1].stability.negatives == 0)
        if len(points) >= most_points or ended != POINTS:
            break
        try:
            point, ended = follower.following(points[-1])
        except SolveError:
            if len(points) == 1:
                raise
            ended = LOST
            break
        critical += [replace(found, after=len(points) - 1) for found in follower.between(points[-1], point)]
        points.append(point)
    loads, x = np.array([point.load for point in points]), np.array([point.x for point in points])
    critical_x = np.array([point.x for point in critical]).reshape(-1, x.shape[1])
    values = observed(build, names, loads, x)
    nearest = values[[point.after for point in critical]]
    return EquilibriumPath(
        loads,
        np.array([point.stability.negatives == 0 for point in points]),
        tuple(critical),
        x,
        ended,
        float(end),
        parameter,
        unit,
        tuple(names),
        units,
        values,
        observed(build, names, np.array([point.load for point in critical]), critical_x, nearest),
        build,
    )


class _Point(NamedTuple):
    """An equilibrium: its load, unknowns (N + 1,), the unit direction of the path there (n + 1,) by scaled coordinates
    and load, the rates of all unknowns along it (N,), and its stability.
    """

    load: float
    x: np.ndarray
    direction: np.ndarray
    rates: np.ndarray
    stability: Stability


def _sizes(lowered: Lowered) -> np.ndarray:
    """Size of each coordinate, (n,): the extent of the mechanism with its points of the ground for positions."""
    structure, axes = lowered.structure, "xyz"[: lowered.dimension]
    kinds = np.array(structure.kinds)
    points = [np.real(lowered.x)[: structure.n][kinds == "position"].reshape(-1, lowered.dimension)]
    for kind, data in lowered.data.items():
        for side in "ab":
            names = tuple(f"{side}_{axis}" for axis in axes)
            if set(names) <= set(kind.numbers) and f"{side}_kind" in kind.integers:
                grounded = structure.meta[kind][:, kind.integers.index(f"{side}_kind")] == GROUND
                points.append(np.real(data[grounded][:, kind.columns(names)]))
    extent = float(np.ptp(np.concatenate(points), axis=0).max(initial=0.0))
    scale = scales(lowered)[: structure.n]
    if extent > 0.0:
        scale[np.isin(kinds, ("position", "displacement"))] = extent
    return scale


class _LostError(Exception):
    """No equilibrium was found where one was searched for."""


class _Follower:
    """The path of one mechanism. Lengths are those of (coordinates over their scales, load over its range)."""

    def __init__(self, build: Build, start: float, end: float, steps: int) -> None:
        self.build, self.start, self.end = build, float(start), float(end)
        self.range, self.length = end - start, 1.0 / steps
        self.step, self.softest = self.length, 0.0
        self.placed = placed_at_start(build(self.start))
        if linear := next((body.name for body in self.placed.bodies.values() if not body.buckles), None):
            raise InputError(
                f"equilibrium_path: body {linear!r} is a reduced body, whose bending stiffness does not follow axial "
                "forces, so that it buckles at wrong loads. Use a Beam"
            )
        self.n = self.placed.structure.n
        self.scale = _sizes(self.placed) * np.sqrt(self.n)  # the root mean square of the coordinates

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

    def following(self, point: _Point) -> tuple[_Point, str]:
        """The next point of the path, and whether it ends there: "end", "away", or "points" where it does not."""
        while (moved := self._corrected(point, self.step)) is None:
            self.step /= 2
            if self.step < _SHORTEST * self.length:
                raise SolveError(
                    f"the path of equilibria ends at the load {point.load:.6g}: no equilibrium was found beyond. "
                    "Another path may cross it there; begin at another load, or add an imperfection"
                )
        following, iterations = moved
        grown = float(np.clip((_FEW_ITERATIONS / iterations) ** 0.5, 0.5, 1.5))
        self.step = min(self.step * grown, _LONGEST * self.length)
        if (following.load - self.end) * self.range >= 0.0:
            return self._at_load(point, following) or following, END
        return following, AWAY if (following.load - self.start) / self.range < -_FAR else POINTS

    def between(self, first: _Point, second: _Point) -> list[CriticalPoint]:
        """Points between two others at which a stiffness vanishes, in the order of the path."""
        fewest, most = sorted((first.stability.negatives, second.stability.negatives))
        turns = first.direction[-1] * second.direction[-1] < 0.0
        # The softest motion loses its stiffness first, and has it again last.
        numbers = range(fewest, most)[:: 1 if first.stability.negatives == fewest else -1]
        return [self._zero(first, second, number, turns and most == fewest + 1) for number in numbers]

    def _zero(self, first: _Point, second: _Point, number: int, turns: bool) -> CriticalPoint:
        """The point at which an eigenvalue is zero, by steps along the direction of the first point."""
        gap = np.append((second.x[: self.n] - first.x[: self.n]) / self.scale, (second.load - first.load) / self.range)
        way = float(first.direction @ gap)
        known = {0.0: first, way: second}

        def stiffness(step: float) -> float:
            if step not in known:
                # At a branch point the direction is arbitrary.
                moved = self._corrected(first, step, least=-1.0)
                if moved is None:
                    raise _LostError
                known[step] = moved[0]
            return float(known[step].stability.squares[number])

        width = 0.0
        if stiffness(0.0) * stiffness(way) < 0.0:  # else one of the two points is the critical one, to rounding
            try:
                root_scalar(stiffness, bracket=(0.0, way), xtol=1e-9 * way)
            except _LostError:
                width = abs(second.load - first.load)
        best = min(known.values(), key=lambda point: abs(point.stability.squares[number]))
        return self._critical(best, number, turns, width)

    def _bordered(self, matrix: csr_matrix, by_load: np.ndarray, direction: np.ndarray) -> csr_matrix:
        """Newton's matrix with the derivative by the load, and the plane across the direction, (N + 1, N + 1)."""
        row = np.zeros((1, len(by_load)))
        row[0, : self.n] = direction[:-1] / self.scale
        corner = np.array([[direction[-1] / self.range]])
        return csr_matrix(bmat([[matrix, by_load[:, None]], [row, corner]]))

    def _by_load(self, lowered: Lowered, load: float, x: np.ndarray) -> np.ndarray:
        """Derivative of the forces by the load, (N,)."""
        h = _DIFFERENCE * self.range
        return (self.forces(lowered, x) - self.forces(self.lowered(load - h), x)) / h

    def _corrected(self, point: _Point, step: float, least: float = _LEAST_COSINE) -> tuple[_Point, int] | None:
        """The point of the path in the plane across the direction, a step ahead, and Newton's iterations.

        None where there is none near, or where the path turns by a smaller cosine than ``least``.
        """
        x, load = point.x.copy(), point.load + step * point.direction[-1] * self.range
        x[:-1] += step * point.rates
        aim, ahead = load, x.copy()
        lowered = self.lowered(load)
        mixed = MixedPoints(lowered)
        for iteration in range(1, _MOST_ITERATIONS + 1):
            by_load, left = self._by_load(lowered, load, x), self.forces(lowered, x)
            size = 0.0
            # Near a branch point a step would only magnify the rounding of forces that are in balance.
            if np.abs(left).max() > _BALANCED * np.abs(by_load * self.range).max():
                matrix = tangent(mixed.lowered, x, np.zeros_like(x), (1.0, 0.0, 0.0))
                change = _solved(self._bordered(matrix, by_load, point.direction), np.append(-left, 0.0))
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
                gap = (x[: self.n] - ahead[: self.n]) / self.scale
                if np.sqrt(gap @ gap + ((load - aim) / self.range) ** 2) > _FARTHEST * step:
                    return None
                moved = self._at(lowered, load, x, point.direction)
                return (moved, iteration) if moved.direction @ point.direction >= least else None
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
        if way is None:  # at a branch point: as before, without a change of multipliers
            way = np.append(0.0 * by_load, before[-1] * self.range)
            way[: self.n] = before[:-1] * self.scale
        direction = np.append(way[: self.n] / self.scale, way[-1] / self.range)
        length = np.linalg.norm(direction)
        stable = stability(lowered, x, self.scale, self.softest)
        if not self.softest:
            self.softest = 1.0 / float(np.abs(stable.squares).min(initial=np.inf))
        return _Point(load, x, direction / length, way[:-1] / length, stable)

    def _critical(self, point: _Point, number: int, turns: bool, gap: float) -> CriticalPoint:
        shape = np.zeros_like(point.x)
        shape[: self.n] = point.stability.motions[:, number]
        shape /= shape[np.argmax(np.abs(shape))]
        kind = LIMIT if turns else BRANCH
        if point.stability.asymmetry > _ASYMMETRY:
            kind = SYMMETRIC_PART
        return CriticalPoint(point.load, kind, point.x, shape, gap)


def _solved(matrix: csr_matrix, rhs: np.ndarray) -> np.ndarray | None:
    """The solution of a sparse system; None where it is singular."""
    try:
        answer = splu(matrix.tocsc()).solve(rhs)
    except RuntimeError:  # exactly singular
        return None
    return answer if np.all(np.isfinite(answer)) else None
