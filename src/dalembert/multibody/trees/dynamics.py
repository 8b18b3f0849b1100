"""Torques, mass matrices, regressors and positions of trees, for many samples at once.

Positions, velocities and accelerations have the shape (samples, dofs), in the order of ``tree.moving``. Joints that
follow another one move with it, and their torque acts on it by their factor. All functions take complex numbers, for
derivatives by the complex step.
"""

__all__ = ["Poses", "bias_forces", "inverse_dynamics", "mass_matrix", "poses", "regressor"]

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from dalembert.errors import InputError, shown
from dalembert.kernels.lanes import lane_zeros
from dalembert.multibody.components.fields import Number
from dalembert.multibody.trees import composite_bodies, frame_motion, newton_euler, torque_columns
from dalembert.multibody.trees.frames import (
    CONSTANT,
    COSINE,
    PLACE,
    SINE,
    SLIDE,
    WIDTH,
    ComplexFrames,
    FlatTree,
    flat,
    moved,
    pseudo_of,
    ten_of,
)  # fmt: skip
from dalembert.multibody.trees.parameters import heavy, parameter_names
from dalembert.multibody.trees.tree import JOINT_NUMBERS, Tree

GRAVITY = (0.0, 0.0, -9.81)
FEWEST_IN_LANES = 32  # samples: fewer of some microseconds each are not worth the kernels for eight at once
Samples = np.ndarray | Sequence[Sequence[Number]]


def inverse_dynamics(
    tree: Tree,
    q: Samples,
    v: Samples,
    a: Samples,
    gravity: Sequence[Number] = GRAVITY,
    *,
    friction: bool = True,
    armature: bool = True,
    slip: float | None = None,
) -> np.ndarray:
    """Torques (or forces) of the joints for a motion, by the recursive Newton-Euler algorithm.

    torque = M(q) a + b(q, v) + armature a + damping v + friction sign(v).

    Parameters
    ----------
    tree : Tree
    q, v, a : array, shape (samples, dofs)
        Positions (rad or m), velocities and accelerations, in the order of ``tree.moving``.
    gravity : (float, float, float)
        m/s^2, in the axes of the base.
    friction : bool
        Whether damping and Coulomb friction of the joints are included.
    armature : bool
        Whether the inertia of the motors is included.
    slip : float, optional
        Coulomb friction is friction x tanh(v / slip), rad/s or m/s; without it friction x sign(v).

    Returns
    -------
    array, shape (samples, dofs)
        N m or N.

    Raises
    ------
    InputError
        For arrays of other shapes or with entries that are not finite.

    Examples
    --------
    >>> from dalembert.multibody.spatial import Inertia
    >>> from dalembert.multibody.trees.tree import Link, Tree, TreeJoint
    >>> rod = Inertia(2.0, (0.1, 0.1, 0.01), centre=(0.5, 0.0, 0.0))
    >>> tree = Tree("pendulum", "base", (Link("rod", "base", TreeJoint("pin", axis=(0.0, 1.0, 0.0)), rod),))
    >>> inverse_dynamics(tree, [[0.0]], [[0.0]], [[0.0]]).round(6)  # 2 kg on a lever of 0.5 m, about -y
    array([[-9.81]])
    """
    own = flat(tree)
    q, v, a = _given(tree, q=q, v=v, a=a)
    q, v, a = _joints(own, q, v, a)
    dtype = np.result_type(own.frames.numbers, q, v, a, _gravity(gravity))
    torques = _filled(
        (newton_euler.fill_torques, newton_euler.fill_complex_torques, newton_euler.fill_torques_in_lanes),
        own, dtype, (_gravity(gravity), q, v, a), frame_motion.ROOM, q.shape,
    )  # fmt: skip
    damping, coulomb, inertia = np.array([[getattr(joint, name) for joint in own.joints] for name in JOINT_NUMBERS])
    if friction and damping.any():
        torques = torques + damping * v
    if friction and coulomb.any():
        torques = torques + coulomb * _signs(v, slip)
    if armature and inertia.any():
        torques = torques + inertia * a
    return torques if own.one_to_one else torques @ own.factors


def bias_forces(tree: Tree, q: Samples, v: Samples, gravity: Sequence[Number] = GRAVITY) -> np.ndarray:
    """Torques of a motion without acceleration, (samples, dofs): gravity, Coriolis and centrifugal forces.

    Friction is not included. Arguments and errors are those of :func:`inverse_dynamics`.
    """
    return inverse_dynamics(tree, q, v, np.zeros(np.shape(q)), gravity, friction=False)


