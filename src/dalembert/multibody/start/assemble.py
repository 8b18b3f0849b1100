"""Initial states that satisfy the joints: closed loops, rest, consistent velocities; redundant constraints are refused.

Bodies are moved rigidly: an assembled mechanism is not strained. The unknowns are the frames of the bodies, position of
the placed point and angle; corrections are the smallest ones. In complex numbers each of Newton's steps is exact along
the complex step, so the derivatives are those of the positions that are found, also where the joints leave a choice.
"""

from collections.abc import Mapping, Sequence
from contextlib import suppress
from typing import Any, NamedTuple, cast

import numpy as np
from scipy.linalg import qr
from scipy.sparse import csc_matrix, csr_matrix, diags_array
from scipy.sparse.linalg import norm, splu

from dalembert.errors import ModelError, require_known
from dalembert.multibody.components.base_body import BaseBody
from dalembert.multibody.kernels.block_table import BlockModel
from dalembert.multibody.kernels.callbacks import AnswerError
from dalembert.multibody.kernels.elementary import STEP
from dalembert.multibody.model.evaluate import constraint_jacobian, residual
from dalembert.multibody.model.lowered import Lowered, scales
from dalembert.multibody.model.lowering import lower
from dalembert.multibody.model.rigid_motions import (
    CLOSED,
    coordinates_of,
    frames_after,
    modes_of,
    size_of,
    smallest,
    spread,
    turning,
    unknowns,
)
from dalembert.multibody.model.stated_state import closing, kept_coordinates, like, moving
from dalembert.multibody.model.system import EQUILIBRIUM, BaseSystem
from dalembert.multibody.start.equilibrium_start import begin_at_rest, unstable_body
from dalembert.multibody.start.initial_velocities import initial_velocities
from dalembert.multibody.start.lost_freedom import refuse_locked

_MOST_ITERATIONS = 60
_SWING = 0.5  # rad or m of a joint's coordinate that one step towards a stated value takes at most
_APART = 1e-6  # squared distance of a constraint's row, of length one, from the others at which it is independent


def assembled(
    system: BaseSystem, perturbed: bool = False, placed: Lowered | None = None, begin: float = 0.0
) -> Lowered:
    """Return arrays of a system whose joints are closed and whose velocities are consistent, at the time ``begin`` (s).
    A ``perturbed`` system is treated in complex numbers even if only functions of the user's hold the imaginary step.
    ``placed``: arrays of the system from `lower`, if they exist already.
    """
    lowered = placed or lower(system, begin)
    rests = system.start == EQUILIBRIUM
    if lowered.structure.size == lowered.structure.n:
        return begin_at_rest(lowered) if rests else lowered
    model = lowered.real
    if lowered.is_complex or perturbed:
        model = lowered.complex_model
        lowered = lowered.moved(
            **{name: getattr(lowered, name).astype(complex) for name in ("frames", "rates", "x", "v")}
        )
    bodies = tuple(lowered.bodies.values())
    turns = turning(bodies)
    free = _free(system, bodies, turns)
    start = lowered.x
    if system.stated.coordinates:
        lowered = _posed(system, bodies, lowered, model, free, begin)
    frames, x = _close(bodies, lowered, model, free)
    _refuse_misalignment(system, lowered, start, x)
    lowered = lowered.moved(frames=frames, x=x)
    lowered = begin_at_rest(lowered) if rests else lowered
    if not system.stated.rates:
        return lowered.moved(v=initial_velocities(bodies, turns, lowered, model))
    held = like(lower(moving(system, lowered), begin), lowered)
    try:
        rates = initial_velocities(bodies, turns, held, _model(held))
    except ModelError as error:
        raise ModelError(
            f"the joints cannot have the stated rates {system.stated.described('rates')}: {error}"
        ) from None
    velocities = np.zeros_like(lowered.x)
    velocities[: lowered.structure.n] = rates[: lowered.structure.n]
    return lowered.moved(v=velocities)


def _refuse_misalignment(system: BaseSystem, lowered: Lowered, placed: np.ndarray, closed: np.ndarray) -> None:
    """Raise where a joint is closed in another position than the one that is meant, such as with opposite axes."""
    for joint in system.joints:
        kind, row = lowered.structure.rows[joint.name]
        index, integers = lowered.structure.index[kind][row], lowered.structure.meta[kind][row]
        numbers, before, after = (np.real(own) for own in (lowered.data[kind][row], placed[index], closed[index]))
        problem = joint.misaligned(kind, numbers, integers, before, after)
        if problem:
            raise ModelError(
                f"the mechanism cannot be assembled from this placement: joint {joint.name!r} closes where {problem}. "
                "Place the bodies nearer to the closed position, or orient the markers alike"
            )


