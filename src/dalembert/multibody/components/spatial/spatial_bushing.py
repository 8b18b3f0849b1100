"""Bushings in space: elastic bearings with stiffness and damping in six directions, which may be coupled."""

__all__ = ["Bushing"]

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from dalembert.arguments import array_of
from dalembert.errors import InputError, shown
from dalembert.kernels.kernel import inlined
from dalembert.kernels.views import stack
from dalembert.multibody.components.fields import Number
from dalembert.multibody.components.points import require_direction
from dalembert.multibody.components.spatial.ground_points import Side
from dalembert.multibody.components.spatial.kinds import pair_kind
from dalembert.multibody.components.spatial.rotations import rotation_vector, vector_rate, vector_torque
from dalembert.multibody.components.spatial.spatial_load import Load
from dalembert.multibody.components.spatial.spatial_markers import axis_rate
from dalembert.multibody.components.spatial.spatial_pairs import (
    A_AXES,
    E,
    along_axes,
    e1,
    e2,
    e3,
    f1,
    f2,
    f3,
    push_a_axis,
    push_pair,
    relative_spin,
    separation,
    separation_rate,
    twist_pair,
)  # fmt: skip
from dalembert.multibody.components.spatial.spatial_rows import SpatialRows
from dalembert.multibody.components.spatial.vectors import at, combined, dot, times

_ROUNDING = 1e-9  # of the smallest eigenvalue
_ENTRIES = [(i, j) for i in range(6) for j in range(i, 6)]
_NUMBERS = tuple(f"{what}_{i + 1}{j + 1}" for what in ("stiffness", "damping") for i, j in _ENTRIES)
_PUSH_A = tuple(push_a_axis(number) for number in (1, 2, 3))


def _displacement(i: int) -> tuple[Any, Any, Any]:
    """Displacement e_i . Delta, its rate, and the force that does work on it."""
    e, own, push_e = E[i], A_AXES[i], _PUSH_A[i]

    @inlined
    def value(x, p, m):
        return dot(e(x, p, m), separation(x, p, m))

    @inlined
    def rate(x, v, p, m):
        turning = axis_rate(m.a_kind, 0, v, own(p))
        return dot(turning, separation(x, p, m)) + dot(e(x, p, m), separation_rate(v, p, m))

    @inlined
    def push(x, p, m, force, r):
        push_e(p, m, times(force, separation(x, p, m)), r)
        push_pair(p, m, times(force, e(x, p, m)), r)

    return value, rate, push


(_u1, _v1, _push1), (_u2, _v2, _push2), (_u3, _v3, _push3) = map(_displacement, range(3))


@inlined
def _rotation(x, p, m):
    """Rotation vector of b relative to a, along the axes of a (or of b: they are the same)."""
    first, second = along_axes(f1(x, p, m), x, p, m), along_axes(f2(x, p, m), x, p, m)
    return rotation_vector(first, second, along_axes(f3(x, p, m), x, p, m))


@inlined
def _deflection(x, v, p, m, u, w):
    """Displacement and rotation vector of b relative to a along the axes of a, less those at the start, and rates."""
    u[0], u[1], u[2] = _u1(x, p, m) - p.rest_x, _u2(x, p, m) - p.rest_y, _u3(x, p, m) - p.rest_z
    u[3], u[4], u[5] = _rotation(x, p, m)
    w[0], w[1], w[2] = _v1(x, v, p, m), _v2(x, v, p, m), _v3(x, v, p, m)
    w[3], w[4], w[5] = vector_rate(at(u, 3), along_axes(relative_spin(x, v, m), x, p, m))


@inlined
def _stiffness(p):
    return (
        (p.stiffness_11, p.stiffness_12, p.stiffness_13, p.stiffness_14, p.stiffness_15, p.stiffness_16),
        (p.stiffness_12, p.stiffness_22, p.stiffness_23, p.stiffness_24, p.stiffness_25, p.stiffness_26),
        (p.stiffness_13, p.stiffness_23, p.stiffness_33, p.stiffness_34, p.stiffness_35, p.stiffness_36),
        (p.stiffness_14, p.stiffness_24, p.stiffness_34, p.stiffness_44, p.stiffness_45, p.stiffness_46),
        (p.stiffness_15, p.stiffness_25, p.stiffness_35, p.stiffness_45, p.stiffness_55, p.stiffness_56),
        (p.stiffness_16, p.stiffness_26, p.stiffness_36, p.stiffness_46, p.stiffness_56, p.stiffness_66),
    )