def mass_matrix(tree: Tree, q: Samples, *, armature: bool = True) -> np.ndarray:
    """Mass matrices, by the composite-rigid-body algorithm.

    Parameters
    ----------
    tree : Tree
    q : array, shape (samples, dofs)
        Positions, rad or m, in the order of ``tree.moving``.
    armature : bool
        Whether the inertia of the motors is included.

    Returns
    -------
    array, shape (samples, dofs, dofs)

    Raises
    ------
    InputError
        For an array of another shape or with entries that are not finite.
    """
    own = flat(tree)
    (q,) = _joints(own, *_given(tree, q=q))
    masses = _filled(
        (composite_bodies.fill_masses, composite_bodies.fill_complex_masses, composite_bodies.fill_masses_in_lanes),
        own, np.result_type(own.frames.numbers, q), (q,), composite_bodies.ROOM, (len(q), q.shape[1] ** 2),
    ).reshape(*q.shape, q.shape[1])  # fmt: skip
    if armature:
        masses = masses + np.diag([joint.armature for joint in own.joints])
    return masses if own.one_to_one else own.factors.T @ masses @ own.factors


def regressor(
    tree: Tree, q: Samples, v: Samples, a: Samples, gravity: Sequence[Number] = GRAVITY, *, slip: float | None = None
) -> np.ndarray:
    """The matrices Y of a motion for which torque = Y @ parameters.

    The columns are in the order of :func:`parameter_names`; the parameters of a tree are :func:`parameters_of`. Links
    that hang rigidly on the base have columns of zeros.

    Parameters
    ----------
    tree, q, v, a, gravity, slip
        As in :func:`inverse_dynamics`.

    Returns
    -------
    array, shape (samples, dofs, parameters)

    Raises
    ------
    InputError
        For arrays of other shapes or with entries that are not finite.

    Examples
    --------
    >>> from dalembert.multibody.spatial import Inertia
    >>> from dalembert.multibody.trees.tree import Link, Tree, TreeJoint
    >>> rod = Inertia(2.0, (0.1, 0.1, 0.01), centre=(0.5, 0.0, 0.0))
    >>> tree = Tree("pendulum", "base", (Link("rod", "base", TreeJoint("pin", axis=(0.0, 1.0, 0.0)), rod),))
    >>> columns = regressor(tree, [[0.0]], [[0.0]], [[1.0]])
    >>> [name for name, entry in zip(parameter_names(tree), columns[0, 0]) if entry]
    ['rod.first_x', 'rod.second_yy', 'pin.armature']
    """
    own = flat(tree)
    q, v, a = _joints(own, *_given(tree, q=q, v=v, a=a))
    links, count = heavy(tree), len(own.joints)
    homes = {link.name: k for k, link in enumerate(tree.links)}
    slots = np.array([homes[link.name] for link in links], int)
    direct = np.array_equal(own.homes[slots], np.arange(1, count + 1)) and all(link.joint.moves for link in links)
    width = len(parameter_names(tree)) if direct else 10 * count
    columns = _filled(
        (torque_columns.fill_columns, torque_columns.fill_complex_columns, torque_columns.fill_columns_in_lanes), own,
        np.result_type(own.frames.numbers, q, v, a, _gravity(gravity)), (_gravity(gravity), q, v, a),
        torque_columns.ROOM, (*q.shape, width),
    )  # fmt: skip
    if not direct:
        columns = _by_links(own, slots, columns)
    for k in range(count):
        columns[:, k, 10 * len(links) + 3 * k : 10 * len(links) + 3 * k + 3] = np.stack(
            [v[:, k], _signs(v[:, k], slip), a[:, k]], axis=1
        )
    return columns if own.one_to_one else np.einsum("jd,sjc->sdc", own.factors, columns)


