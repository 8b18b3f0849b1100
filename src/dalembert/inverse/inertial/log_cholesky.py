"""Log-Cholesky parameters of a link: ten numbers without bounds, each set of which is a body that can exist.

With axes in the order x, y, z, 1 the pseudo-inertia is U Uᵀ,

    U = e^a [[e^d1, s12, s13, t1], [0, e^d2, s23, t2], [0, 0, e^d3, t3], [0, 0, 0, 1]]

and the parameters are (a, d1, d2, d3, s12, s23, s13, t1, t2, t3).

Source: C. Rucker, P. M. Wensing, Smooth parameterization of rigid-body inertia, IEEE Robotics and Automation Letters 7
(2022).
"""

import numpy as np

from dalembert.inverse.inertial.pseudo_inertia import inertial_parameters, pseudo_inertia

ORDER = (1, 2, 3, 0)  # rows of the pseudo-inertia in the order x, y, z, 1
_BACK = (3, 0, 1, 2)
_ROWS, _COLUMNS = (0, 1, 2, 0, 1, 0, 0, 1, 2), (0, 1, 2, 1, 2, 2, 3, 3, 3)


def upper_factor(values: np.ndarray) -> np.ndarray:
    """Upper triangular factors U (..., 4, 4) of inertial parameters (..., 10), axes in the order x, y, z, 1."""
    turned = pseudo_inertia(values)[..., ORDER[::-1], :][..., :, ORDER[::-1]]
    return np.linalg.cholesky(turned)[..., ::-1, ::-1]


def parameters_of_factor(factor: np.ndarray) -> np.ndarray:
    """Inertial parameters (..., 10) of U Uᵀ, axes in the order x, y, z, 1."""
    return of_ordered(factor @ np.swapaxes(factor, -1, -2))


def of_ordered(pseudo: np.ndarray) -> np.ndarray:
    """Inertial parameters (..., 10) of pseudo-inertias with axes in the order x, y, z, 1."""
    return inertial_parameters(pseudo[..., _BACK, :][..., :, _BACK])


def log_cholesky(values: np.ndarray) -> np.ndarray:
    """Log-Cholesky parameters (..., 10) of inertial parameters (..., 10).

    >>> sphere = np.array([1.0, 0, 0, 0, 0.02, 0.02, 0.02, 0, 0, 0])
    >>> bool(np.allclose(log_cholesky(sphere), [0, *3 * [np.log(0.1)], 0, 0, 0, 0, 0, 0]))
    True
    """
    factor = upper_factor(values)
    last = factor[..., 3, 3]
    entries = (factor / last[..., None, None])[..., _ROWS, _COLUMNS]
    return np.concatenate([np.log(last)[..., None], np.log(entries[..., :3]), entries[..., 3:]], axis=-1)


def from_log_cholesky(logs: np.ndarray) -> np.ndarray:
    """Inertial parameters (..., 10) of log-Cholesky parameters (..., 10).

    >>> logs = np.linspace(-1.0, 1.0, 10)
    >>> bool(np.allclose(log_cholesky(from_log_cholesky(logs)), logs))
    True
    """
    return parameters_of_factor(_factor(np.asarray(logs)))


def log_cholesky_jacobian(logs: np.ndarray) -> np.ndarray:
    """Derivatives (10, 10) of the inertial parameters by the log-Cholesky parameters (10,)."""
    factor = _factor(np.asarray(logs))
    slopes = np.zeros((10, 4, 4), dtype=factor.dtype)
    slopes[0] = factor
    sizes = np.exp([logs[0] + logs[1], logs[0] + logs[2], logs[0] + logs[3], *6 * [logs[0]]])
    slopes[range(1, 10), _ROWS, _COLUMNS] = sizes
    half = slopes @ factor.T
    return of_ordered(half + np.swapaxes(half, -1, -2)).T


def _factor(logs: np.ndarray) -> np.ndarray:
    """Factor U (..., 4, 4) of log-Cholesky parameters (..., 10)."""
    factor = np.zeros((*logs.shape[:-1], 4, 4), dtype=logs.dtype)
    factor[..., _ROWS[:3], _COLUMNS[:3]] = np.exp(logs[..., 1:4])
    factor[..., _ROWS[3:], _COLUMNS[3:]] = logs[..., 4:]
    factor[..., 3, 3] = 1.0
    return np.exp(logs[..., :1])[..., None] * factor