@inlined
def _damping(p):
    return (
        (p.damping_11, p.damping_12, p.damping_13, p.damping_14, p.damping_15, p.damping_16),
        (p.damping_12, p.damping_22, p.damping_23, p.damping_24, p.damping_25, p.damping_26),
        (p.damping_13, p.damping_23, p.damping_33, p.damping_34, p.damping_35, p.damping_36),
        (p.damping_14, p.damping_24, p.damping_34, p.damping_44, p.damping_45, p.damping_46),
        (p.damping_15, p.damping_25, p.damping_35, p.damping_45, p.damping_55, p.damping_56),
        (p.damping_16, p.damping_26, p.damping_36, p.damping_46, p.damping_56, p.damping_66),
    )


@inlined
def _product(matrix, u, out):
    """Add matrix u."""
    for i in range(6):
        for j in range(6):
            out[i] += matrix[i][j] * u[j]


@inlined
def _loads(x, v, p, m, u, w, f):
    """Forces and torques K u + D u' that do work on u."""
    _deflection(x, v, p, m, u, w)
    for i in range(6):
        f[i] = 0.0 * u[i]
    _product(_stiffness(p), u, f)
    _product(_damping(p), w, f)


@inlined
def _residual(x, v, a, p, m, inputs, r):
    u, w, f = stack(x, 6), stack(x, 6), stack(x, 6)
    _loads(x, v, p, m, u, w, f)
    _push1(x, p, m, f[0], r)
    _push2(x, p, m, f[1], r)
    _push3(x, p, m, f[2], r)
    torque = vector_torque(at(u, 3), at(f, 3))
    twist_pair(x, m, combined(torque, e1(x, p, m), e2(x, p, m), e3(x, p, m)), r)


@inlined
def _energy(x, v, p, m, inputs):
    """u . K u / 2, and the power -u' . D u'."""
    u, w, f, g = stack(x, 6), stack(x, 6), stack(x, 6), stack(x, 6)
    _deflection(x, v, p, m, u, w)
    for i in range(6):
        f[i], g[i] = 0.0 * u[i], 0.0 * u[i]
    _product(_stiffness(p), u, f)
    _product(_damping(p), w, g)
    stored, lost = 0.0 * x[0], 0.0 * x[0]
    for i in range(6):
        stored += 0.5 * u[i] * f[i]
        lost += w[i] * g[i]
    return 0.0 * stored, stored, -lost


@inlined
def _observe(x, v, a, p, m, inputs, out):
    u, w, f = stack(x, 6), stack(x, 6), stack(x, 6)
    _loads(x, v, p, m, u, w, f)
    for i in range(6):
        out[i] = u[i]
    out[6], out[7], out[8] = f[0], f[1], f[2]
    out[9], out[10], out[11] = vector_torque(at(u, 3), at(f, 3))


BUSHING = pair_kind(
    "bushing_in_space",
    __name__,
    ("rest_x", "rest_y", "rest_z", *_NUMBERS),
    residual=_residual,
    energy=_energy,
    outputs=(
        ("x", "m"), ("y", "m"), ("z", "m"), ("rotation_x", "rad"), ("rotation_y", "rad"), ("rotation_z", "rad"),
        ("force_x", "N"), ("force_y", "N"), ("force_z", "N"),
        ("torque_x", "N*m"), ("torque_y", "N*m"), ("torque_z", "N*m"),
    ),
    observe=_observe,
    dissipates=tuple(name for name in _NUMBERS if name.startswith("damping")),
    holds=True,
    lanes=False,  # which entry of a quaternion is the largest is a branch on the state
)  # fmt: skip


