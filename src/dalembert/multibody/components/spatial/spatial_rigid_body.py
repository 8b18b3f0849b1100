"""The rigid body in space."""

__all__ = ["RigidBody"]

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from dalembert.errors import InputError, require_known
from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.base_body import POSITION, with_points
from dalembert.multibody.components.fields import number
from dalembert.multibody.components.spatial import spatial_markers as markers
from dalembert.multibody.components.spatial.directors import DIRECTORS, POSE
from dalembert.multibody.components.spatial.ground_points import Place
from dalembert.multibody.components.spatial.inertia import Inertia
from dalembert.multibody.components.spatial.orientation import Orientation, Pose, Vector
from dalembert.multibody.components.spatial.shapes import Shape, Surface, surface_of
from dalembert.multibody.components.spatial.spatial_body import DIRECTOR, Body, Marker, pose_modes
from dalembert.multibody.components.spatial.spatial_rows import SpatialRows
from dalembert.multibody.components.spatial.vectors import add_at, at, dot, minus, plus, times
from dalembert.multibody.kernels.kind import Kind


@inlined
def _momenta(a, p):
    """Rows of the mass matrix P (x) 1 times accelerations, or times velocities."""
    r, d1, d2, d3 = at(a, 0), at(a, 3), at(a, 6), at(a, 9)
    return (
        plus(plus(times(p.mass, r), times(p.first_1, d1)), plus(times(p.first_2, d2), times(p.first_3, d3))),
        plus(plus(times(p.first_1, r), times(p.second_11, d1)), plus(times(p.second_12, d2), times(p.second_13, d3))),
        plus(plus(times(p.first_2, r), times(p.second_12, d1)), plus(times(p.second_22, d2), times(p.second_23, d3))),
        plus(plus(times(p.first_3, r), times(p.second_13, d1)), plus(times(p.second_23, d2), times(p.second_33, d3))),
    )


@inlined
def _residual(x, v, a, p, m, inputs, r):
    """P_ij a_j - P_0i g: inertia, and gravity on the origin and the directors."""
    g = (p.gravity_x, p.gravity_y, p.gravity_z)
    origin, first, second, third = _momenta(a, p)
    add_at(r, 0, minus(origin, times(p.mass, g)))
    add_at(r, 3, minus(first, times(p.first_1, g)))
    add_at(r, 6, minus(second, times(p.first_2, g)))
    add_at(r, 9, minus(third, times(p.first_3, g)))


@inlined
def _energy(x, v, p, m, inputs):
    """T = tr(Q' P Q'^T) / 2, V = -g . (m r + m c_i d_i)."""
    g = (p.gravity_x, p.gravity_y, p.gravity_z)
    origin, first, second, third = _momenta(v, p)
    kinetic = dot(origin, at(v, 0)) + dot(first, at(v, 3)) + dot(second, at(v, 6)) + dot(third, at(v, 9))
    height = p.mass * dot(g, at(x, 0)) + p.first_1 * dot(g, at(x, 3)) + p.first_2 * dot(g, at(x, 6))
    return 0.5 * kinetic, -(height + p.first_3 * dot(g, at(x, 9))), 0.0 * kinetic


RIGID = Kind(
    "rigid_body_in_space",
    coordinates=markers.SLOTS,
    numbers=(
        "mass", "first_1", "first_2", "first_3", "second_11", "second_12", "second_13", "second_22", "second_23",
        "second_33", "gravity_x", "gravity_y", "gravity_z",
    ),
    residual=_residual,
    dissipates=(),
    energy=_energy,
    gravity=("gravity_x", "gravity_y", "gravity_z"),
    charts=POSE,
)  # fmt: skip


