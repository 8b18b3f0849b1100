"""Inertias of files: refused where no body can have them, or replaced by the nearest possible one."""

import numpy as np

from dalembert.errors import InputError, ModelError
from dalembert.multibody.components.spatial.inertia import Inertia
from dalembert.multibody.components.spatial.orientation import Vector
from dalembert.multibody.trees.omissions import Omission

REFUSE, REPLACE = TREATMENTS = "refuse", "replace"
_RADIUS = 1e-3
"""Least radius of gyration of a replaced inertia along a principal axis, m."""
_THIN = 1e-6
"""Radius of gyration of a point mass, or of a thin rod about its axis, m."""
_SHARE = 1e-6
"""Least second moment of a replaced inertia, relative to the largest one."""


def possible(
    mass: float, tensor: np.ndarray, centre: Vector, place: str, impossible: str, notes: list[Omission]
) -> Inertia | None:
    """Return the inertia of a link, from a tensor about its centre of mass (3, 3); None without mass and inertia. Point
    masses and thin bodies, whose second moments are zero along some axes, are imported with a small radius of gyration
    along these, and listed. An impossible inertia is refused, or replaced by the nearest possible one with the same
    principal axes: second moments along them, the eigenvalues of tr(J) / 2 - J, that are too small are raised.
    """
    if mass == 0.0 and not np.any(tensor):
        return None
    if mass <= 0.0:
        wrong = f"{place}: the mass is {mass:g} kg with an inertia tensor that is not zero"
        if impossible == REFUSE:
            raise ModelError(f"{wrong}; expected a positive mass. Correct it, or read with impossible='replace'")
        notes.append(Omission(f"{wrong}; the link is imported without mass", moves=True))
        return None
    second, axes = np.linalg.eigh(0.5 * np.trace(tensor) * np.eye(3) - tensor)
    thin = np.abs(second) < 0.5 * mass * _THIN**2
    if np.any(thin) and np.all(second[~thin] > 0.0):
        kind = "a point mass" if np.all(thin) else "a thin body"
        notes.append(Omission(f"{place}: {kind}, imported with a radius of gyration of {_THIN:g} m where it has none"))
        return Inertia.of(mass, _tensor(axes, np.maximum(second, mass * _THIN**2)), centre)
    try:
        return Inertia.of(mass, tensor, centre)
    except InputError as error:
        if impossible == REFUSE:
            raise ModelError(f"{place}: {error}, or read with impossible='replace'") from None
        replaced = _tensor(axes, np.maximum(second, max(_SHARE * second[2], 0.0) or mass * _RADIUS**2))
        change = np.abs(replaced - tensor).max()
        instead = f"Replaced by the nearest possible one, which differs by {change:.3g} kg m^2"
        notes.append(Omission(f"{place}: {error}. {instead}", moves=True))
        return Inertia.of(mass, replaced, centre)


def _tensor(axes: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Inertia tensor of these second moments along axes, the columns of a matrix."""
    own = axes @ np.diag(second) @ axes.T
    return np.trace(own) * np.eye(3) - own
