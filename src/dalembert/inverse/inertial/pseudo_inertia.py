"""The ten inertial parameters of a link and its pseudo-inertia.

The ten parameters are the mass m, the first moments h = m c (x, y, z), and the entries xx, yy, zz, xy, xz, yz of the
inertia tensor J about the origin of the link (J_xy = −∫ x y dm): kg, kg m and kg m^2. Torques are linear in them. The
pseudo-inertia P = [[m, hᵀ], [h, ½ tr(J) 1 − J]] is positive definite for every body that can exist
(Wensing, Kim and Slotine 2018).
"""

from collections.abc import Iterable

import numpy as np

ENTRIES = (
    "mass",
    "first_x",
    "first_y",
    "first_z",
    *(f"second_{pair}" for pair in ("xx", "yy", "zz", "xy", "xz", "yz")),
)
"""The ten inertial parameters, in their order."""

_ROWS, _COLUMNS = (0, 1, 2, 0, 0, 1), (0, 1, 2, 1, 2, 2)


def parameter_names(links: Iterable[str]) -> tuple[str, ...]:
    """Names of the inertial parameters of links, ten each.

    >>> parameter_names(["arm"])[:3]
    ('arm.mass', 'arm.first_x', 'arm.first_y')
    """
    return tuple(f"{link}.{entry}" for link in links for entry in ENTRIES)


def pseudo_inertia(values: np.ndarray) -> np.ndarray:
    """Pseudo-inertias (..., 4, 4) of inertial parameters (..., 10).

    Examples
    --------
    >>> sphere = np.array([5.0, 0, 0, 0, 0.02, 0.02, 0.02, 0, 0, 0])
    >>> pseudo_inertia(sphere).diagonal().round(12).tolist()
    [5.0, 0.01, 0.01, 0.01]
    """
    values = np.asarray(values)
    tensor = np.zeros((*values.shape[:-1], 3, 3), dtype=values.dtype)
    tensor[..., _ROWS, _COLUMNS] = tensor[..., _COLUMNS, _ROWS] = values[..., 4:]
    matrices = np.empty((*values.shape[:-1], 4, 4), dtype=values.dtype)
    matrices[..., 0, 0] = values[..., 0]
    matrices[..., 0, 1:] = matrices[..., 1:, 0] = values[..., 1:4]
    matrices[..., 1:, 1:] = _opposite(tensor, 0.5)
    return matrices


def inertial_parameters(pseudo: np.ndarray) -> np.ndarray:
    """Inertial parameters (..., 10) of symmetric pseudo-inertias (..., 4, 4).

    >>> values = np.arange(1.0, 11.0)
    >>> bool(np.allclose(inertial_parameters(pseudo_inertia(values)), values))
    True
    """
    tensor = _opposite(pseudo[..., 1:, 1:], 1.0)
    return np.concatenate([pseudo[..., 0, :], tensor[..., _ROWS, _COLUMNS]], axis=-1)


def smallest_eigenvalues(values: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """Smallest eigenvalues (links,) of pseudo-inertias relative to those of a reference: of P₀⁻¹ P.

    A link is physically consistent if its eigenvalue is positive. Both arguments are inertial parameters (links, 10).

    >>> body = np.array([[5.0, 0, 0, 0, 0.02, 0.02, 0.02, 0, 0, 0]])
    >>> smallest_eigenvalues(2 * body, body).round(12).tolist()
    [2.0]
    """
    factors = np.linalg.cholesky(pseudo_inertia(reference))
    half = np.linalg.solve(factors, pseudo_inertia(values))
    return np.linalg.eigvalsh(np.linalg.solve(factors, np.swapaxes(half, -1, -2)))[..., 0]


def bregman_distances(values: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """Log-det Bregman distances (links,) of pseudo-inertias P from a reference P₀.

    D = tr(P₀⁻¹ P) − log det(P₀⁻¹ P) − 4: zero where both are equal, infinite for a body that cannot exist, and the same
    in all frames and units. Both arguments are inertial parameters (links, 10).

    Source: T. Lee, P. M. Wensing, F. C. Park, Geometric robot dynamic identification: a convex programming approach,
    IEEE Transactions on Robotics 36 (2020).

    >>> body = np.array([[5.0, 0, 0, 0, 0.02, 0.02, 0.02, 0, 0, 0]])
    >>> bool(np.isclose(bregman_distances(2 * body, body)[0], 8 - 4 * np.log(2) - 4))
    True
    """
    ratio = np.linalg.solve(pseudo_inertia(reference), pseudo_inertia(values))
    sign, logarithm = np.linalg.slogdet(ratio)
    distances = np.trace(ratio, axis1=-2, axis2=-1) - logarithm - 4.0
    return np.where((sign > 0) & (smallest_eigenvalues(values, reference) > 0), distances, np.inf)


def _opposite(matrices: np.ndarray, factor: float) -> np.ndarray:
    """Return factor · trace · 1 − matrix, of matrices (..., 3, 3)."""
    return factor * np.trace(matrices, axis1=-2, axis2=-1)[..., None, None] * np.eye(3) - matrices
