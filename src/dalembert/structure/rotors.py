r"""Parts of a rotor: discs, whose axes tilt, and damping that turns with the rotor."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from scipy.sparse import csc_array, issparse

from dalembert.arguments import Checked, takes_checked
from dalembert.errors import InputError
from dalembert.structure.structure import Structure

Number = float | complex


@dataclass(frozen=True)
class Disc(Checked):
    r"""Gyroscopic moments of a disc that turns about z and tilts by small angles about x and y.

    .. math:: M_x = I_p \Omega\, \dot\theta_y, \qquad M_y = -I_p \Omega\, \dot\theta_x.

    Parameters
    ----------
    first, second : str
        Rotations across the axis, such as ``"disc.rx"`` and ``"disc.ry"``. The rotor turns from the first to the
        second.
    polar_inertia : float
        I_p, kg m². The inertia against tilting belongs to the mass matrix.
    """

    first: str
    second: str
    polar_inertia: Number = field(metadata={"unit": "kg*m^2"})


@dataclass(frozen=True)
class RotatingDamper(Checked):
    r"""A viscous damper that turns with the rotor, such as the internal damping of a shaft.

    It feels the velocity in the frame of the rotor,

    .. math:: F_x = c\,(\dot x + \Omega y), \qquad F_y = c\,(\dot y - \Omega x).

    Parameters
    ----------
    first, second : str
        Displacements across the axis, such as ``"disc.x"`` and ``"disc.y"``. The rotor turns from the first to the
        second.
    damping : float
        c, N s/m.
    other : (str, str), optional
        Displacements of the other end, on the same rotor; the axis of rotation if not given.
    """

    first: str
    second: str
    damping: Number = field(metadata={"unit": "N*s/m"})
    other: tuple[str, str] | None = None


RotorPart = Disc | RotatingDamper


@takes_checked("parts")
def with_rotors(structure: Structure, parts: Sequence[RotorPart]) -> Structure:
    """Return a structure with discs and rotating dampers.

    Damping of other kinds comes before: ``with_damping`` replaces that of the dampers.

    Parameters
    ----------
    structure : Structure
    parts : sequence of Disc or RotatingDamper

    Raises
    ------
    InputError
        For an unknown degree of freedom, and a part whose directions are equal.

    Examples
    --------
    >>> from dalembert.structure import Dofs
    >>> rotor = Structure(np.eye(2), np.eye(2), Dofs(("disc.x", "disc.y")))
    >>> rotor = with_rotors(rotor, [RotatingDamper("disc.x", "disc.y", 0.1)])
    >>> rotor.damping.tolist(), rotor.circulatory.tolist()
    ([[0.1, 0.0], [0.0, 0.1]], [[0.0, 0.1], [-0.1, 0.0]])
    """
    added: dict[str, list[tuple[np.ndarray, np.ndarray, Number]]] = {}
    for part in parts:
        first, second = (_row(structure, part, number) for number in (0, 1))
        if isinstance(part, Disc):
            added.setdefault("gyroscopic", []).extend(_turning(first, second, part.polar_inertia))
        else:
            added.setdefault("damping", []).extend([(row, row, part.damping) for row in (first, second)])
            added.setdefault("circulatory", []).extend(_turning(first, second, part.damping))
    matrices: dict[str, Any] = {}
    for name, entries in added.items():
        left, right = (np.array([entry[side] for entry in entries]).T for side in (0, 1))
        sizes, before = np.array([size for *_, size in entries]), getattr(structure, name)
        if issparse(structure.mass):
            left, right = csc_array(left), csc_array(right)
        matrices[name] = (0.0 * structure.mass if before is None else before) + (left * sizes) @ right.T
    return replace(structure, **matrices)


def _turning(first: np.ndarray, second: np.ndarray, size: Number) -> list[tuple[np.ndarray, np.ndarray, Number]]:
    """Entries of size · (first secondᵀ - second firstᵀ)."""
    return [(first, second, size), (second, first, -size)]


def _row(structure: Structure, part: RotorPart, number: int) -> np.ndarray:
    """The displacement or rotation that a part sees in one of its directions, (n,)."""
    where = f"{type(part).__name__} at {part.first!r}"
    if part.first == part.second:
        raise InputError(f"{where}: both directions are {part.first!r}; expected two across the axis")
    result = np.zeros(structure.size)
    result[structure.dofs.index((part.first, part.second)[number], where)] = 1.0
    if isinstance(part, RotatingDamper) and part.other is not None:
        result[structure.dofs.index(part.other[number], where)] -= 1.0
    return result
