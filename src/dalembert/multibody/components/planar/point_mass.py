"""The point mass."""

__all__ = ["PointMass"]

from dataclasses import dataclass

import numpy as np

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.base_body import POSITION, with_points
from dalembert.multibody.components.fields import Number, number, pair
from dalembert.multibody.components.planar import markers
from dalembert.multibody.components.planar.body import Body, Marker
from dalembert.multibody.components.points import Place
from dalembert.multibody.components.rows import Lowering
from dalembert.multibody.kernels.kind import Kind


@inlined
def _residual(x, v, a, p, m, inputs, r):
    """m (a - g)."""
    r[0] = p.mass * (a[0] - p.gravity_x)
    r[1] = p.mass * (a[1] - p.gravity_y)


@inlined
def _energy(x, v, p, m, inputs):
    kinetic = 0.5 * p.mass * (v[0] * v[0] + v[1] * v[1])
    return kinetic, -p.mass * (p.gravity_x * x[0] + p.gravity_y * x[1]), 0.0 * p.mass


POINT_MASS = Kind(
    "point_mass",
    coordinates=2,
    numbers=("mass", "gravity_x", "gravity_y"),
    residual=_residual,
    energy=_energy,
    gravity=("gravity_x", "gravity_y"),
)


@with_points("centre")
@dataclass(frozen=True)
class PointMass(Body):
    """A point with a mass and without an angle.

    Joints may hold its position (revolute joints without friction, distance joints), but no angle (fixed, prismatic and
    gear joints).

    Parameters
    ----------
    name : str
    mass : float
        kg.
    position : (float, float) or Point
        Initial position, m.
    velocity : (float, float), optional
        Initial velocity, m/s. If not given, that of the point that the mass is placed at, or zero; the joints may
        change it then.
    """

    turns = has_axes = False
    mass: Number = number("kg", above=0)
    position: Place = pair("m")
    velocity: tuple[Number, Number] | None = pair("m/s", None)

    @property
    def place(self) -> Place:
        return self.position

    @property
    def coordinate_kinds(self) -> tuple[str, ...]:
        return (POSITION, POSITION)

    @property
    def point_names(self) -> tuple[str, ...]:
        return ("centre",)

    def coordinates(self, x: Number, y: Number, angle: Number) -> np.ndarray:
        return np.array([x, y])

    def marker(self, point: str) -> Marker:
        return Marker(markers.MASS, (0, 1, None, None), (0.0, 0.0, 0.0))

    def lower(self, lowering: Lowering, first: int) -> None:
        lowering.add(POINT_MASS, [first, first + 1], [self.mass, *lowering.gravity])

    def outline(self, coordinates: np.ndarray, points: int) -> np.ndarray:
        return coordinates[:, None, :]
