"""What rigid bodies in the plane share: inertia and weight, coordinates of the centre of mass."""

from abc import abstractmethod
from dataclasses import dataclass

import numpy as np

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.base_body import ANGLE, POSITION
from dalembert.multibody.components.fields import Number
from dalembert.multibody.components.planar import markers
from dalembert.multibody.components.planar.body import Body, Marker, turned
from dalembert.multibody.components.rows import Lowering
from dalembert.multibody.kernels.kind import Kind


@inlined
def _residual(x, v, a, p, m, inputs, r):
    """m a - m g and J alpha."""
    r[0] = p.mass * (a[0] - p.gravity_x)
    r[1] = p.mass * (a[1] - p.gravity_y)
    r[2] = p.inertia * a[2]


@inlined
def _energy(x, v, p, m, inputs):
    kinetic = 0.5 * (p.mass * (v[0] * v[0] + v[1] * v[1]) + p.inertia * v[2] * v[2])
    return kinetic, -p.mass * (p.gravity_x * x[0] + p.gravity_y * x[1]), 0.0 * p.mass


RIGID = Kind(
    "rigid_body",
    coordinates=3,
    numbers=("mass", "inertia", "gravity_x", "gravity_y"),
    residual=_residual,
    energy=_energy,
    gravity=("gravity_x", "gravity_y"),
)


@dataclass(frozen=True)
class PlanarRigid(Body):
    """What rigid bodies share: three coordinates (x, y, theta) of the centre of mass."""

    @property
    @abstractmethod
    def offset(self) -> tuple[Number, Number]:
        """The placed point against the centre of mass, in the body's axes."""

    @abstractmethod
    def local(self, point: str) -> tuple[Number, Number]:
        """Position of a point against the centre of mass, in the body's axes."""

    @property
    @abstractmethod
    def inertias(self) -> tuple[Number, Number]:
        """Mass and moment of inertia about the centre of mass."""

    @property
    def coordinate_kinds(self) -> tuple[str, ...]:
        return (POSITION, POSITION, ANGLE)

    def coordinates(self, x: Number, y: Number, angle: Number) -> np.ndarray:
        ox, oy = turned(*self.offset, angle)
        return np.array([x - ox, y - oy, angle])

    def marker(self, point: str) -> Marker:
        return Marker(markers.RIGID, (0, 1, 2, None), (*self.local(point), 0.0))

    def lower(self, lowering: Lowering, first: int) -> None:
        lowering.add(RIGID, [first, first + 1, first + 2], [*self.inertias, *lowering.gravity])

    def outline(self, coordinates: np.ndarray, points: int) -> np.ndarray:
        local = np.array([self.local(point) for point in self.point_names if point != "centre"] or [(0.0, 0.0)])
        if len(local) == 1:
            local = np.vstack([local, (0.0, 0.0)])
        if len(local) > 2:
            local = np.vstack([local, local[:1]])
        c, s = np.cos(coordinates[:, 2:]), np.sin(coordinates[:, 2:])
        x = coordinates[:, :1] + c * local[:, 0] - s * local[:, 1]
        y = coordinates[:, 1:2] + s * local[:, 0] + c * local[:, 1]
        return np.stack([x, y], axis=2)