@with_points("origin", "centre")
@dataclass(frozen=True)
class RigidBody(Body):
    """A rigid body in space, with named markers.

    Parameters
    ----------
    name : str
    inertia : Inertia
        Mass, centre of mass and inertia tensor, in the axes of the body.
    position : (float, float, float) or Point
        Initial position of the anchor, m.
    orientation : Orientation
        Initial orientation; relative to the marker where the body is placed at a marker of another body.
    anchor : str
        The point that is placed: ``"origin"`` (of the body's axes), ``"centre"`` (of mass) or one of ``points``.
    points : mapping of str to (float, float, float) or Pose
        Markers in the axes of the body, m.
    velocity : (float, float, float), optional
        Initial velocity of the anchor, m/s. If not given, that of the point that the body is placed at, or zero; the
        joints may change it then.
    angular_velocity : (float, float, float), optional
        Initial angular velocity in the fixed axes, rad/s. If not given, zero; the joints may change it then.
    shapes : sequence of Shape
        What the body looks like, for reports and exported files.

    Examples
    --------
    >>> box = Inertia.box(mass=2.0, sides=(0.1, 0.2, 0.3))
    >>> brick = RigidBody("brick", box, points={"corner": (0.05, 0.1, 0.15)}, anchor="corner")
    >>> brick.point_names
    ('origin', 'centre', 'corner')
    """

    inertia: Inertia
    position: Place = field(default=(0.0, 0.0, 0.0), metadata={"unit": "m", "shape": (3,)})
    orientation: Orientation = Orientation()
    anchor: str = "origin"
    points: Mapping[str, Vector | Pose] = field(default_factory=dict, metadata={"unit": "m"})
    velocity: Vector | None = number("m/s", None)
    angular_velocity: Vector | None = number("rad/s", None)
    shapes: Sequence[Shape] = field(default=(), metadata={"key": False})

    def __post_init__(self) -> None:
        for taken in ("origin", "centre"):
            if taken in self.points:
                raise InputError(f"rigid body {self.name!r}: the point name {taken!r} is reserved. Choose another name")
        require_known("anchor", self.anchor, self.point_names, f"rigid body {self.name!r}")

    @property
    def place(self) -> Place:
        return self.position

    @property
    def coordinate_kinds(self) -> tuple[str, ...]:
        return (POSITION,) * 3 + (DIRECTOR,) * 9

    @property
    def rigid(self) -> bool:
        return True

    @property
    def point_names(self) -> tuple[str, ...]:
        return ("origin", "centre", *self.points)

    def pose(self, point: str) -> Pose:
        """Position and orientation of a point in the axes of the body."""
        if point == "origin":
            return Pose()
        own = self.inertia.centre if point == "centre" else self.points[point]
        return own if isinstance(own, Pose) else Pose(own)

    def placed(self, frame: np.ndarray) -> np.ndarray:
        directors = frame[3:].reshape(3, 3)
        return np.concatenate([frame[:3] - np.array(self.pose(self.anchor).position) @ directors, frame[3:]])

    def rigid_modes(self, coordinates: np.ndarray, frame: np.ndarray) -> np.ndarray:
        return pose_modes(coordinates, frame)

    def marker(self, point: str) -> Marker:
        pose = self.pose(point)
        return Marker(markers.BODY, tuple(range(markers.SLOTS)), np.array(pose.position), pose.orientation.matrix)

    def lower(self, lowering: SpatialRows, first: int) -> None:
        index = list(range(first, first + markers.SLOTS))
        lowering.add(RIGID, index, [*self.inertia.pseudo[np.triu_indices(4)].tolist(), *lowering.gravity])
        lowering.add(DIRECTORS, index[3:] + lowering.multipliers(self.name, 6), [])

    def outline(self, coordinates: np.ndarray, points: int) -> np.ndarray:
        """Lines from the centre of mass to each marker and back, (frames, -, 3)."""
        own = coordinates.reshape(len(coordinates), 4, 3)
        centre, corners = np.array(self.inertia.centre), [self.pose(name).position for name in self.point_names]
        local = [point for corner in corners for point in (centre, np.array(corner))]
        weights = np.column_stack([np.ones(len(local)), np.real(local)])
        return np.einsum("pk,fkc->fpc", weights, own)

    def moving_axes(self, coordinates: np.ndarray) -> np.ndarray:
        return coordinates.reshape(len(coordinates), 4, 3)

    @property
    def surface(self) -> Surface | None:
        return surface_of(self.shapes)
