"""Orientations: the axes of a body or a marker, by angles, a quaternion, a rotation vector or directions."""

__all__ = ["Orientation", "Pose"]

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from dalembert.arguments import Checked, is_number
from dalembert.errors import InputError, shown
from dalembert.multibody.components.fields import Number

Vector = tuple[Number, Number, Number]
_ALIKE = 1e-9  # of what should be orthonormal axes


def _numbers(row: Any) -> list[Number]:
    """The finite numbers of a row; none of what is no row of finite numbers."""
    return list(row) if _is_row(row) and all(map(is_number, row)) else []


def _is_row(value: Any) -> bool:
    """Whether something has several entries, as a list and an array do."""
    return (
        value.ndim > 0 if isinstance(value, np.ndarray) else isinstance(value, Sequence) and not isinstance(value, str)
    )


@dataclass(frozen=True)
class Orientation:
    """Axes of a frame, as the columns of a rotation matrix.

    Parameters
    ----------
    rows : three tuples of three float
        Rows of the rotation matrix: ``rows[i][j]`` is the component i of axis j.

    Examples
    --------
    >>> Orientation.by_angles("z", [np.pi / 2]).matrix.round(3).tolist()
    [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
    """

    rows: tuple[Vector, Vector, Vector] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))

    IN_WORDS = "an orientation such as Orientation.by_angles('zyx', [0.1, 0.0, 0.0])"

    def __post_init__(self) -> None:
        rows = [_numbers(row) for row in self.rows] if _is_row(self.rows) else []
        wrong = [len(row) for row in rows] != [3, 3, 3]
        matrix = np.eye(3) if wrong else np.array(rows)
        if wrong or np.abs(np.real(matrix.T @ matrix) - np.eye(3)).max() > _ALIKE or np.linalg.det(np.real(matrix)) < 0:
            raise InputError(
                f"Orientation: rows is {shown(self.rows)}; expected the rows of a rotation matrix, with orthonormal, "
                "right-handed columns. Or use by_angles, by_quaternion, by_rotation_vector or by_axes"
            )

    @property
    def matrix(self) -> np.ndarray:
        """The rotation matrix, (3, 3); complex while a derivative is taken."""
        return np.array(self.rows)

    @classmethod
    def of(cls, matrix: np.ndarray) -> "Orientation":
        """From a rotation matrix, (3, 3)."""
        is_matrix = isinstance(matrix, np.ndarray) and matrix.ndim == 2
        return cls(tuple(map(tuple, matrix.tolist())) if is_matrix else matrix)  # type: ignore[arg-type]

    @classmethod
    def by_angles(cls, axes: str, angles: Number | Sequence[Number]) -> "Orientation":
        """By successive rotations, rad, about axes such as ``"zyx"`` (turning with the body) or ``"XYZ"`` (fixed).

        Small letters name axes that turn with the rotations before (yaw, pitch, roll are ``"zyx"``), capital letters
        fixed ones (roll, pitch, yaw of URDF are ``"XYZ"``). There may be one to three of them. A single angle can be a
        number.

        Raises
        ------
        InputError
            For other letters, mixed ones, another number of angles, or what is no finite number.

        Examples
        --------
        >>> Orientation.by_angles("z", 0.3) == Orientation.by_angles("z", [0.3])
        True
        """
        given_axes, axes = axes, axes if isinstance(axes, str) else ""
        turns = _numbers([angles] if is_number(angles) else angles)
        if not turns:
            raise InputError(
                f"Orientation: the angles are {shown(angles)}; expected finite numbers in rad, such as [0.1, 0.0, 0.0]"
            )
        fixed = axes.isupper()
        letters = axes.lower()
        if not letters or set(letters) - set("xyz") or not (fixed or axes.islower()) or len(letters) > 3:
            raise InputError(
                f"Orientation: the axes are {shown(given_axes)}; expected one to three of 'xyz' (turning with the "
                "body) or of 'XYZ' (fixed)"
            )
        if len(turns) != len(letters):
            raise InputError(f"Orientation: {len(turns)} angles for the axes {axes!r}; expected {len(letters)}")
        whole = np.eye(3)
        for letter, angle in zip(letters, turns, strict=True):
            turn = about(np.eye(3)["xyz".index(letter)], angle)
            whole = turn @ whole if fixed else whole @ turn
        return cls.of(whole)

    @classmethod
    def by_rotation_vector(cls, vector: Sequence[Number]) -> "Orientation":
        """By a rotation about the direction of a vector, by its length in rad."""
        given = _three(vector, "rotation vector")
        angle = np.sqrt(given @ given)
        if np.real(angle) == 0.0:  # R = 1 + [v]x to first order
            return cls.of(np.eye(3) + skew(given))
        return cls.of(about(given / angle, angle))

    @classmethod
    def by_quaternion(cls, w: Number, x: Number, y: Number, z: Number) -> "Orientation":
        """By a quaternion, the scalar first; it is normalised.

        Raises
        ------
        InputError
            For a quaternion of length zero.
        """
        if not all(map(is_number, (w, x, y, z))):
            raise InputError(
                f"Orientation: the quaternion is {shown((w, x, y, z))}; expected four finite numbers, such as "
                "(1, 0, 0, 0)"
            )
        given = np.array([w, x, y, z])
        square = given @ given
        if not np.real(square) > 1e-24:
            raise InputError(
                f"Orientation: the quaternion ({w}, {x}, {y}, {z}) has the length zero; expected one that is not zero, "
                "such as (1, 0, 0, 0)"
            )
        v, own = given[1:], skew(given[1:])
        return cls.of(np.eye(3) + 2.0 * (w * own + np.outer(v, v) - (v @ v) * np.eye(3)) / square)

    @classmethod
    def by_axes(cls, z: Sequence[Number], x: Sequence[Number] | None = None) -> "Orientation":
        """By the direction of the third axis, and a direction towards which the first axis points as far as it can.

        Vectors need not have the length one. Without ``x`` the first axis is perpendicular to ``z`` somehow.

        Raises
        ------
        InputError
            For a direction of length zero, or parallel directions.
        """
        third = direction(z, "Orientation: the direction z")
        helper = np.eye(3)[int(np.argmin(np.abs(np.real(third))))] if x is None else _three(x, "direction x")
        across = helper - (helper @ third) * third
        if not np.real(across @ across) > 1e-18 * max(np.real(helper @ helper), 1e-300):
            raise InputError(
                f"Orientation: x {shown(x)} is zero or parallel to z {shown(z)}; expected another direction"
            )
        first = across / np.sqrt(across @ across)
        return cls.of(np.column_stack([first, np.cross(third, first), third]))

    def __matmul__(self, other: "Orientation") -> "Orientation":
        """The orientation of a frame that has the orientation ``other`` in this one."""
        if not isinstance(other, Orientation):
            return NotImplemented
        return Orientation.of(self.matrix @ other.matrix)


