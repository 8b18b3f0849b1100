"""Initial states that satisfy the joints: closed loops, consistent velocities, and refusal of redundant constraints.

Bodies are moved rigidly: an assembled mechanism is not strained. The unknowns are the frames of the bodies, position of
the placed point and angle; corrections are the smallest ones. In complex numbers each of Newton's steps is exact along
the complex step, so the derivatives are those of the positions that are found, also where the joints leave a choice.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple, cast

import numpy as np
from scipy.linalg import qr

from dalembert.errors import InputError, ModelError, unknown
from dalembert.multibody.components.planar.body import Body
from dalembert.multibody.evaluate import constraint_jacobian, constraint_rates, residual
from dalembert.multibody.kernels.dual import STEP
from dalembert.multibody.kernels.model import Model
from dalembert.multibody.lowering import Lowered, lower
from dalembert.multibody.system import System

_CLOSED = 1e-13  # violation against the scale that counts as none
_MOST_ITERATIONS = 60
_FRAME = {"x": 0, "y": 1, "angle": 2}


def assembled(system: System, tilted: bool = False, placed: Lowered | None = None) -> Lowered:
    """Arrays of a system whose joints are closed and whose velocities are consistent, at the start.

    A ``tilted`` system is treated in complex numbers even if only functions of the user's hold the imaginary step;
    ``placed`` are the arrays of the system as `lower` makes them, where they are there already.

    Raises
    ------
    ModelError
        Where the mechanism cannot be assembled, or its driving coordinates contradict its joints.
    """
    lowered = placed or lower(system)
    if lowered.structure.size == lowered.structure.n:
        return lowered
    model = lowered.real
    if lowered.is_complex or tilted:
        model = lowered.dual
        lowered = replace(
            lowered, **{name: getattr(lowered, name).astype(complex) for name in ("frames", "rates", "x", "v")}
        )
    free = _free(system)
    frames = _close(system.bodies, lowered, model, free)
    lowered = replace(lowered, frames=frames, x=_coordinates(system.bodies, lowered, frames))
    return replace(lowered, v=_consistent(system.bodies, lowered, model, free))


def scales(lowered: Lowered) -> np.ndarray:
    """Typical size of each unknown, (N + 1,): the mechanism's extent for positions, one for angles and gradients."""
    n, kinds = lowered.structure.n, np.array(lowered.structure.kinds)
    places = np.real(lowered.x)[:n][kinds == "position"].reshape(-1, 2)
    lengths = (np.real(data[:, kind.columns(kind.lengths)]) for kind, data in lowered.data.items())
    extent = max(np.ptp(places, axis=0).max(initial=0.0), *(np.abs(entry).max(initial=0.0) for entry in lengths))
    scale = np.ones(lowered.structure.size + 1)
    scale[:n][kinds == "position"] = extent if extent > 0 else 1.0
    return scale


def refuse_kinks(lowered: Lowered, end: float) -> None:
    """Raise where the velocity of a prescribed motion jumps within the motion.

    Raises
    ------
    ModelError
        With the joint and the time.
    """
    for time, joint in lowered.kinks:
        if 0 < time < end * (1 - 1e-9):
            raise ModelError(
                f"prescribed motion {joint!r}: its Table begins or ends at {time:g} s with a slope, within the motion "
                f"of {end:g} s, so its velocity would jump, which no mechanism can follow; give values for all of the "
                "motion, or let them come to rest"
            )


class Redundancy(NamedTuple):
    """How many constraints there are, how many of them are independent at the start, and joints of the others."""

    count: int
    rank: int
    joints: tuple[str, ...]


def redundancy(lowered: Lowered) -> Redundancy:
    """Which constraints follow from the others at the start."""
    structure = lowered.structure
    if structure.size == structure.n:
        return Redundancy(0, 0, ())
    jacobian = constraint_jacobian(lowered, np.real(lowered.x))
    dense = jacobian[:, np.unique(jacobian.indices)].toarray()
    dense /= np.linalg.norm(dense, axis=1, keepdims=True) + 1e-300
    decomposed = qr(dense.T, mode="economic", pivoting=True)
    _, triangle, order = cast(tuple[np.ndarray, np.ndarray, np.ndarray], decomposed)
    rank = int(np.sum(np.abs(np.diag(triangle)) > 1e-9))
    names = sorted({structure.owners[structure.n + row] for row in order[rank:]})
    return Redundancy(len(order), rank, tuple(names))


def refuse_redundancy(lowered: Lowered) -> None:
    """Raise where a constraint follows from the others.

    Raises
    ------
    ModelError
        With the joints whose constraints are redundant.
    """
    count, rank, names = redundancy(lowered)
    if rank < count:
        raise ModelError(
            f"the constraints are redundant: {count} were given, {rank} are independent at the start; "
            f"those of {', '.join(map(repr, names))} follow from the others. Take a joint out or replace one by a "
            "joint that holds less (a revolute joint instead of a fixed one), or start from a position that is not "
            "singular; RungeKutta4 and OdeSolver take redundant constraints as they are"
        )


def _free(system: System) -> np.ndarray:
    """Mask of the frame coordinates that assembly may change, (bodies, 3)."""
    names = [body.name for body in system.bodies]
    free = np.array([[True, True, body.turns] for body in system.bodies])
    for entry in system.driving:
        name, _, coordinate = entry.rpartition(".")
        if coordinate not in _FRAME:
            raise InputError(unknown("coordinate", coordinate, _FRAME, f"driving {entry!r}"))
        if name not in names:
            raise InputError(unknown("body", name, names, f"driving {entry!r}"))
        free[names.index(name), _FRAME[coordinate]] = False
    return free