@dataclass(frozen=True)
class Bushing(Load):
    """An elastic bearing between two markers, without force as the bodies are placed.

    u holds the displacement of b relative to a along the axes of a, and the rotation vector p of b relative to a: the
    axis of the rotation times its angle. Both start from zero. The bushing stores u . K u / 2 and loses u' . D u'. So
    K u + D u' consists of the force on a, and of the torque t that does work on p. The torque on a is
    t + p x t / 2 + c p x (p x t) with c = (1 - a/2 cot(a/2)) / a^2 and the angle a. For a rotation about one axis it is
    t. K and D are symmetric.

    The law holds for rotations of less than half a turn, where p is unique. Beyond half a turn p jumps to the rotation
    with the opposite axis, and the torque changes its sign. A finding names a motion that does this.

    Parameters
    ----------
    name : str
    a, b : Point or ground
    stiffness : six float, or (6, 6) symmetric
        Along and about the axes x, y, z of a: N/m, then N m/rad.
    damping : six float, or (6, 6) symmetric
        N s/m, then N m s/rad.

    Raises
    ------
    InputError
        For a stiffness or a damping that is not symmetric, or not positive semidefinite.

    Notes
    -----
    Channels: ``x``, ``y``, ``z``, the displacement; ``rotation_x``, ``rotation_y``, ``rotation_z``, the rotation
    vector; ``force_x`` to ``torque_z``, the force on a and the torque on a about the point of b. All are along the axes
    of a.
    """

    a: Side
    b: Side
    stiffness: Any = field(default=(0.0,) * 6, metadata={"unit": "N/m", "table": "BushingStiffness"})
    damping: Any = field(default=(0.0,) * 6, metadata={"unit": "N*s/m", "table": "BushingDamping"})

    kind = BUSHING

    @property
    def rotation_vector(self) -> tuple[str, ...]:
        matrices = [np.real(_matrix("", what, getattr(self, what))) for what in ("stiffness", "damping")]
        return ("rotation_x", "rotation_y", "rotation_z") if any(np.any(rows[:, 3:]) for rows in matrices) else ()

    def __post_init__(self) -> None:
        for what in ("stiffness", "damping"):
            _matrix(f"Bushing {self.name!r}", what, getattr(self, what))

    def lower(self, lowering: SpatialRows) -> None:
        owner = f"Bushing {self.name!r}"
        require_direction(owner, "a spring, or a rigid body", self.a, self.b)
        axes = lowering.pair(self.a, self.b, self.name).axes
        pair = lowering.pair(self.a, self.b, self.name, (np.eye(3), axes[1].T @ axes[0]))
        matrices = [_matrix(owner, what, getattr(self, what)) for what in ("stiffness", "damping")]
        laws = [matrix[i][j] for matrix in matrices for i, j in _ENTRIES]
        numbers = [*pair.data, *(pair.axes[0].T @ pair.separation).tolist(), *laws]
        lowering.add(BUSHING, pair.slots, numbers, pair.integers, self.name)


def _matrix(owner: str, what: str, given: Any) -> Sequence[Sequence[Number]]:
    """A symmetric matrix (6, 6), from its diagonal or whole."""
    array = array_of(given)
    if array.shape == (6,):
        array = np.diag(array)
    if array.shape != (6, 6) or np.abs(array - array.T).max() > 1e-9 * np.abs(array).max():
        raise InputError(f"{owner}: {what} is {shown(given)}; expected six numbers, or a symmetric matrix (6, 6)")
    least = _least_eigenvalue(np.real(array))
    if least < -_ROUNDING:
        raise InputError(
            f"{owner}: {what} is {shown(given)}; expected "
            + ("numbers that are not negative" if np.shape(given) == (6,) else "a positive semidefinite matrix")
            + f". Its smallest eigenvalue is {least:.3g} relative to its diagonal"
        )
    return array.tolist()


def _least_eigenvalue(matrix: np.ndarray) -> float:
    """Smallest eigenvalue of a matrix whose rows and columns are scaled to a diagonal of 1, -1 or 0.

    Scales keep the signs of the eigenvalues (Sylvester), and make N/m and N m/rad comparable. A zero on the diagonal is
    scaled by the largest entry of its row.
    """
    sizes = np.abs(np.diag(matrix))
    sizes = np.where(sizes > 0, sizes, np.abs(matrix).max(axis=1))
    scales = 1.0 / np.sqrt(np.where(sizes > 0, sizes, 1.0))
    return float(np.linalg.eigvalsh(scales[:, None] * matrix * scales)[0])
