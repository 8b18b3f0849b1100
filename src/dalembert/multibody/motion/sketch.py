"""A mechanism in one pose: its drawing, and the points that its joints and loads hold on to."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from dalembert.kernels.preparation import prepare
from dalembert.multibody.components.base_joint import BaseJoint
from dalembert.multibody.components.points import Ground, Point
from dalembert.multibody.model.drawing import Drawing, draw
from dalembert.multibody.model.lowered import Lowered
from dalembert.multibody.model.lowering import lower
from dalembert.multibody.model.observe import observer
from dalembert.multibody.model.system import BaseSystem
from dalembert.multibody.start.assemble import assembled

SIDES = ("a", "b", "at", "on", "joint")
"""Fields of joints and loads that hold on to a point, or act on a joint."""
FORCES = ("force", "force_in_space")
"""Kinds of loads that push along a known direction."""


@dataclass(frozen=True, eq=False)
class Sketch:
    """One pose of a mechanism. ``drawing``: one frame; ``ends`` (1 or 2, 2 or 3): points that a joint or a load acts
    on, m, by its name; ``marks`` (2 or 3,): further points of bodies, m, by ``"body.point"``; ``forces`` (2 or 3,):
    along the fixed axes, N, by the names of their loads: amplitudes of those that change over time.
    """

    system: BaseSystem
    drawing: Drawing
    ends: dict[str, np.ndarray]
    marks: dict[str, np.ndarray] = field(default_factory=dict)
    forces: dict[str, np.ndarray] = field(default_factory=dict)

    @property
    def positions(self) -> np.ndarray:
        """All points that are drawn, (points, 2 or 3)."""
        across = len(self.system.AXES)
        own = self.drawing
        known = [*own.lines.values(), *own.joints.values(), *self.ends.values(), *self.marks.values()]
        known += map(own.corners, own.surfaces)
        known += [] if own.ground is None else [own.ground.corners]
        return np.concatenate([np.reshape(array, (-1, across)) for array in known])


def sketch(system: BaseSystem, points: int = 8, *, marks: Sequence[str] = (), assemble: bool = True) -> Sketch:
    """Return the mechanism at its start: assembled, or as its bodies are placed if not ``assemble``. ``points``: drawn
    points of a beam element; ``marks``: points of bodies to locate, ``"body.point"``.
    """
    placed = lower(system)
    prepare(placed.kernels())
    lowered = assembled(system, placed=placed) if assemble else placed
    x = np.real(lowered.x)[None]
    located = dict(zip(marks, _positions(system, lowered, x, list(marks)), strict=True))
    drawing = draw(system, lowered, np.zeros(1), x, points)
    forces = {}  # along the fixed axes
    for load in system.loads:
        if load.kind.name in FORCES:
            size = np.array([size_of(getattr(load, axis)) for axis in system.AXES])
            follows = getattr(load, "follower", False) and isinstance(load.at, Point)
            forces[load.name] = _axes(system, lowered, x, drawing, load.at) @ size if follows else size
    # Positions of the points that joints and loads act on; of a joint that they act on, the middle of its points.
    parts = {
        part.name: [side for name in SIDES if (side := getattr(part, name, None)) is not None]
        for part in (*system.joints, *system.loads)
    }
    held = list(dict.fromkeys(str(side) for sides in parts.values() for side in sides if isinstance(side, Point)))
    known = dict(zip(held, _positions(system, lowered, x, held), strict=True))
    found: dict[str, np.ndarray] = {}
    for name, sides in parts.items():
        own = [_end(side, known, found) for side in sides]
        own = [position for position in own if position is not None]
        if own:
            found[name] = np.array(own)
    return Sketch(system, drawing, found, located, forces)


def is_grounded(component: Any) -> bool:
    """Return True if a joint or a load holds on to the ground."""
    sides = [getattr(component, side, None) for side in SIDES]
    return any(isinstance(side, Ground) or _fixed(side) is not None for side in sides)


def size_of(course: Any) -> float:
    """Return a number, or what a function of time is multiplied with; 1 where that is not one number."""
    for name in ("value", "amplitude"):
        course = getattr(course, name, course)
    return float(np.real(course)) if np.isscalar(course) else 1.0


def _end(side: Any, points: Mapping[str, np.ndarray], joints: Mapping[str, np.ndarray]) -> np.ndarray | None:
    if isinstance(side, BaseJoint):
        return joints[side.name].mean(axis=0) if side.name in joints else None
    return points[str(side)] if isinstance(side, Point) else _fixed(side)


def _axes(system: BaseSystem, lowered: Lowered, x: np.ndarray, drawing: Drawing, point: Point) -> np.ndarray:
    """Axes of a point of a body in the fixed axes, as columns."""
    if point.body.name in drawing.axes:
        return drawing.axes[point.body.name][0, 1:].T @ np.real(point.body.marker(point.name).axes)
    angle = _read(system, lowered, x, [f"{point}.angle"])[0]
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def _fixed(side: Any) -> np.ndarray | None:
    """Position of a point of the ground."""
    if isinstance(side, Point | BaseJoint) or not (hasattr(side, "x") or hasattr(side, "position")):
        return None
    return np.real(np.array(side.position if hasattr(side, "position") else (side.x, side.y))).astype(float)


def _positions(system: BaseSystem, lowered: Lowered, x: np.ndarray, points: list[str]) -> np.ndarray:
    """Positions of points of bodies, (points, 2 or 3)."""
    axes = system.AXES
    return _read(system, lowered, x, [f"{point}.{axis}" for point in points for axis in axes]).reshape(-1, len(axes))


def _read(system: BaseSystem, lowered: Lowered, x: np.ndarray, channels: list[str]) -> np.ndarray:
    """Channels of the mechanism at rest, (channels,)."""
    if not channels:
        return np.zeros(0)
    read = observer(system, lowered, channels)
    prepare(read.kernels(lowered, False))
    still = np.zeros_like(x)
    return read.read(lowered, lowered.real, (x, still, still), np.zeros(1)).ravel()