def _coordinates(bodies: Sequence[Body], lowered: Lowered, frames: np.ndarray) -> np.ndarray:
    """Unknowns of undeformed bodies in their frames, (N + 1,)."""
    own = [body.coordinates(*frame) for body, frame in zip(bodies, frames, strict=True)]
    return np.concatenate([*own, np.zeros(lowered.structure.size + 1 - lowered.structure.n)])


def _modes(bodies: Sequence[Body], lowered: Lowered, frames: np.ndarray) -> np.ndarray:
    """Derivatives of the coordinates by the frames, (n, bodies, 3)."""
    modes = np.zeros((lowered.structure.n, len(bodies), 3), dtype=lowered.x.dtype)
    for number, (body, frame) in enumerate(zip(bodies, frames, strict=True)):
        first = lowered.structure.first[body.name]
        modes[first : first + body.size, number] = body.rigid_modes(body.coordinates(*frame), frame)
    return modes


def _size(values: np.ndarray) -> float:
    """Largest entry, derivatives included."""
    return max(np.abs(np.real(values)).max(initial=0.0), np.abs(np.imag(values)).max(initial=0.0) / STEP)


def _smallest(lowered: Lowered, model: Model, x: np.ndarray, modes: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Smallest change of frames (free,), with ``modes`` (n, free), that changes the constraints as ``wanted`` (m,).

    With J the jacobian of the constraints by the frames it is J^T p, J J^T p = wanted. Both products are taken from the
    kernels, so that in complex numbers the derivative of J counts, too; only the inverse is that of the real part.
    """
    n = lowered.structure.n
    jacobian = constraint_jacobian(lowered, np.real(x)) @ np.real(modes)
    inverse = np.linalg.pinv(jacobian, rcond=1e-10)
    if not np.iscomplexobj(x):
        return inverse @ wanted
    still, pushed = np.zeros_like(x), x.copy()
    at_rest, _ = constraint_rates(lowered, model, x, still, still)
    unloaded = residual(lowered, model, x, still, still)[:n]
    change = np.zeros(modes.shape[1], dtype=x.dtype)
    for _ in range(3):  # linear: once for the value, once for its derivative, once for rounding
        moving = np.concatenate([modes @ change, still[n:]])
        lacking = wanted - constraint_rates(lowered, model, x, moving, still)[0] + at_rest
        pushed[n:-1] += inverse.T @ (inverse @ lacking)
        change = (residual(lowered, model, pushed, still, still)[:n] - unloaded) @ modes
    return change


def _close(bodies: Sequence[Body], lowered: Lowered, model: Model, free: np.ndarray) -> np.ndarray:
    """Frames at which all joints are closed."""
    frames = lowered.frames
    still = np.zeros_like(lowered.x)
    tolerance = _CLOSED * scales(lowered).max()
    for _ in range(_MOST_ITERATIONS):
        x = _coordinates(bodies, lowered, frames)
        gaps = residual(lowered, model, x, still, still)[lowered.structure.n :]
        if _size(gaps) <= tolerance:
            return frames
        if not np.all(np.isfinite(gaps)):
            break
        step = _smallest(lowered, model, x, _modes(bodies, lowered, frames)[:, free], -gaps)
        longest = np.abs(np.real(step)).max(initial=0.0)
        if not np.isfinite(longest):
            break
        frames = frames.copy()
        frames[free] += step * min(1.0, 0.5 * scales(lowered).max() / (longest + 1e-300))
        if longest <= 1e-15 and _size(gaps) <= 1e3 * tolerance:
            return frames
    structure = lowered.structure
    for error in lowered.failures.inexact:
        raise error
    for error in lowered.failures.errors:
        raise ModelError(f"the joints cannot be placed at the start: {type(error).__name__}: {error}") from error
    gaps = residual(lowered, model, _coordinates(bodies, lowered, frames), still, still)[structure.n :]
    open_by = np.abs(np.real(gaps))
    worst = int(np.argmax(open_by))
    raise ModelError(
        f"the mechanism cannot be assembled: joint {structure.owners[structure.n + worst]!r} stays open by "
        f"{open_by[worst]:.3g} (m or rad). Check lengths and places of the bodies that it connects; a first "
        "placement nearer to the closed position may be needed, or fewer driving coordinates"
    )


def _consistent(bodies: Sequence[Body], lowered: Lowered, model: Model, free: np.ndarray) -> np.ndarray:
    """Velocities of rigid motions that satisfy the joints, nearest to the given ones."""
    n = lowered.structure.n
    tail = np.zeros(lowered.structure.size + 1 - n)
    modes = _modes(bodies, lowered, lowered.frames)
    rates = lowered.rates.astype(lowered.x.dtype)
    for _ in range(3):  # linear: once for the value, twice for rounding
        v = np.concatenate([np.tensordot(modes, rates, 2), tail])
        wrong, _ = constraint_rates(lowered, model, lowered.x, v, np.zeros_like(v))
        speed = max(np.abs(np.real(v)).max(initial=0.0), np.abs(np.real(wrong)).max(initial=0.0), 1.0)
        if _size(wrong) <= 10 * _CLOSED * speed:
            return v
        rates[free] += _smallest(lowered, model, lowered.x, modes[:, free], -wrong)
    remains = np.abs(np.real(wrong))
    worst = int(np.argmax(remains))
    if remains[worst] <= 1e-9 * speed:
        return v
    raise ModelError(
        f"no first velocities are consistent with the joints: at joint {lowered.structure.owners[n + worst]!r} "
        f"{remains[worst]:.3g} (m/s or rad/s) remain. Check the velocities of the driving coordinates and of the "
        "prescribed motions"
    )
