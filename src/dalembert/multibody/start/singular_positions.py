"""Singular positions: where constraints that were independent at the start depend on each other."""

import numpy as np

from dalembert.errors import SolveError
from dalembert.multibody.model.evaluate import constraint_jacobian
from dalembert.multibody.model.lowered import Lowered, scales
from dalembert.multibody.start.assemble import redundancy

_NEAR = 1e-3  # of the smallest singular value at the start
_TAKES_PART = 0.1  # of the largest share of a constraint in the dependence
_LARGEST = 2000  # constraints or coordinates up to which the singular values are computed


def dependent_joints(lowered: Lowered, x: np.ndarray, t: float) -> tuple[str, ...]:
    """Return joints whose constraints have lost independence at the unknowns ``x`` (N + 1,); empty in a regular
    position. The Jacobian, in units of the coordinates' scales and with rows of length one, has a singular value that
    is small against that of the start; its left singular vector has the constraints that depend on each other.
    """
    structure = lowered.structure
    n, m = structure.n, structure.size - structure.n
    if m == 0 or max(n, m) > _LARGEST or not np.all(np.isfinite(x)):
        return ()
    rank = redundancy(lowered).rank
    (_, before), (vectors, now) = _decomposed(lowered, np.real(lowered.x), 0.0), _decomposed(lowered, x, t)
    if now[rank - 1] > _NEAR * before[rank - 1]:
        return ()
    shares = np.abs(vectors[:, rank - 1])
    return tuple(sorted({structure.owners[n + row] for row in np.flatnonzero(shares > _TAKES_PART * shares.max())}))


class SingularPositionError(SolveError):
    """A run that ended where constraints lost independence."""


def singular_position(lowered: Lowered, x: np.ndarray, t: float) -> SingularPositionError | None:
    """Return the error of a run that ended at a singular position; None in a regular one."""
    joints = dependent_joints(lowered, x, t)
    if not joints:
        return None
    return SingularPositionError(
        f"singular position: the joints {', '.join(map(repr, joints))} lose independence at t = {t:.6g} s, where "
        "their forces are not determined and the motion may branch. GeneralizedAlpha and RungeKutta4 pass such a "
        "position, if no step ends in it; or start from another one, or take a joint out"
    )


def _decomposed(lowered: Lowered, x: np.ndarray, t: float) -> tuple[np.ndarray, np.ndarray]:
    """Left singular vectors and singular values of the scaled Jacobian."""
    jacobian = constraint_jacobian(lowered, x, t).toarray() * scales(lowered)[: lowered.structure.n]
    jacobian /= np.linalg.norm(jacobian, axis=1, keepdims=True) + 1e-300
    vectors, values, _ = np.linalg.svd(jacobian, full_matrices=False)
    return vectors, values
