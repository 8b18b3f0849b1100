"""Rigid motions of the bodies of a mechanism, and the smallest ones that change its constraints as wanted."""

from collections.abc import Sequence

import numpy as np

from dalembert.multibody.components.base_body import BaseBody
from dalembert.multibody.kernels.block_table import BlockModel
from dalembert.multibody.kernels.elementary import STEP
from dalembert.multibody.model.evaluate import changes_of_constraints, constraint_rates, residual
from dalembert.multibody.model.lowered import Lowered

CLOSED = 1e-13  # violation against the scale that counts as none


def coordinates_of(bodies: Sequence[BaseBody], frames: np.ndarray) -> list[np.ndarray]:
    """Coordinates of each undeformed body in its frame."""
    return [body.placed(frame) for body, frame in zip(bodies, frames, strict=True)]


def turning(bodies: Sequence[BaseBody]) -> np.ndarray:
    """Mask of the rates of frames that the bodies have, (bodies, rates): points do not turn."""
    dimension = bodies[0].dimension
    return np.array([[body.turns or rate < dimension for rate in range(len(body.FRAME))] for body in bodies])


def frames_after(bodies: Sequence[BaseBody], frames: np.ndarray, free: np.ndarray, step: np.ndarray) -> np.ndarray:
    """Frames after a step (free,) of the free ones of their rates, ``free`` (bodies, rates)."""
    steps = np.zeros(free.shape, dtype=np.result_type(frames, step))
    steps[free] = step
    return np.array([body.moved(frame, own) for body, frame, own in zip(bodies, frames, steps, strict=True)])


def unknowns(lowered: Lowered, coordinates: Sequence[np.ndarray]) -> np.ndarray:
    """All unknowns, without multipliers, (N + 1,)."""
    return np.concatenate([*coordinates, np.zeros(lowered.structure.size + 1 - lowered.structure.n)])


def modes_of(bodies: Sequence[BaseBody], coordinates: Sequence[np.ndarray], frames: np.ndarray) -> list[np.ndarray]:
    """Derivatives of the coordinates of each body by its frame, (size, rates)."""
    return [body.rigid_modes(own, frame) for body, own, frame in zip(bodies, coordinates, frames, strict=True)]


def spread(lowered: Lowered, bodies: Sequence[BaseBody], modes: Sequence[np.ndarray]) -> np.ndarray:
    """Derivatives of all coordinates by all frames, (n, bodies, rates)."""
    spread = np.zeros((lowered.structure.n, len(bodies), len(bodies[0].FRAME)), dtype=lowered.x.dtype)
    for number, (body, own) in enumerate(zip(bodies, modes, strict=True)):
        first = lowered.structure.first[body.name]
        spread[first : first + body.size, number] = own
    return spread


def size_of(values: np.ndarray) -> tuple[float, float]:
    """Largest entry, and the largest derivative."""
    if not np.iscomplexobj(values):
        return np.abs(values).max(initial=0.0), 0.0
    return np.abs(np.real(values)).max(initial=0.0), np.abs(np.imag(values)).max(initial=0.0) / STEP


def smallest(lowered: Lowered, model: BlockModel, x: np.ndarray, modes: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Return the smallest change of frames (free,), with ``modes`` (n, free), that changes the constraints as
    ``wanted`` (m,): J^T p with J J^T p = wanted, J the jacobian of the constraints by the frames. The kernels compute
    both products, so that in complex numbers the derivative of J counts, too; only the inverse is the real part's.
    """
    n = lowered.structure.n
    jacobian = changes_of_constraints(lowered, np.real(x), np.real(modes))
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
