"""Sections of beams in space: their stiffness and inertia per length, from shapes, materials or constants."""

__all__ = ["Section"]

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from dalembert.arguments import Checked, is_number
from dalembert.errors import InputError, shown
from dalembert.multibody.components.fields import Number, number

NAMES = ("stretch", "shear along y", "shear along z", "twist", "bending about y", "bending about z")
_ROUNDING = 1e-12
_AROUND = 10
"""Corners of the outline of a circle."""


@dataclass(frozen=True)
class Section(Checked):
    """Stiffness and inertia of a beam's section, per length, in its axes y and z through the beam's line.

    The strains are stretch, shear along y and z, twist, and curvatures about y and z. The stress resultants are C e.

    Parameters
    ----------
    stiffness : six float, or six rows of six float
        E A, k_y G A and k_z G A in N, G J, E I_y and E I_z in N m^2, with E I_y against bending about y; or the whole
        symmetric matrix C.
    mass : float
        Per length, kg/m.
    moments : (float, float)
        Second moments of the mass per length about y and z through the centre of mass, kg m.
    product : float
        Second moment of the mass of y z through the centre of mass, kg m.
    centre : (float, float)
        Centre of mass, m.
    shear_centre, centroid : (float, float)
        Where a shear force causes no twist, and an axial force no bending, m. The stiffness is that about these points.
    outline : sequence of (float, float)
        Corners (y, z) of the section for drawings, m; beams without them are drawn as lines.

    Raises
    ------
    InputError
        For a stiffness that is not symmetric and positive definite, with the direction that has none.

    Examples
    --------
    >>> steel = Section.rectangle(0.02, 0.01, youngs_modulus=2.1e11, poisson_ratio=0.3, density=7850.0)
    >>> float(steel.matrix[0, 0].round(3)), round(steel.mass, 9)
    (42000000.0, 1.57)
    """

    stiffness: Any = field(metadata={"table": "SectionStiffness"})
    mass: Number = number("kg/m", above=0)
    moments: tuple[Number, Number] = number("kg*m", above=0)
    product: Number = number("kg*m", 0.0)
    centre: tuple[Number, Number] = number("m", (0.0, 0.0))
    shear_centre: tuple[Number, Number] = number("m", (0.0, 0.0))
    centroid: tuple[Number, Number] = number("m", (0.0, 0.0))
    outline: Any = field(default=(), metadata={"key": False})

    IN_WORDS = "a Section such as Section.circle(0.01, youngs_modulus=2.1e11, poisson_ratio=0.3, density=7850.0)"

    def __post_init__(self) -> None:
        centred = self._centred
        if np.abs(centred - centred.T).max() > _ROUNDING * np.abs(centred).max():
            raise InputError(f"Section: the stiffness is {shown(self.stiffness)}; expected a symmetric matrix (6, 6)")
        # In units of the diagonal: stretch and bending have different ones.
        diagonal = np.real(np.diagonal(centred))
        if not np.all(diagonal > 0):
            which = int(np.argmin(diagonal))
            raise InputError(
                f"Section: the stiffness against {NAMES[which]} is {diagonal[which]:.6g}; expected a positive number"
            )
        scale = np.sqrt(np.outer(diagonal, diagonal))
        values, vectors = np.linalg.eigh(np.real(centred) / scale)
        if not values[0] > _ROUNDING:
            parts = vectors[:, 0] / np.sqrt(diagonal)
            shares = ", ".join(f"{part:.3g} {name}" for part, name in zip(parts, NAMES, strict=True) if part)
            raise InputError(
                f"Section: the stiffness matrix is not positive definite. No energy is stored by {shares}. Check the "
                "entries beside the diagonal"
            )
        if not _is_outline(self.outline):
            raise InputError(
                f"Section: outline is {shown(self.outline)}; expected three or more corners (y, z) in m, or none"
            )
        (yy, zz), yz = np.real(self.moments), np.real(self.product)
        if not yy * zz > yz * yz:
            raise InputError(
                f"Section: the product of the mass is {yz:.6g} kg m; expected less than the root of the product of the "
                f"moments, {np.sqrt(yy * zz):.6g} kg m"
            )

    @property
    def _centred(self) -> np.ndarray:
        """Stiffness about centroid and shear centre, (6, 6)."""
        try:
            matrix = np.array(self.stiffness)
        except ValueError:
            matrix = np.zeros(0)
        if matrix.dtype.kind not in "ifc" or matrix.shape not in ((6,), (6, 6)) or not np.isfinite(matrix).all():
            raise InputError(
                f"Section: the stiffness is {shown(self.stiffness)}; expected six finite numbers, or a matrix (6, 6): "
                "E A, k_y G A, k_z G A in N, G J, E I_y, E I_z in N m^2"
            )
        return np.diag(matrix) if matrix.ndim == 1 else matrix

    @cached_property
    def matrix(self) -> np.ndarray:
        """Stiffness C about the beam's line, (6, 6): stretch, shear y, shear z, twist, curvature y, curvature z."""
        # Strains at the points where they do not couple, by those at the line: stretch + z K_y - y K_z, and shears
        # Gamma_y - z K_x and Gamma_z + y K_x. C = H^T C_own H stores the same energy.
        (y, z), (ys, zs) = self.centroid, self.shear_centre
        moved = np.eye(6, dtype=np.result_type(y, z, ys, zs, float))
        moved[0, 4], moved[0, 5], moved[1, 3], moved[2, 3] = z, -y, -zs, ys
        return moved.T @ self._centred @ moved

    @cached_property
    def pseudo_inertia(self) -> np.ndarray:
        """Integral of rho [1, y, z]^T [1, y, z] over the section, (3, 3), in kg/m, kg and kg m."""
        # Moments are about y and z: that about y is the integral of z^2.
        (yy, zz), (y, z), m = self.moments, self.centre, self.mass
        second = np.array([[zz, self.product], [self.product, yy]]) + m * np.outer((y, z), (y, z))
        first = m * np.array([y, z])
        return np.block([[np.array([[m]]), first[None, :]], [first[:, None], second]])

    @classmethod
    def of_material(
        cls,
        area: Number,
        moments: tuple[Number, Number],
        torsion: Number,
        shear_factors: tuple[Number, Number],
        *,
        youngs_modulus: Number,
        poisson_ratio: Number,
        density: Number,
        **offsets: Any,
    ) -> "Section":
        """From geometric constants and a homogeneous material.

        Parameters
        ----------
        area : float
            m^2.
        moments : (float, float)
            Second moments of area about y and z, m^4.
        torsion : float
            Torsion constant J, m^4.
        shear_factors : (float, float)
            k_y and k_z.
        youngs_modulus, poisson_ratio, density : float
            Pa, 1, kg/m^3. The shear modulus is E / (2 (1 + nu)).
        **offsets
            ``centre``, ``shear_centre``, ``centroid`` and ``outline`` of :class:`Section`, m.
        """
        e, g = youngs_modulus, youngs_modulus / (2.0 * (1.0 + poisson_ratio))
        stiffness = (
            e * area, shear_factors[0] * g * area, shear_factors[1] * g * area, g * torsion, e * moments[0],
            e * moments[1],
        )  # fmt: skip
        return cls(stiffness, density * area, (density * moments[0], density * moments[1]), **offsets)

    @classmethod
    def rectangle(cls, width: Number, height: Number, **material: Any) -> "Section":
        """A rectangle with sides along y (``width``) and z (``height``), m; ``material`` as of :meth:`of_material`.

        Shear factors 10 (1 + nu) / (12 + 11 nu) (Cowper 1966); the torsion constant by Saint-Venant's series.

        Examples
        --------
        >>> square = Section.rectangle(1.0, 1.0, youngs_modulus=2.0, poisson_ratio=0.0, density=1.0)
        >>> square.matrix[3, 3].round(6).item()  # the torsion constant of a square of side 1 is 0.140577
        0.140577
        """
        _require("rectangle", width=width, height=height)
        nu = material.get("poisson_ratio", 0.0)
        factor = 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu)
        moments = (width * height**3 / 12.0, height * width**3 / 12.0)
        constants = width * height, moments, torsion_of_rectangle(width, height), (factor, factor)
        material.setdefault("outline", _box(width, height))
        return cls.of_material(*constants, **material)

    @classmethod
    def circle(cls, radius: Number, **material: Any) -> "Section":
        """A solid circle, m; shear factors 6 (1 + nu) / (7 + 6 nu) (Cowper 1966)."""
        _require("circle", radius=radius)
        nu = material.get("poisson_ratio", 0.0)
        factor, moment = 6.0 * (1.0 + nu) / (7.0 + 6.0 * nu), np.pi * radius**4 / 4.0
        constants = np.pi * radius**2, (moment, moment), 2.0 * moment, (factor, factor)
        material.setdefault("outline", _circle(radius))
        return cls.of_material(*constants, **material)

    @classmethod
    def tube(cls, radius: Number, inner: Number, **material: Any) -> "Section":
        """A tube with its outer and ``inner`` radius, m; shear factors of Cowper (1966).

        Raises
        ------
        InputError
            For an inner radius that is not smaller than the outer one.
        """
        _require("tube", radius=radius, inner=inner)
        if not np.real(inner) < np.real(radius):
            raise InputError(f"Section.tube: inner is {inner} m and radius {radius} m; expected a smaller inner radius")
        nu, share = material.get("poisson_ratio", 0.0), (inner / radius) ** 2
        square = (1.0 + share) ** 2
        factor = 6.0 * (1.0 + nu) * square / ((7.0 + 6.0 * nu) * square + (20.0 + 12.0 * nu) * share)
        moment = np.pi * (radius**4 - inner**4) / 4.0
        area = np.pi * (radius**2 - inner**2)
        constants = area, (moment, moment), 2.0 * moment, (factor, factor)
        material.setdefault("outline", _circle(radius))
        return cls.of_material(*constants, **material)

    @classmethod
    def box(cls, width: Number, height: Number, wall: Number, **material: Any) -> "Section":
        """A closed box with sides along y and z and a thin wall, m: torsion by Bredt's formula, shear by its webs.

        Raises
        ------
        InputError
            For a wall that fills the box.
        """
        _require("box", width=width, height=height, wall=wall)
        b, c = width - 2.0 * wall, height - 2.0 * wall
        if not (np.real(b) > 0 and np.real(c) > 0):
            raise InputError(f"Section.box: wall is {wall} m; expected less than half of {width} m and {height} m")
        area = width * height - b * c
        moments = ((width * height**3 - b * c**3) / 12.0, (height * width**3 - c * b**3) / 12.0)
        middle_b, middle_c = width - wall, height - wall
        torsion = 2.0 * wall * (middle_b * middle_c) ** 2 / (middle_b + middle_c)
        factors = (2.0 * wall * width / area, 2.0 * wall * height / area)
        material.setdefault("outline", _box(width, height))
        return cls.of_material(area, moments, torsion, factors, **material)

    @classmethod
    def i_beam(cls, width: Number, height: Number, web: Number, flange: Number, **material: Any) -> "Section":
        """An I with its web along z and flanges along y, m: thin-walled torsion, shear by web and flanges.

        Parameters
        ----------
        width, height : float
            Of the whole section along y and z, m.
        web, flange : float
            Thicknesses, m.
        **material
            As of :meth:`of_material`.

        Raises
        ------
        InputError
            For thicknesses that fill the section.
        """
        _require("i_beam", width=width, height=height, web=web, flange=flange)
        inner = height - 2.0 * flange
        if not (np.real(inner) > 0 and np.real(web) < np.real(width)):
            raise InputError(
                f"Section.i_beam: web is {web} m and flange {flange} m; expected less than the width, {width} m, and "
                f"half of the height, {height} m"
            )
        area = 2.0 * width * flange + inner * web
        moments = (
            (width * height**3 - (width - web) * inner**3) / 12.0,
            (2.0 * flange * width**3 + inner * web**3) / 12.0,
        )
        torsion = (2.0 * width * flange**3 + (height - flange) * web**3) / 3.0
        factors = (5.0 / 6.0 * 2.0 * width * flange / area, web * height / area)
        y, z, thin, low = width / 2.0, height / 2.0, web / 2.0, height / 2.0 - flange
        quarter = np.array([(thin, low), (y, low), (y, z)])
        left = quarter[::-1] * (-1, 1)
        outline = tuple(map(tuple, np.concatenate([quarter, left, -quarter, -left]).tolist()))
        material.setdefault("outline", outline)
        return cls.of_material(area, moments, torsion, factors, **material)


