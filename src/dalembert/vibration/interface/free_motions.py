"""Motions that a stiffness does not resist, and the degrees of freedom that move in them."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.sparse import csc_array, eye_array, issparse
from scipy.sparse.linalg import splu

from dalembert.errors import listed

FLOATING = 3e-14
"""Stiffness of a motion, as part of the largest, below which it is rounding."""
SOFT = 1e-12
"""Stiffness ε, as part of the largest, with which a stiffness that leaves motions free can be factorised."""
MOST_FREE = 24
"""Free motions of a sparse stiffness that are looked for: four bodies in space."""
RESISTED = 1e-11
"""Stiffness of elements along a motion, as part of the largest stiffness, up to which they do not resist it."""
FAST = 1e6
"""Stiffness, as part of the largest, that holds a motion where it is."""
MOVING = 1e-6
"""Part of the largest motion above which a degree of freedom is said to move."""
NAMED = 4
"""Degrees of freedom that a message names."""


def free_motions(stiffness: Any) -> np.ndarray:
    """Return the motions (l, motions) that a stiffness (l, l), or its diagonal (l,), does not resist: K φ = 0."""
    if stiffness.ndim == 1:
        return np.eye(len(stiffness))[:, np.abs(stiffness) <= FLOATING * np.abs(stiffness).max()]
    if not issparse(stiffness):
        return _unresisted(stiffness, np.eye(len(stiffness)))
    try:
        # A small pivot of LU shows a singular matrix; without one no subspace is needed, which costs more.
        pivots = np.abs(splu(csc_array(stiffness)).U.diagonal())
    except RuntimeError:  # a pivot is zero
        pivots = np.zeros(1)
    if pivots.min() > FLOATING * pivots.max():
        return np.zeros((stiffness.shape[0], 0))
    # Subspace iteration with (K + ε)⁻¹ converges to the motions of the smallest stiffness.
    nearly = splu(csc_array(stiffness + SOFT * (abs(stiffness).max() or 1.0) * eye_array(stiffness.shape[0])))
    basis = np.random.default_rng(0).standard_normal((stiffness.shape[0], min(MOST_FREE, stiffness.shape[0])))
    for _ in range(3):
        basis = np.linalg.qr(nearly.solve(basis))[0]
    return _unresisted(stiffness, basis)


def _unresisted(stiffness: Any, basis: np.ndarray) -> np.ndarray:
    """Of the motions of an orthonormal basis (l, motions), those that a stiffness does not resist."""
    values, shapes = np.linalg.eigh(basis.T @ (stiffness @ basis))
    return basis @ shapes[:, np.abs(values) <= FLOATING * (abs(stiffness).max() or 1.0)]


@dataclass(frozen=True)
class HeldByElements:
    """Mean motions that the structure does not resist, so that its elements alone may hold them. ``motions``
    (q, motions): of the retained coordinates; ``stiffness`` (motions, motions): by which the elements' mean forces
    change with them, N/m, where all contacts and stops are closed. Sliders, which remember, have none: their mean force
    does not depend on the mean position.
    """

    motions: np.ndarray
    stiffness: np.ndarray

    def unresisted(self, forces: np.ndarray, largest: float) -> np.ndarray:
        """Return the motions (q, motions) that no element resists either. ``forces`` (unknowns, motions): of the
        tangent under each motion; ``largest``: stiffness, N/m, of which those that are rounding are parts.
        """
        # Combinations of the free motions under which the elements answer with no force: right singular vectors of
        # value 0.
        _, sizes, shapes = np.linalg.svd(forces, full_matrices=False)
        return self.motions @ shapes[sizes <= RESISTED * largest].T

    def support(self, motions: np.ndarray, largest: float) -> np.ndarray:
        """Return a stiffness (q, q) that holds motions φ which no element resists. With the stiffness K of closed
        contacts, it is :math:`φ (φ^T K φ) φ^T`. Where the forces are in balance it does not act: of all mean positions
        the solution is the nearest one. Where a mean force is left, the mean position moves by what the closed contacts
        would yield, towards contact, and along sliders not.
        """
        among = self.motions.T @ motions
        closed, shapes = np.linalg.eigh(among.T @ self.stiffness @ among)
        motions = motions @ shapes
        return (motions * np.where(closed > RESISTED * largest, closed, FAST * largest)) @ motions.T


def moving_names(names: tuple[str, ...], motion: np.ndarray) -> str:
    """Names of the degrees of freedom that move in a motion (n,) of sizes."""
    moving = [repr(name) for name, size in zip(names, motion / motion.max(), strict=True) if size > MOVING]
    if len(moving) > NAMED:
        moving = [*moving[:NAMED], f"{len(moving) - NAMED} more degrees of freedom"]
    return listed(moving)
