"""Inertia of rigid bodies in space: tensor, pseudo-inertia, and inertias of simple shapes.

The pseudo-inertia P = integral of [1; s][1; s]^T dm, (4, 4), is symmetric and positive definite for every body that can
exist, and linear in mass, first moments and inertia: P = [[m, m c^T], [m c, S]], S = tr(J) / 2 - J with the inertia
tensor J about the body's origin (Wensing, Kim and Slotine 2018).
"""

__all__ = ["Inertia"]

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from dalembert.arguments import Checked, array_of, is_number
from dalembert.errors import InputError, shown
from dalembert.multibody.components.fields import Number, number
from dalembert.multibody.components.spatial.orientation import Vector

_ROUNDING = 1e-12


@dataclass(frozen=True)
class Inertia(Checked):
    """Mass, centre of mass and inertia tensor of a rigid body.

    Parameters
    ----------
    mass : float
        kg.
    moments : (float, float, float)
        Moments of inertia about axes through the centre of mass that are parallel to those of the body, kg m^2.
    products : (float, float, float)
        Entries xy, xz and yz of the inertia tensor, kg m^2: J_xy = -integral of x y dm.
    centre : (float, float, float)
        Centre of mass in the axes of the body, m.

    Raises
    ------
    InputError
        For a tensor that no body can have: a principal moment that is not positive, or is larger than the sum of both
        others.

    Examples
    --------
    >>> brick = Inertia.box(mass=6.0, sides=(0.1, 0.2, 0.3))
    >>> [round(moment, 6) for moment in brick.moments]
    [0.065, 0.05, 0.025]
    """

    mass: Number = number("kg", above=0)
    moments: Vector = number("kg*m**2")
    products: Vector = number("kg*m**2", (0.0, 0.0, 0.0))
    centre: Vector = number("m", (0.0, 0.0, 0.0))

    IN_WORDS = "an Inertia such as Inertia.box(mass=1.0, sides=(0.1, 0.2, 0.3))"

    def __post_init__(self) -> None:
        principal, axes = np.linalg.eigh(np.real(self.tensor))
        excess = principal[2] - principal[0] - principal[1]
        if principal[0] >= -_ROUNDING * principal[2] and excess > _ROUNDING * principal[2]:
            raise InputError(
                f"Inertia: the principal moments are {', '.join(f'{moment:.6g}' for moment in principal)} kg m^2; the "
                f"largest, about {_direction(axes[:, 2])}, is {excess:.6g} larger than the sum of both others, which "
                "no body can have. Check moments and products"
            )
        if principal[0] <= 0.0:
            raise InputError(
                f"Inertia: the smallest principal moment, about {_direction(axes[:, 0])}, is {principal[0]:.6g} "
                "kg m^2; expected a positive one. Check moments and products"
            )

    @property
    def tensor(self) -> np.ndarray:
        """Inertia tensor about the centre of mass, (3, 3), kg m^2."""
        (xx, yy, zz), (xy, xz, yz) = self.moments, self.products
        return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])

    @property
    def pseudo(self) -> np.ndarray:
        """Pseudo-inertia about the body's origin, (4, 4)."""
        m, c, tensor = self.mass, np.array(self.centre), self.tensor
        second = 0.5 * np.trace(tensor) * np.eye(3) - tensor + m * np.outer(c, c)
        return np.block([[np.array([[m]]), m * c[None, :]], [m * c[:, None], second]])

    @classmethod
    def of(cls, mass: Number, tensor: np.ndarray, centre: Any = (0.0, 0.0, 0.0)) -> "Inertia":
        """From a tensor about the centre of mass, (3, 3), kg m^2."""
        t = array_of(tensor)
        if t.shape != (3, 3) or not np.abs(t - t.T).max() <= 1e-9 * np.abs(t).max():
            raise InputError(f"Inertia: the tensor is {shown(tensor)}; expected a symmetric matrix (3, 3) in kg m^2")
        products = (t[0, 1], t[0, 2], t[1, 2])
        return cls(mass, *(tuple(np.asarray(own).tolist()) for own in (np.diagonal(t), products, centre)))

    @classmethod
    def of_pseudo(cls, pseudo: np.ndarray) -> "Inertia":
        """From a pseudo-inertia about the body's origin, (4, 4)."""
        m = pseudo[0, 0]
        centre = pseudo[0, 1:] / m
        second = pseudo[1:, 1:] - m * np.outer(centre, centre)
        return cls.of(m, np.trace(second) * np.eye(3) - second, centre)

    @classmethod
    def box(cls, mass: Number, sides: Sequence[Number]) -> "Inertia":
        """A solid box with sides (m) along the axes, centred at the origin."""
        _require("Inertia.box", mass=mass)
        given = list(sides) if isinstance(sides, Sequence | np.ndarray) else []
        if len(given) != 3 or not all(is_number(side) and np.real(side) > 0 for side in given):
            raise InputError(f"Inertia.box: sides is {shown(sides)}; expected three positive numbers in m")
        x, y, z = (side * side for side in given)
        return cls(mass, (mass * (y + z) / 12.0, mass * (x + z) / 12.0, mass * (x + y) / 12.0))

    @classmethod
    def cylinder(cls, mass: Number, radius: Number, length: Number, inner: Number = 0.0) -> "Inertia":
        """A cylinder along z, centred at the origin, or a tube with an ``inner`` radius, m.

        Raises
        ------
        InputError
            For an inner radius that is not smaller than the outer one, and for what is no positive number.
        """
        _require("Inertia.cylinder", mass=mass, radius=radius, length=length)
        if not (is_number(inner) and 0.0 <= np.real(inner) < np.real(radius)):
            raise InputError(
                f"Inertia.cylinder: inner is {shown(inner)}; expected a radius from 0 to less than the outer radius, "
                f"{np.real(radius):g} m"
            )
        squares = radius * radius + inner * inner
        across = mass * (3.0 * squares + length * length) / 12.0
        return cls(mass, (across, across, 0.5 * mass * squares))

    @classmethod
    def sphere(cls, mass: Number, radius: Number) -> "Inertia":
        """A solid sphere, centred at the origin; the radius in m."""
        _require("Inertia.sphere", mass=mass, radius=radius)
        own = 0.4 * mass * radius * radius
        return cls(mass, (own, own, own))

    def moved(self, to: Any) -> "Inertia":
        """The same body with its centre of mass shifted by a vector, m."""
        centre = tuple(np.add(self.centre, to).tolist())
        return Inertia(self.mass, self.moments, self.products, centre)


def _require(owner: str, **values: Any) -> None:
    """Refuse values that are no positive numbers."""
    for name, value in values.items():
        if not (is_number(value) and np.real(value) > 0):
            unit = "kg" if name == "mass" else "m"
            raise InputError(f"{owner}: {name} is {shown(value)}; expected a positive number in {unit}")


def _direction(axis: np.ndarray) -> str:
    """A principal axis for messages; its largest component is positive."""
    turned = axis * np.sign(axis[np.argmax(np.abs(axis))])
    return f"({', '.join(f'{entry:.3g}' for entry in turned.round(6) + 0.0)})"