def _is_outline(outline: Any) -> bool:
    """Whether something is empty, or three or more corners (y, z)."""
    try:
        corners = np.array(outline)
    except ValueError:
        return False
    usable = corners.ndim == 2 and corners.shape[1] == 2 and corners.dtype.kind in "ifc" and np.isfinite(corners).all()
    return bool(usable and len(corners) > 2) or corners.shape == (0,)


def _box(width: Number, height: Number) -> tuple[tuple[Number, Number], ...]:
    """Corners of a rectangle."""
    y, z = width / 2.0, height / 2.0
    return (y, z), (-y, z), (-y, -z), (y, -z)


def _circle(radius: Number) -> tuple[tuple[Number, Number], ...]:
    """Corners on a circle."""
    angles = np.linspace(0.0, 2.0 * np.pi, _AROUND, endpoint=False)
    return tuple((radius * np.cos(angle), radius * np.sin(angle)) for angle in angles)


def torsion_of_rectangle(width: Number, height: Number) -> Number:
    """Return the torsion constant of a rectangle, m^4, by Saint-Venant's series (Timoshenko and Goodier, section 109).

    J = a b^3 / 3 (1 - 192 / pi^5 (b / a) sum tanh(n pi a / (2 b)) / n^5) over odd n, with a >= b.
    """
    a, b = (width, height) if np.real(width) >= np.real(height) else (height, width)
    odd = np.arange(1, 40, 2)
    series = np.sum(np.tanh(odd * np.pi * a / (2.0 * b)) / odd**5)
    return a * b**3 / 3.0 * (1.0 - 192.0 / np.pi**5 * (b / a) * series)


def _require(shape: str, **sizes: Any) -> None:
    """Refuse sizes that are not positive numbers."""
    for name, size in sizes.items():
        if not (is_number(size) and np.real(size) > 0):
            raise InputError(f"Section.{shape}: {name} is {shown(size)}; expected a positive number in m")


Sections = Section | Sequence[tuple[Number, Section]]
"""A section, or a table of sections at places along a beam, m from its start."""
