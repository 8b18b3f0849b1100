"""Stability of a state of rest: the stiffness against motions that the joints leave free."""

from typing import NamedTuple

import numpy as np
from scipy.linalg import eigh, null_space

from dalembert.multibody.model.evaluate import tangent
from dalembert.multibody.model.lowered import Lowered

_STIFF = 1e-9
"""Of the softest motion's compliance: below it a motion is too stiff to become unstable, and its sign is rounding."""
_NUDGE = 1e-15
"""Of the softest motion's stiffness, for one that is singular to the last bit."""


class Stability(NamedTuple):
    """Squares of the angular frequencies that the soft free motions would have, ascending, rad²/s², and these motions
    (n, count), of the symmetric part of the stiffness; the asymmetry of the stiffness, relative to its diagonal.
    """

    squares: np.ndarray
    motions: np.ndarray
    asymmetry: float

    @property
    def negatives(self) -> int:
        """Number of motions with a negative stiffness."""
        return int(np.sum(self.squares < 0.0))


def free_motions(matrix: np.ndarray, n: int, scale: np.ndarray) -> np.ndarray:
    """Return the motions (n, free) that the constraints leave free, by the tangent (N, N) and the size of each
    coordinate (n,).
    """
    return scale[:, None] * (null_space(matrix[n:, :n] * scale) if len(matrix) > n else np.eye(n))


def stability(lowered: Lowered, x: np.ndarray, scale: np.ndarray, softest: float = 0.0) -> Stability:
    """Return the stability of a state at rest ``x`` (N + 1,). ``scale`` (n,): size of each coordinate; ``softest``:
    compliance beside which motions count as stiff, s²; that of the softest motion here if zero.

    K x = w M x has errors in proportion to the largest w, which of slender beams is 1e13 times the smallest. With
    M = L L^T, the eigenvalues of the symmetric L^T K^-1 L are 1 / w, and those of soft motions are exact.
    """
    n, still = lowered.structure.n, np.zeros_like(x)
    full = tangent(lowered, x, still, (1.0, 0.0, 0.0)).toarray()
    mass = tangent(lowered, x, still, (0.0, 0.0, 1.0)).toarray()[:n, :n]
    free = free_motions(full, n, scale)
    stiffness, mass = free.T @ full[:n, :n] @ free, free.T @ mass @ free
    symmetric = (stiffness + stiffness.T) / 2
    sizes, axes = eigh((mass + mass.T) / 2)
    root = axes * np.sqrt(np.maximum(sizes, 0.0))  # motions without mass follow the others
    try:
        motions = np.linalg.solve(symmetric, root)
    except np.linalg.LinAlgError:
        motions = np.linalg.solve(symmetric + _NUDGE / (softest or 1.0) * mass, root)
    compliance = root.T @ motions
    values, vectors = eigh((compliance + compliance.T) / 2)
    soft = np.abs(values) > _STIFF * (softest or np.abs(values).max(initial=0.0))
    order = np.argsort(1.0 / values[soft])
    # In units of the diagonal: stretch and bending of slender beams differ by powers of ten.
    units = np.sqrt(np.maximum(np.abs(np.diagonal(stiffness)), 1e-14 * np.abs(stiffness).max(initial=0.0)) + 1e-300)
    skew = float(np.abs((stiffness - stiffness.T) / np.outer(units, units)).max(initial=0.0))
    return Stability(1.0 / values[soft][order], (free @ motions @ vectors)[:, soft][:, order], skew)