def start_key(system: BaseSystem, placed: Lowered) -> bytes:
    """Return what the initial state of a placed system follows from: systems with the same key start alike.

    Empty where functions of the user's, or an equilibrium or stated coordinates, may contribute more.
    """
    if system.start == EQUILIBRIUM or system.stated.coordinates or system.stated.rates or placed.callbacks:
        return b""
    joints = (data for kind, data in placed.data.items() if kind.constraint is not None)
    lengths = (data[:, kind.length_columns] for kind, data in placed.data.items())  # of which the extent follows
    signals = placed.signal_data, placed.knots
    arrays = (placed.x, placed.v, placed.frames, placed.rates, placed.stated, *signals, *joints, *lengths)
    return repr(system.driving).encode() + b"".join(array.tobytes() for array in arrays)


def moves_start(system: BaseSystem, placed: Lowered) -> bool:
    """Whether a complex step in the numbers of a placed system may change its initial state: if not, nothing is solved.

    Loads, stiffnesses and masses do not, unless the system starts at its equilibrium.
    """
    if system.start == EQUILIBRIUM or system.stated.coordinates or system.stated.rates:
        return True
    joints = [kind for kind in placed.data if kind.constraint is not None]
    arrays = (placed.x, placed.v, placed.frames, placed.rates, *(placed.data[kind] for kind in joints))
    if any(np.iscomplexobj(array) and np.any(np.imag(array)) for array in arrays):
        return True
    read = [placed.structure.meta[kind] for kind in joints if kind.integers]
    signals = np.unique(np.concatenate([integers.ravel() for integers in read])) if read else ()
    data = np.imag(placed.signal_data)
    rows = (placed.structure.signals[s] for s in signals if 0 < s < len(placed.structure.signals))
    return bool(placed.callbacks) or any(np.any(data[first : first + count]) for _, first, count, _ in rows)


def _posed(
    system: BaseSystem, bodies: Sequence[BaseBody], lowered: Lowered, model: BlockModel, free: np.ndarray, begin: float
) -> Lowered:
    """Arrays with frames where the joints have the stated coordinates, which are approached in small steps."""
    kept = kept_coordinates(system)
    placed = lowered
    _, gaps = _held(system, lowered, dict.fromkeys(kept, 0.0), placed, begin)
    with suppress(ModelError):  # joints that cannot be closed as placed may be closed where the coordinates are stated
        frames, x = _close(bodies, lowered, model, free)
        lowered = lowered.moved(frames=frames, x=x)
    held, begins = _held(system, lowered, {key: gaps[".".join(key)] for key in kept}, placed, begin)
    own, owners = _model(held), held.structure.owners[held.structure.n :]
    ways = np.array([begins.get(owner, 0.0) for owner in owners])
    steps = max(1, int(np.ceil(np.abs(np.real(ways)).max() / _SWING)))
    try:
        for step in range(1, steps + 1):
            frames, x = _close(bodies, held, own, free, (1 - step / steps) * ways)
            held = held.moved(frames=frames, x=x)
    except ModelError as error:
        raise ModelError(
            f"the joints cannot have the stated coordinates {system.stated.described('coordinates')}: {error}"
        ) from None
    return lowered.moved(frames=held.frames, x=like(lowered, held).x)


def _held(
    system: BaseSystem, lowered: Lowered, kept: Mapping[tuple[str, str], Any], placed: Lowered, begin: float
) -> tuple[Lowered, dict[str, Any]]:
    """Arrays with constraints of stated coordinates and of those kept as ``placed``, and by how much these are open."""
    closed, names = closing(system, kept, placed)
    held = like(lower(closed, begin), lowered)
    still, n = np.zeros_like(held.x), held.structure.n
    gaps = residual(held, _model(held), held.x, still, still)[n:]
    rows = held.structure.owners[n:]
    return held, {name: gaps[rows.index(name)] for name in names}


def _model(lowered: Lowered) -> BlockModel:
    return lowered.complex_model if np.iscomplexobj(lowered.x) else lowered.real


def refuse_kinks(lowered: Lowered, end: float) -> None:
    """Raise where the velocity of a prescribed motion jumps within the motion."""
    for time, joint in lowered.kinks:
        if 0 < time < end * (1 - 1e-9):
            raise ModelError(
                f"prescribed motion {joint!r}: its Table begins or ends at {time:g} s with a slope, within the motion "
                f"of {end:g} s, so its velocity would jump, which no mechanism can follow; give values for all of the "
                "motion, or let them come to rest"
            )


