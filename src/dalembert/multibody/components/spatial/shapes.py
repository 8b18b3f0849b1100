"""What bodies in space look like: boxes, cylinders and spheres, and the inertia of these when they are solid."""

__all__ = ["Shape", "Surface"]

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from dalembert.arguments import Checked
from dalembert.errors import InputError, require_known, shown
from dalembert.multibody.components.fields import Number, number
from dalembert.multibody.components.spatial.inertia import Inertia
from dalembert.multibody.components.spatial.mesh_files import triangles_of
from dalembert.multibody.components.spatial.modal_strains import ModalStrains
from dalembert.multibody.components.spatial.orientation import Pose, Vector

BOX, CYLINDER, SPHERE, MESH = KINDS = "box", "cylinder", "sphere", "mesh"
SIZES = {BOX: "three sides", CYLINDER: "a radius and a length", SPHERE: "a radius", MESH: "three factors"}
COUNTS = {BOX: 3, CYLINDER: 2, SPHERE: 1, MESH: 3}
AT_ORIGIN = Pose()
AROUND = 16
"""Corners of a circle."""


class Surface(NamedTuple):
    """Corners (corners, 3) in the axes of a body, m, and triangles (triangles, 3) between them, by their numbers.

    Corners of a body that deforms are (frames, corners, 3), in the fixed axes; ``strains`` (frames, corners) of it are
    the magnitudes of its strain, and ``measure`` is what this strain is, in words.
    """

    corners: np.ndarray
    triangles: np.ndarray
    strains: np.ndarray | ModalStrains | None = None
    measure: str = ""


@dataclass(frozen=True)
class Shape(Checked):
    """What a body looks like: a box, a cylinder along z, a sphere or a mesh. It does not change the motion.

    Parameters
    ----------
    kind : {"box", "cylinder", "sphere", "mesh"}
    sizes : tuple of float
        Sides; radius and length; radius; factors of the mesh along its axes. m.
    pose : Pose
        Of the centre of the shape, in the axes of the body.
    file : str
        Name of the file of a mesh.
    found : str
        Path of that file; empty where it is not there or is not read, so that the mesh is not drawn.

    Examples
    --------
    >>> rod = Shape.cylinder(radius=0.01, length=0.5, pose=Pose((0.0, 0.0, 0.25)))
    >>> rod.inertia(density=7850.0).centre
    (0.0, 0.0, 0.25)
    """

    kind: str
    sizes: tuple[Number, ...] = number("m")
    pose: Pose = AT_ORIGIN
    file: str = ""
    found: str = ""

    IN_WORDS = "a shape such as Shape.box((0.1, 0.2, 0.3))"

    def __post_init__(self) -> None:
        require_known("kind", self.kind, KINDS, "Shape")
        positive = self.kind == MESH or all(np.real(size) > 0 for size in self.sizes)
        if len(self.sizes) != COUNTS[self.kind] or not positive:
            raise InputError(
                f"Shape: the sizes of a {self.kind} are {shown(self.sizes)}; expected {SIZES[self.kind]}"
                + (", positive, in m" if self.kind != MESH else "")
            )

    @classmethod
    def box(cls, sides: Vector, pose: Pose = AT_ORIGIN) -> "Shape":
        """A box with sides along its axes, m."""
        return cls(BOX, tuple(sides), pose)

    @classmethod
    def cylinder(cls, radius: Number, length: Number, pose: Pose = AT_ORIGIN) -> "Shape":
        """A cylinder along its axis z, m."""
        return cls(CYLINDER, (radius, length), pose)

    @classmethod
    def sphere(cls, radius: Number, pose: Pose = AT_ORIGIN) -> "Shape":
        """A sphere, m."""
        return cls(SPHERE, (radius,), pose)

    @property
    def volume(self) -> Number:
        """Volume, m^3.

        Raises
        ------
        InputError
            For a mesh.
        """
        if self.kind == BOX:
            return np.prod(self.sizes).item()
        if self.kind == CYLINDER:
            return np.pi * self.sizes[0] ** 2 * self.sizes[1]
        if self.kind == SPHERE:
            return 4.0 / 3.0 * np.pi * self.sizes[0] ** 3
        raise InputError("Shape: the volume of a mesh is not known. Give the body an Inertia")

    def inertia(self, density: Number) -> Inertia:
        """Inertia of the solid shape in the axes of the body, from its density in kg/m^3."""
        mass = density * self.volume
        if self.kind == BOX:
            own = Inertia.box(mass, self.sizes)
        elif self.kind == CYLINDER:
            own = Inertia.cylinder(mass, *self.sizes)
        else:
            own = Inertia.sphere(mass, *self.sizes)
        axes = self.pose.orientation.matrix
        return Inertia.of(mass, axes @ own.tensor @ axes.T, self.pose.position)

    @property
    def surface(self) -> Surface | None:
        """The surface as triangles in the axes of the body; None for a mesh whose file is not read."""
        if self.kind == MESH:
            mesh = triangles_of(self.found) if self.found else None
            if mesh is None:
                return None
            corners, triangles = mesh[0] * np.real(self.sizes), mesh[1]
        else:
            solid = {BOX: _box, CYLINDER: _cylinder, SPHERE: _sphere}[self.kind](*np.real(self.sizes))
            corners, triangles = solid.corners, solid.triangles
        axes = np.real(self.pose.orientation.matrix)
        return Surface(corners @ axes.T + np.real(self.pose.position), triangles)


