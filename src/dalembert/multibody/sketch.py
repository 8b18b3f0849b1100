"""A mechanism in one pose: its drawing, and the points that its joints and loads hold on to."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from dalembert.kernels.preparation import prepare
from dalembert.multibody.assemble import assembled
from dalembert.multibody.components.points import Ground, Point
from dalembert.multibody.drawing import Drawing, draw
from dalembert.multibody.lowered import Lowered
from dalembert.multibody.lowering import lower
from dalembert.multibody.observe import observer
from dalembert.multibody.system import Mechanism

SIDES = ("a", "b", "at")
"""Fields of joints and loads that hold on to a point."""


@dataclass(frozen=True, eq=False)
class Sketch:
    """One pose of a mechanism.

    Parameters
    ----------
    system : Mechanism
    drawing : Drawing
        One frame.
    ends : mapping of str to array, shape (1 or 2, 2 or 3)
        Positions in m of the points that a joint or a load acts on, by its name.
    marks : mapping of str to array, shape (2 or 3,)
        Positions in m of further points of bodies, by ``"body.point"``.
    """

    system: Mechanism
    drawing: Drawing
    ends: dict[str, np.ndarray]
    marks: dict[str, np.ndarray] = field(default_factory=dict)

    @property
    def positions(self) -> np.ndarray:
        """All points that are drawn, (points, 2 or 3)."""
        across = len(self.system.AXES)
        own = self.drawing
        known = [*own.lines.values(), *own.joints.values(), *self.ends.values(), *self.marks.values()]
        known += map(own.corners, own.surfaces)
        return np.concatenate([np.reshape(array, (-1, across)) for array in known])


def sketch(system: Mechanism, points: int = 8, *, marks: Sequence[str] = (), assemble: bool = True) -> Sketch:
    """Return the mechanism as it begins: assembled, or as its bodies are placed.

    Parameters
    ----------
    system : Mechanism
    points : int
        Drawn points of a beam element.
    marks : sequence of str
        Points of bodies to locate, ``"body.point"``.
    assemble : bool
        Whether to close the joints.

    Raises
    ------
    ModelError
        Where the mechanism cannot be assembled.
    """
    placed = lower(system)
    prepare(placed.kernels(False))
    lowered = assembled(system, placed=placed) if assemble else placed
    x = np.real(lowered.x)[None]
    located = dict(zip(marks, _positions(system, lowered, x, list(marks)), strict=True))
    return Sketch(system, draw(system, lowered, np.zeros(1), x, points), _ends(system, lowered, x), located)


def is_grounded(component: Any) -> bool:
    """Return True if a joint or a load holds on to the ground."""
    sides = [getattr(component, side, None) for side in SIDES]
    return any(isinstance(side, Ground) or _fixed(side) is not None for side in sides)


def _ends(system: Mechanism, lowered: Lowered, x: np.ndarray) -> dict[str, np.ndarray]:
    """Positions of the points that joints and loads act on."""
    parts = {part.name: _sides(part) for part in (*system.joints, *system.loads)}
    held = list(dict.fromkeys(str(side) for sides in parts.values() for side in sides if isinstance(side, Point)))
    known = dict(zip(held, _positions(system, lowered, x, held), strict=True))
    found = {}
    for name, sides in parts.items():
        own = [known[str(side)] if isinstance(side, Point) else _fixed(side) for side in sides]
        own = [position for position in own if position is not None]
        if own:
            found[name] = np.array(own)
    return found


def _sides(component: Any) -> list[Any]:
    return [side for name in SIDES if (side := getattr(component, name, None)) is not None]


def _fixed(side: Any) -> np.ndarray | None:
    """Position of a point of the ground."""
    if isinstance(side, Point) or not (hasattr(side, "x") or hasattr(side, "position")):
        return None
    return np.real(np.array(side.position if hasattr(side, "position") else (side.x, side.y))).astype(float)


def _positions(system: Mechanism, lowered: Lowered, x: np.ndarray, points: list[str]) -> np.ndarray:
    """Positions of points of bodies, (points, 2 or 3)."""
    axes = system.AXES
    if not points:
        return np.zeros((0, len(axes)))
    read = observer(system, lowered, [f"{point}.{axis}" for point in points for axis in axes])
    prepare(read.kernels(lowered, False))
    still = np.zeros_like(x)
    return read.read(lowered, lowered.real, (x, still, still), np.zeros(1)).reshape(len(points), len(axes))