def _by_links(own: FlatTree, slots: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """Columns of links from those of the frames that they hang on, and workspace for those of the joints."""
    units = [pseudo_of(unit) for unit in np.eye(10)]
    samples, count = columns.shape[:2]
    every = np.zeros((samples, count, 10 * len(slots) + 3 * count), np.result_type(columns, own.places, own.axes))
    for place, slot in enumerate(slots):
        home = own.homes[slot]
        if home:
            turned = np.array([ten_of(moved(unit, own.places[slot], own.axes[slot])) for unit in units])
            every[:, :, 10 * place : 10 * place + 10] = columns[:, :, 10 * home - 10 : 10 * home] @ turned.T
    return every


class Poses(NamedTuple):
    """Positions and orientations of links in the axes of the base, in the order of ``tree.links``.

    Parameters
    ----------
    positions : array, shape (samples, links, 3)
        Of the origins of the links, m.
    rotations : array, shape (samples, links, 3, 3)
        Rotation matrices; their columns are the axes of the links.
    """

    positions: np.ndarray
    rotations: np.ndarray


def poses(tree: Tree, q: Samples) -> Poses:
    """Positions and orientations of all links.

    Parameters
    ----------
    tree : Tree
    q : array, shape (samples, dofs)
        Positions, rad or m, in the order of ``tree.moving``.

    Raises
    ------
    InputError
        For an array of another shape or with entries that are not finite.
    """
    own = flat(tree)
    (q,) = _joints(own, *_given(tree, q=q))
    turned, placed = [np.broadcast_to(np.eye(3), (len(q), 3, 3))], [np.zeros((len(q), 3))]
    for k, row in enumerate(own.frames.numbers.reshape(-1, WIDTH)):
        constant, cosine, sine = (row[i : i + 9].reshape(3, 3).T for i in (CONSTANT, COSINE, SINE))
        position, up = q[:, k, None], own.frames.parents[k]
        axes = constant + np.cos(position)[..., None] * cosine + np.sin(position)[..., None] * sine
        place = row[PLACE : PLACE + 3] + position * row[SLIDE : SLIDE + 3]
        placed.append(placed[up] + np.einsum("sij,sj->si", turned[up], place))
        turned.append(turned[up] @ axes)
    frames, origins = np.stack(turned, axis=1)[:, own.homes], np.stack(placed, axis=1)[:, own.homes]
    return Poses(origins + np.einsum("slij,lj->sli", frames, own.places), frames @ own.axes)


def _given(tree: Tree, **arrays: Any) -> list[np.ndarray]:
    """The arrays of samples, checked."""
    dofs, read = len(tree.moving), []
    for name, value in arrays.items():
        own = np.asarray(value)
        samples = len(read[0]) if read else "samples"
        wrong = own.ndim != 2 or own.shape[1] != dofs or own.dtype.kind not in "fciu"
        if wrong or (read and len(own) != samples):
            raise InputError(
                f"tree {tree.name!r}: {name} has the shape {own.shape}; expected numbers of the shape "
                f"({samples}, {dofs}), a column for each joint of tree.moving"
            )
        if not np.isfinite(own).all():
            row, column = np.argwhere(~np.isfinite(own))[0]
            raise InputError(
                f"tree {tree.name!r}: {name} of joint {tree.moving[column].name!r} is {own[row, column]} in "
                f"sample {row}; expected a finite number. Remove the sample"
            )
        read.append(own)
    return read


def _joints(own: FlatTree, q: np.ndarray, *rates: np.ndarray) -> list[np.ndarray]:
    """Positions and rates of all joints, those that follow another one included."""
    if own.one_to_one:
        return [q, *rates]
    return [q @ own.factors.T + own.offsets, *(rate @ own.factors.T for rate in rates)]


def _gravity(gravity: Sequence[Number]) -> np.ndarray:
    own = np.asarray(gravity)
    if own.shape != (3,) or own.dtype.kind not in "fciu":
        raise InputError(f"gravity is {shown(gravity)}; expected three numbers in m/s^2, such as (0, 0, -9.81)")
    return own


def _signs(v: np.ndarray, slip: float | None) -> np.ndarray:
    """Direction of Coulomb friction; its derivative is that of the smoothed one, or zero."""
    if slip is None:
        return np.sign(np.real(v))
    if not slip > 0.0:
        raise InputError(f"slip is {shown(slip)}; expected a positive rate in rad/s or m/s, or None for sign(v)")
    return np.tanh(v / slip)


def _filled(
    kernels: tuple[Any, Any, Any], own: FlatTree, dtype: Any, given: tuple, scratch: int, shape: tuple[int, ...]
) -> np.ndarray:
    """The array that the kernel of real or of complex numbers fills, or that of lanes for many samples."""
    is_complex = np.issubdtype(dtype, np.complexfloating)
    dtype, frames, count = (complex if is_complex else float), own.frames, len(own.joints)
    if is_complex:
        frames = ComplexFrames(frames.parents, frames.turns, frames.numbers.astype(complex))
    answer, entries = np.zeros(shape, dtype), (count + 1) * scratch
    arrays = tuple(np.ascontiguousarray(array, dtype) for array in given)
    if is_complex or shape[0] < FEWEST_IN_LANES:
        kernels[is_complex](frames, *arrays, np.zeros(entries, dtype), answer)
    else:
        # Behind the workspace of one sample: positions, velocities and accelerations, and what is filled of a sample.
        kernels[2](frames, *arrays, lane_zeros(entries + 3 * count + max(count * count, 10)), answer)
    return answer