@dataclass(frozen=True)
class Pose(Checked):
    """Position and orientation of a frame.

    Parameters
    ----------
    position : (float, float, float)
        m.
    orientation : Orientation
    """

    position: Vector = field(default=(0.0, 0.0, 0.0), metadata={"unit": "m", "shape": (3,)})
    orientation: Orientation = Orientation()

    IN_WORDS = "a position such as (0.1, 0.0, 0.0), or a Pose with an orientation"


def skew(vector: np.ndarray) -> np.ndarray:
    """The matrix whose product with u is the cross product of a vector with u."""
    x, y, z = vector
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def about(unit: np.ndarray, angle: Any) -> np.ndarray:
    """Rotation matrix about a direction of length one, by Rodrigues' formula."""
    return np.cos(angle) * np.eye(3) + np.sin(angle) * skew(unit) + (1.0 - np.cos(angle)) * np.outer(unit, unit)


def turned(directors: np.ndarray, turn: np.ndarray) -> np.ndarray:
    """Directors (3, 3), one in each row, after a rotation by a rotation vector (3,) in the fixed axes."""
    square = turn @ turn
    if np.real(square) > 0.0:
        angle = np.sqrt(square)
        return directors @ about(turn / angle, angle).T
    return directors + np.cross(turn, directors)  # first order, which keeps a derivative


def direction(vector: Any, owner: str) -> np.ndarray:
    """A direction, made one of length one, (3,)."""
    given = _three(vector, owner)
    square = given @ given
    if not np.real(square) > 1e-24:
        raise InputError(
            f"{owner} is {shown(vector)}, which has the length zero; expected a direction, such as (0, 0, 1)"
        )
    return given / np.sqrt(square)


def _three(vector: Any, owner: str) -> np.ndarray:
    numbers = _numbers(vector)
    if len(numbers) != 3:
        raise InputError(f"{owner} is {shown(vector)}; expected three finite numbers, such as (0, 0, 1)")
    return np.array(numbers)