def capsule(radius: Number, length: Number, pose: Pose = AT_ORIGIN) -> tuple[Shape, ...]:
    """Return the solids of a capsule along its axis z: a cylinder of this length between two spheres, m."""
    centre, axis = np.array(pose.position), pose.orientation.matrix[:, 2]
    ends = [tuple((centre + height * axis).tolist()) for height in (-0.5 * length, 0.5 * length)]
    return Shape.cylinder(radius, length, pose), *(Shape.sphere(radius, Pose(end, pose.orientation)) for end in ends)


def surface_of(shapes: Sequence[Shape]) -> Surface | None:
    """One surface of several shapes; None where there is nothing to draw."""
    parts = [shape.surface for shape in shapes]
    known = [part for part in parts if part is not None]
    if not known:
        return None
    first = np.cumsum([0, *(len(part.corners) for part in known)])
    return Surface(
        np.concatenate([part.corners for part in known]),
        np.concatenate([part.triangles + number for part, number in zip(known, first, strict=False)]),
    )


def _box(x: float, y: float, z: float) -> Surface:
    signs = np.array([[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)])
    sides = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
    return Surface(0.5 * signs * (x, y, z), np.concatenate([sides[:, [0, 1, 2]], sides[:, [0, 2, 3]]]))


def _cylinder(radius: float, length: float) -> Surface:
    angles = 2 * np.pi * np.arange(AROUND) / AROUND
    circle = radius * np.column_stack([np.cos(angles), np.sin(angles)])
    ends = [np.column_stack([circle, np.full(AROUND, end)]) for end in (-length / 2, length / 2)]
    fan = np.array([[0, k + 1, k] for k in range(1, AROUND - 1)])  # the lower end, seen from below
    return Surface(np.concatenate(ends), np.concatenate([fan, fan[:, ::-1] + AROUND, _ring(0)]))


def _sphere(radius: float) -> Surface:
    heights = np.pi * np.arange(1, AROUND // 2) / (AROUND // 2)
    angles = 2 * np.pi * np.arange(AROUND) / AROUND
    rings = [
        np.column_stack([np.sin(h) * np.cos(angles), np.sin(h) * np.sin(angles), np.full(AROUND, -np.cos(h))])
        for h in heights
    ]
    corners = radius * np.concatenate([*rings, [[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]]])
    last, low, high = AROUND * (len(rings) - 1), len(corners) - 2, len(corners) - 1
    following = (np.arange(AROUND) + 1) % AROUND
    ends = [[low, following[k], k] for k in range(AROUND)] + [
        [high, last + k, last + following[k]] for k in range(AROUND)
    ]
    return Surface(corners, np.concatenate([np.array(ends), *(_ring(AROUND * k) for k in range(len(rings) - 1))]))


def _ring(first: int) -> np.ndarray:
    """Triangles between a circle of corners and the next one."""
    here = np.arange(AROUND)
    after = (here + 1) % AROUND
    low = np.column_stack([here, after, AROUND + after])
    return first + np.concatenate([low, np.column_stack([here, AROUND + after, AROUND + here])])
