"""Bushings in space: elastic bearings with stiffness and damping in six directions, which may be coupled."""

__all__ = ["Bushing"]

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from dalembert.arguments import is_number
from dalembert.errors import InputError, shown
from dalembert.kernels.kernel import inlined
from dalembert.kernels.views import stack
from dalembert.multibody.components.fields import Number
from dalembert.multibody.components.points import require_direction
from dalembert.multibody.components.spatial.kinds import pair_kind
from dalembert.multibody.components.spatial.load import Load
from dalembert.multibody.components.spatial.lowering import SpatialLowering
from dalembert.multibody.components.spatial.markers import SLOTS, axis_rate
from dalembert.multibody.components.spatial.pairs import (
    A_AXES,
    B_AXES,
    E,
    F,
    push_a_axis,
    push_b_axis,
    push_pair,
    separation,
    separation_rate,
)  # fmt: skip
from dalembert.multibody.components.spatial.points import Side
from dalembert.multibody.components.spatial.vectors import dot, times

_OTHERS = ((1, 2), (2, 0), (0, 1))
_ENTRIES = [(i, j) for i in range(6) for j in range(i, 6)]
_NUMBERS = tuple(f"{what}_{i + 1}{j + 1}" for what in ("stiffness", "damping") for i, j in _ENTRIES)
_PUSH_A, _PUSH_B = (tuple(push(number) for number in (1, 2, 3)) for push in (push_a_axis, push_b_axis))


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


def _rotation(i: int) -> tuple[Any, Any, Any]:
    """Rotation (e_k . f_j - e_j . f_k) / 2, about the axis i, its rate, and the torque that does work on it."""
    j, k = _OTHERS[i]
    ej, ek, fj, fk = E[j], E[k], F[j], F[k]
    aj, ak, bj, bk = A_AXES[j], A_AXES[k], B_AXES[j], B_AXES[k]
    push_ej, push_ek, push_fj, push_fk = _PUSH_A[j], _PUSH_A[k], _PUSH_B[j], _PUSH_B[k]

    @inlined
    def value(x, p, m):
        return 0.5 * (dot(ek(x, p, m), fj(x, p, m)) - dot(ej(x, p, m), fk(x, p, m)))

    @inlined
    def rate(x, v, p, m):
        first = dot(axis_rate(m.a_kind, 0, v, ak(p)), fj(x, p, m))
        first += dot(ek(x, p, m), axis_rate(m.b_kind, SLOTS, v, bj(p)))
        second = dot(axis_rate(m.a_kind, 0, v, aj(p)), fk(x, p, m))
        second += dot(ej(x, p, m), axis_rate(m.b_kind, SLOTS, v, bk(p)))
        return 0.5 * (first - second)

    @inlined
    def push(x, p, m, torque, r):
        half = 0.5 * torque
        push_ek(p, m, times(half, fj(x, p, m)), r)
        push_fj(p, m, times(half, ek(x, p, m)), r)
        push_ej(p, m, times(-half, fk(x, p, m)), r)
        push_fk(p, m, times(-half, ej(x, p, m)), r)

    return value, rate, push


(
    (_u1, _v1, _push1), (_u2, _v2, _push2), (_u3, _v3, _push3),
    (_u4, _v4, _push4), (_u5, _v5, _push5), (_u6, _v6, _push6),
) = (*map(_displacement, range(3)), *map(_rotation, range(3)))  # fmt: skip


@inlined
def _deflection(x, v, p, m, u, w):
    """Displacements and rotations of b relative to a along the axes of a, less those at the start, and their rates."""
    u[0], u[1], u[2] = _u1(x, p, m) - p.rest_x, _u2(x, p, m) - p.rest_y, _u3(x, p, m) - p.rest_z
    u[3], u[4], u[5] = _u4(x, p, m), _u5(x, p, m), _u6(x, p, m)
    w[0], w[1], w[2] = _v1(x, v, p, m), _v2(x, v, p, m), _v3(x, v, p, m)
    w[3], w[4], w[5] = _v4(x, v, p, m), _v5(x, v, p, m), _v6(x, v, p, m)


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
    """Forces and torques K u + D u' on a along its axes."""
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
    _push4(x, p, m, f[3], r)
    _push5(x, p, m, f[4], r)
    _push6(x, p, m, f[5], r)


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
        out[i], out[6 + i] = u[i], f[i]


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
)  # fmt: skip


@dataclass(frozen=True)
class Bushing(Load):
    """An elastic bearing between two markers, without force as the bodies are placed.

    The force and the torque on a along its axes are K u + D u', with the displacement of b relative to a and the
    rotation vector of b relative to a (the sine of the angle times the axis) in u; both start from zero. K and D are
    symmetric. The rotations should stay below about half a right angle.

    Parameters
    ----------
    name : str
    a, b : Point or ground
    stiffness : six float, or (6, 6) symmetric
        Along and about the axes x, y, z of a: N/m, then N m/rad.
    damping : six float, or (6, 6) symmetric
        N s/m, then N m s/rad.
    """

    a: Side
    b: Side
    stiffness: Any = field(default=(0.0,) * 6, metadata={"unit": "N/m", "table": "BushingStiffness"})
    damping: Any = field(default=(0.0,) * 6, metadata={"unit": "N*s/m", "table": "BushingDamping"})

    kind = BUSHING

    def __post_init__(self) -> None:
        for what in ("stiffness", "damping"):
            _matrix(f"Bushing {self.name!r}", what, getattr(self, what))

    def lower(self, lowering: SpatialLowering) -> None:
        owner = f"Bushing {self.name!r}"
        require_direction(owner, "a spring, or a rigid body", self.a, self.b)
        axes = lowering.pair(self.a, self.b, self.name).axes
        pair = lowering.pair(self.a, self.b, self.name, (np.eye(3), axes[1].T @ axes[0]))
        laws = [
            _matrix(owner, what, getattr(self, what))[i][j] for what in ("stiffness", "damping") for i, j in _ENTRIES
        ]
        numbers = [*pair.data, *(pair.axes[0].T @ pair.separation).tolist(), *laws]
        lowering.add(BUSHING, pair.slots, numbers, pair.integers, self.name)


def _matrix(owner: str, what: str, given: Any) -> Sequence[Sequence[Number]]:
    """A symmetric matrix (6, 6), from its diagonal or whole."""
    array = np.asarray(given)
    numbers = array.size and all(map(is_number, array.ravel().tolist()))
    if array.shape == (6,) and numbers:
        array = np.diag(array)
    if array.shape != (6, 6) or not numbers or np.abs(array - array.T).max() > 1e-9 * np.abs(array).max():
        raise InputError(f"{owner}: {what} is {shown(given)}; expected six numbers, or a symmetric matrix (6, 6)")
    return array.tolist()