def refuse_unstable_start(system: BaseSystem, lowered: Lowered) -> None:
    """Raise where a system that starts at its equilibrium would fall away from it."""
    body = unstable_body(lowered) if system.start == EQUILIBRIUM else None
    if body is not None:
        raise ModelError(
            f"the equilibrium at the start is unstable: {body!r} falls away from it, as an inverted pendulum does. "
            "Place the bodies nearer to the equilibrium that is meant"
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
    if _is_regular(jacobian):
        return Redundancy(structure.size - structure.n, structure.size - structure.n, ())
    dense = jacobian[:, np.unique(jacobian.indices)].toarray()
    dense /= np.linalg.norm(dense, axis=1, keepdims=True) + 1e-300
    decomposed = qr(dense.T, mode="economic", pivoting=True)
    _, triangle, order = cast(tuple[np.ndarray, np.ndarray, np.ndarray], decomposed)
    rank = int(np.sum(np.abs(np.diag(triangle)) > 1e-9))
    names = sorted({structure.owners[structure.n + row] for row in order[rank:]})
    return Redundancy(len(order), rank, tuple(names))


def inner_constraints(lowered: Lowered) -> int:
    """Number of constraints inside of bodies, such as those between the axes of a rigid body in space."""
    structure = lowered.structure
    return sum(owner in lowered.bodies for owner in structure.owners[structure.n : structure.size])


def _is_regular(jacobian: csr_matrix) -> bool:
    """Whether the rows are independent beyond doubt: by the squared distances of each from those before it.

    They are the pivots of an elimination of J J^T for rows of length one, in proportion to the length of a chain.
    """
    rows = diags_array(1.0 / (norm(jacobian, axis=1) + 1e-300)) @ jacobian
    try:
        symmetric = {"SymmetricMode": True}
        factors = splu(csc_matrix(rows @ rows.T), "MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=symmetric)
    except RuntimeError:  # exactly singular
        return False
    return bool(np.all(factors.U.diagonal() > _APART))


def refuse_redundancy(lowered: Lowered) -> None:
    """Raise where a constraint follows from the others."""
    count, rank, names = redundancy(lowered)
    if rank < count:
        refuse_locked(lowered)
        inside = inner_constraints(lowered)
        followers = ", ".join(map(repr, names))
        raise ModelError(
            f"the constraints are redundant: {count - inside} were given, {rank - inside} are independent at the "
            f"start; those of {followers} follow from the others. Take a joint out or replace one by a "
            "joint that holds less (a revolute joint instead of a fixed one), or start from a position that is not "
            "singular; RungeKutta4 and OdeSolver take redundant constraints as they are"
        )


def _free(system: BaseSystem, bodies: Sequence[BaseBody], turns: np.ndarray) -> np.ndarray:
    """Mask of the frame coordinates that assembly may change, (bodies, rates)."""
    names = [body.name for body in bodies]
    free = turns.copy()
    for entry in system.driving:
        name, _, coordinate = entry.rpartition(".")
        known = bodies[0].FRAME
        require_known("coordinate", coordinate, known, f"driving {entry!r}")
        require_known("body", name, names, f"driving {entry!r}")
        free[names.index(name), known.index(coordinate)] = False
    return free


def _close(
    bodies: Sequence[BaseBody],
    lowered: Lowered,
    model: BlockModel,
    free: np.ndarray,
    open_by: np.ndarray | float = 0.0,
) -> tuple[np.ndarray, np.ndarray]:
    """Frames at which all joints are closed, and the unknowns there; constraints are open by the given values (m,)."""
    frames = lowered.frames
    still = np.zeros_like(lowered.x)
    extent = scales(lowered).max()
    for _ in range(_MOST_ITERATIONS):
        coordinates = coordinates_of(bodies, frames)
        x = unknowns(lowered, coordinates)
        gaps = residual(lowered, model, x, still, still)[lowered.structure.n :] - open_by
        (gap, slope), moved = size_of(gaps), max(1.0, size_of(x)[1])
        closed = max(gap, slope / moved) / extent  # derivatives are rounded in proportion to their size
        if closed <= CLOSED:
            return frames, x
        if not np.all(np.isfinite(gaps)):
            break
        modes = spread(lowered, bodies, modes_of(bodies, coordinates, frames))
        step = smallest(lowered, model, x, modes[:, free], -gaps)
        longest = np.abs(np.real(step)).max(initial=0.0)
        if not np.isfinite(longest):
            break
        # A power of two does not depend on parameters, so derivatives stay exact where steps are shortened.
        share = np.exp2(np.floor(np.log2(min(1.0, 0.5 * extent / (longest + 1e-300)))))
        frames = frames_after(bodies, frames, free, share * step)
        if longest <= 1e-15 and closed <= 1e3 * CLOSED:
            return frames, unknowns(lowered, coordinates_of(bodies, frames))
    structure = lowered.structure
    for error in lowered.failures.inexact:
        raise error
    for error in lowered.failures.errors:
        cause = str(error) if isinstance(error, AnswerError) else f"{type(error).__name__}: {error}"
        raise ModelError(f"the joints cannot be placed at the start: {cause}") from error
    x = unknowns(lowered, coordinates_of(bodies, frames))
    gaps = residual(lowered, model, x, still, still)[structure.n :] - open_by
    wide, slope = np.abs(np.real(gaps)), np.abs(np.imag(gaps)) / STEP
    if wide.max() <= CLOSED * extent:
        raise ModelError(
            f"joint {structure.owners[structure.n + int(np.argmax(slope))]!r} is closed, but not for other values of a "
            "parameter, so there is no derivative: the position is singular, or the joint is redundant. Start from "
            "another position, take the joint out, or let the placement depend on the parameter"
        )
    worst = int(np.argmax(wide))
    raise ModelError(
        f"the mechanism cannot be assembled: joint {structure.owners[structure.n + worst]!r} has a gap of "
        f"{wide[worst]:.3g} (m or rad). Check lengths and places of the bodies that it connects; a first "
        "placement nearer to the closed position may be needed, or fewer driving coordinates"
    )
