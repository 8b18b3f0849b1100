"""Complex modes of linear systems with damping and gyroscopic terms, and the direction in which they whirl."""

from typing import NamedTuple, cast

import numpy as np
from scipy.linalg import eig

_NEUTRAL = 1e-7
"""Imaginary or real part of a root, against the largest magnitude, that rounding gives to a root of zero."""


class ComplexModes(NamedTuple):
    """Roots and shapes of M z'' + C z' + K z = 0, with z = phi exp(lambda t). ``roots`` (modes,): 1/s, with positive
    imaginary parts, in ascending order of these; ``shapes`` (freedoms, modes); ``growth``: largest real part of all
    roots, also of those that do not oscillate, 1/s; 0 if it is rounding.
    """

    roots: np.ndarray
    shapes: np.ndarray
    growth: float


def complex_modes(mass: np.ndarray, damping: np.ndarray, stiffness: np.ndarray) -> ComplexModes:
    """Return the oscillating modes of a system with any matrices, that of the mass regular. The state is (z, z'/s) with
    s = sqrt(|M^-1 K|) or |M^-1 C|: roots of zero are then rounded in proportion to the largest root, not its square.
    """
    size = len(mass)
    if size == 0:
        return ComplexModes(np.zeros(0, dtype=complex), np.zeros((0, 0), dtype=complex), 0.0)
    k, c = np.hsplit(np.linalg.solve(mass, np.hstack([stiffness, damping])), [size])
    s = max(float(np.sqrt(np.linalg.norm(k, 2))), float(np.linalg.norm(c, 2)), 1e-300)
    state_matrix = np.block([[np.zeros((size, size)), s * np.eye(size)], [-k / s, -c]])
    roots, vectors = cast(tuple[np.ndarray, np.ndarray], eig(state_matrix))
    largest = np.abs(roots).max()
    kept = np.flatnonzero(np.imag(roots) > _NEUTRAL * largest)
    kept = kept[np.argsort(np.imag(roots[kept]), kind="stable")]
    growth = float(np.real(roots).max())
    return ComplexModes(roots[kept], vectors[:size, kept], growth if growth > _NEUTRAL * largest else 0.0)


def whirl(shapes: np.ndarray, mass: np.ndarray, turn: np.ndarray) -> np.ndarray:
    """Return in which direction modes whirl, (modes,): 1 forward, -1 backward, 0 along a line. A shape that whirls
    forward on circles lags by a quarter of a turn behind itself turned by 90 degrees about the axis, J phi = i phi. So
    the direction is Im(phi^H M J phi) / (phi^H M phi), which weighs bodies by their inertia. ``shapes``
    (freedoms, modes): complex; ``mass``, ``turn`` (freedoms, freedoms): M and M J.
    """
    spin = np.imag(np.einsum("im,ij,jm->m", shapes.conj(), (turn - turn.T) / 2, shapes))
    size = np.real(np.einsum("im,ij,jm->m", shapes.conj(), mass, shapes))
    return np.clip(spin / np.where(size > 0.0, size, 1.0), -1.0, 1.0)
