"""A scene: primitives of the parts of a model, their names, and the direction of gravity."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

INK = -1
"""Colour of joints, ground and measured points; other colours are numbers of a palette's series."""


@dataclass(frozen=True, eq=False)
class Primitive:
    """A line, a surface or a symbol that shows a part of a model. ``kind``: ``line`` (with gaps where points are NaN),
    ``surface`` and ``mesh`` (faces; those of finite elements show their sides), ``edges`` (pairs of points),
    ``dashes``, ``points``, ``crosses``, ``joint``, ``ground``, ``spring``, ``arrow``, ``turn``, ``ring``, ``dot``,
    ``point``; of a row of masses also ``mass`` and ``element``. ``role``: of the part ``name``: ``body``, ``joint``,
    ``load``, ``channel``, ``point``, ``measured``, ``path``, ``outline`` (of poses), ``axis`` (of bodies), ``spring``,
    ``contact``, ``force`` or ``ground``.

    ``points`` (frames, points, 2 or 3): m, one frame if it does not move, or has poses; ``colour``: number in the
    series of a palette, or ``INK``; ``faces`` (faces, 3 or 4): corners of the faces among the points; ``along``
    (2 or 3,): direction of an arrow; ``poses`` (frames, 4, 3): origin, m, and axes of a rigid body over time. The
    points, of one frame, are then in these axes. ``values`` (frames or 1, points): what colours faces and
    ``points`` by the scene's colour bar, in its unit.
    """

    kind: str
    role: str
    name: str
    points: np.ndarray
    colour: int = INK
    faces: np.ndarray | None = None
    along: np.ndarray | None = None
    poses: np.ndarray | None = None
    values: np.ndarray | None = None

    @property
    def positions(self) -> np.ndarray:
        """Points in the fixed axes, (frames or 1, points, 2 or 3), m."""
        return self.points if self.poses is None else self.poses[:, :1] + self.points @ self.poses[:, 1:]

    @property
    def part(self) -> str:
        """Role and name."""
        return f"{self.role} {self.name}".strip()


@dataclass(frozen=True, eq=False)
class Label:
    """Text at a part: its name, or its channels. Primitive of ``at``: (2 or 3,), m."""

    role: str
    name: str
    at: np.ndarray
    text: str
    colour: int = INK

    @property
    def part(self) -> str:
        """Role and name."""
        return f"{self.role} {self.name}"


@dataclass(frozen=True)
class ColourBar:
    """Colours of values from zero to ``highest``; ``title``: their quantity and unit."""

    title: str
    highest: float


@dataclass(frozen=True)
class Film:
    """Frames that are not times of a motion. ``labels``: text of each frame; ``seconds``: duration of one pass
    through all frames, s; ``name``, ``unit``: of the quantity that the labels give, such as phase and °; ``pace``: the
    speed in words, such as "10 times slower"; ``endless``: whether the first frame follows the last, as in a period.
    """

    labels: Sequence[str]
    seconds: float
    name: str
    unit: str
    pace: str = ""
    endless: bool = False


MOST_LABELS = 24
FIRST_ROLES = ("channel", "force", "joint", "load", "body")
"""Roles whose labels are shown first where there are too many."""


@dataclass(frozen=True, eq=False)
class Scene:
    """The picture of a model, at rest or over time. ``primitives``: those of one part follow each other; ``gravity``
    (2 or 3,): its direction, of length 1; ``times`` (frames,): s, or numbers of the frames of a ``film``; ``to_scale``:
    False for a row of masses whose positions are not known: x has their numbers; ``bar``: of the values of primitives.
    """

    primitives: tuple[Primitive, ...]
    labels: tuple[Label, ...] = ()
    gravity: np.ndarray | None = None
    times: np.ndarray = field(default_factory=lambda: np.zeros(1))
    to_scale: bool = True
    film: Film | None = None
    bar: ColourBar | None = None

    @property
    def dimensions(self) -> int:
        """2 in the plane, 3 in space."""
        return self.primitives[0].points.shape[2]

    @property
    def positions(self) -> np.ndarray:
        """All known points of all frames, (points, 2 or 3), m."""
        points = np.concatenate([shape.positions.reshape(-1, self.dimensions) for shape in self.primitives])
        return points[np.isfinite(points).all(axis=1)]

    @property
    def start(self) -> "Scene":
        """The scene as it is in its first frame."""
        still = (
            replace(
                shape, points=shape.positions[:1], poses=None, values=None if shape.values is None else shape.values[:1]
            )
            for shape in self.primitives
        )
        return replace(self, primitives=tuple(still), times=self.times[:1])

    @property
    def parts(self) -> set[str]:
        """Roles and names of the parts that are drawn."""
        return {shape.part for shape in self.primitives} | ({"gravity gravity"} if self.gravity is not None else set())

    def with_measured(self, measured: Mapping[str, np.ndarray]) -> "Scene":
        """Return the scene with crosses at measured positions (samples, 2 or 3) of points by name, behind all else."""
        crosses = (Primitive("crosses", "measured", name, positions[None]) for name, positions in measured.items())
        return replace(self, primitives=(*crosses, *self.primitives))


def unit_vector(vector: np.ndarray) -> np.ndarray | None:
    """Return a vector scaled to length 1; None for zero."""
    length = float(np.linalg.norm(vector))
    return vector / length if length > 0 else None


def readable(labels: list[Label]) -> tuple[Label, ...]:
    """Return at most ``MOST_LABELS`` labels in their order: all of a role or none, the first roles first."""
    roles = [label.role for label in labels]
    shown: list[str] = []
    for role in dict.fromkeys([*(role for role in FIRST_ROLES if role in roles), *roles]):
        if len(shown) + roles.count(role) <= MOST_LABELS:
            shown += [role] * roles.count(role)
    return tuple(label for label in labels if label.role in shown)
