"""Positions, frames and strains within beam elements in space, from the coordinates of their nodes, as arrays.

The formulas are those of :mod:`beam_element`, for many elements and times at once, in real or in complex numbers.
"""

import numpy as np

from dalembert.multibody.components.spatial.beam_shapes import Places, rule


def node_traces(nodes: np.ndarray) -> np.ndarray:
    """Cosine of the angle between each node and the middle one, (..., nodes), of nodes (..., nodes, 4, 3)."""
    middle = (nodes.shape[-3] - 1) // 2
    products = np.einsum("...kc,...nkc->...n", nodes[..., middle, 1:, :], nodes[..., 1:, :])
    return (products - 1.0) / 2.0


def lines(nodes: np.ndarray, places: Places) -> np.ndarray:
    """Positions (..., points, 3) of nodes (..., nodes, 4, 3)."""
    return np.einsum("pn,...nc->...pc", places.values, nodes[..., 0, :])


def frames(nodes: np.ndarray, places: Places) -> np.ndarray:
    """Directors (..., points, 3, 3), one in each row, of nodes (..., nodes, 4, 3)."""
    quaternions = _interpolated(_quaternions(nodes), places.values)
    scalar, vector = quaternions[..., :1, None], quaternions[..., 1:]
    cross = _skew(vector)
    # R(P) = 1 + 2/sigma (P0 [p] + [p]^2) turns the middle node's frame: d_k = R_lk m_l.
    turn = np.eye(3) + 2.0 / _square(quaternions)[..., None] * (scalar * cross + cross @ cross)
    return np.einsum("...plk,...lc->...pkc", turn, _middle(nodes)[..., 1:, :])


def strains(nodes: np.ndarray, places: Places, length: np.ndarray) -> np.ndarray:
    """Strains (..., points, 6) of nodes (..., nodes, 4, 3) of elements of this length (...), m: Gamma and K."""
    across = 2.0 / np.asarray(length)[..., None, None]
    quaternions = _quaternions(nodes)
    at, slope = _interpolated(quaternions, places.values), across * _interpolated(quaternions, places.slopes)
    (p0, p), (q0, q) = (at[..., :1], at[..., 1:]), (slope[..., :1], slope[..., 1:])
    line = across * np.einsum("pn,...nc->...pc", places.slopes, nodes[..., 0, :])
    rho = np.einsum("...kc,...pc->...pk", _middle(nodes)[..., 1:, :], line)
    once, twice = np.cross(rho, p), 2.0 / _square(at)
    gamma = rho + twice * (p0 * once + np.cross(once, p))
    return np.concatenate([gamma, twice * (p0 * q - q0 * p - np.cross(p, q))], axis=-1)


def element_strains(degree: int, x: np.ndarray, length: np.ndarray) -> np.ndarray:
    """Strains of elements, (elements, 6 degree), from their coordinates (elements, 12 (degree + 1)) and lengths, m."""
    nodes, places = x.reshape(len(x), degree + 1, 4, 3), Places.at(degree, np.array(rule(degree, degree).places))
    return strains(nodes, places, length).reshape(len(x), -1)


def _middle(nodes: np.ndarray) -> np.ndarray:
    return nodes[..., (nodes.shape[-3] - 1) // 2, :, :]


def _quaternions(nodes: np.ndarray) -> np.ndarray:
    """Quaternions of nodes relative to the middle one, (..., nodes, 4)."""
    t = np.einsum("...kc,...nlc->...nkl", _middle(nodes)[..., 1:, :], nodes[..., 1:, :])
    axis = np.stack([t[..., 2, 1] - t[..., 1, 2], t[..., 0, 2] - t[..., 2, 0], t[..., 1, 0] - t[..., 0, 1]], axis=-1)
    g = axis / (1.0 + np.trace(t, axis1=-2, axis2=-1))[..., None]
    quaternions = np.concatenate([np.ones_like(g[..., :1]), g], axis=-1)
    return quaternions / np.sqrt(_square(quaternions))


def _interpolated(quaternions: np.ndarray, weights: np.ndarray) -> np.ndarray:
    return np.einsum("pn,...nq->...pq", weights, quaternions)


def _square(numbers: np.ndarray) -> np.ndarray:
    """Sum of squares along the last axis, without conjugates, (..., 1)."""
    return np.sum(numbers * numbers, axis=-1, keepdims=True)


def _skew(vectors: np.ndarray) -> np.ndarray:
    """Matrices of cross products, (..., 3, 3)."""
    x, y, z = np.moveaxis(vectors, -1, 0)
    zero = 0.0 * x
    return np.stack([zero, -z, y, z, zero, -x, -y, x, zero], axis=-1).reshape(*vectors.shape[:-1], 3, 3)
