"""The point mass in space."""

__all__ = ["PointMass"]

from dataclasses import dataclass, field

import numpy as np

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.base_body import POSITION, with_points
from dalembert.multibody.components.fields import Number, number
from dalembert.multibody.components.spatial import spatial_markers as markers
from dalembert.multibody.components.spatial.ground_points import Place
from dalembert.multibody.components.spatial.orientation import Vector
from dalembert.multibody.components.spatial.spatial_body import Body, Marker
from dalembert.multibody.components.spatial.spatial_rows import SpatialRows
from dalembert.multibody.components.spatial.vectors import add_at, at, dot, minus, times
from dalembert.multibody.kernels.kind import Kind


@inlined
def _residual(x, v, a, p, m, inputs, r):
    """m (a - g)."""
    add_at(r, 0, times(p.mass, minus(at(a, 0), (p.gravity_x, p.gravity_y, p.gravity_z))))


@inlined
def _energy(x, v, p, m, inputs):
    kinetic = 0.5 * p.mass * dot(at(v, 0), at(v, 0))
    return kinetic, -p.mass * dot((p.gravity_x, p.gravity_y, p.gravity_z), at(x, 0)), 0.0 * kinetic


POINT_MASS = Kind(
    "point_mass_in_space",
    coordinates=3,
    numbers=("mass", "gravity_x", "gravity_y", "gravity_z"),
    residual=_residual,
    dissipates=(),
    energy=_energy,
    gravity=("gravity_x", "gravity_y", "gravity_z"),
)


@with_points("centre")
@dataclass(frozen=True)
class PointMass(Body):
    """A point with a mass; joints may hold its position, not its orientation.

    Parameters
    ----------
    name : str
    mass : float
        kg.
    position : (float, float, float) or Point
        Initial position, m.
    velocity : (float, float, float), optional
        Initial velocity, m/s. If not given, that of the point that the mass is placed at, or zero; the joints may
        change it then.
    """

    turns = has_axes = False
    mass: Number = number("kg", above=0)
    position: Place = field(default=(0.0, 0.0, 0.0), metadata={"unit": "m", "shape": (3,)})
    velocity: Vector | None = number("m/s", None)

    @property
    def place(self) -> Place:
        return self.position

    @property
    def coordinate_kinds(self) -> tuple[str, ...]:
        return (POSITION,) * 3

    @property
    def point_names(self) -> tuple[str, ...]:
        return ("centre",)

    def placed(self, frame: np.ndarray) -> np.ndarray:
        return frame[:3]

    def rigid_modes(self, coordinates: np.ndarray, frame: np.ndarray) -> np.ndarray:
        return np.eye(3, 6, dtype=np.result_type(coordinates, frame))

    def marker(self, point: str) -> Marker:
        return Marker(markers.MASS, (0, 1, 2, *(None,) * 9), np.zeros(3), np.eye(3))

    def lower(self, lowering: SpatialRows, first: int) -> None:
        lowering.add(POINT_MASS, [first, first + 1, first + 2], [self.mass, *lowering.gravity])

    def outline(self, coordinates: np.ndarray, points: int) -> np.ndarray:
        return coordinates[:, None, :]
