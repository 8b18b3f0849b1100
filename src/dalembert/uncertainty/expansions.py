"""Second-order expansions of a response around all runs made so far: what they say about its extremes."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.spatial import KDTree

SWEEPS = 40
"""Passes over the coordinates when an expansion is maximised."""

CHUNK = 2_000_000
"""Numbers in the largest array of Hessians at once."""


@dataclass(frozen=True, eq=False)
class Expansions:
    """Runs at coordinates η in [−1, 1]^f, with their responses and gradients, all outputs at once.

    Parameters
    ----------
    points : array, shape (runs, f)
    values : array, shape (runs, outputs)
    slopes : array, shape (runs, outputs, f)
        By η.
    """

    points: np.ndarray
    values: np.ndarray
    slopes: np.ndarray

    def chunks(self) -> Iterator[np.ndarray]:
        """Numbers of outputs, so many at a time that their Hessians are no large array."""
        runs, outputs, f = self.slopes.shape
        size = max(1, CHUNK // (runs * f * f))
        return (np.arange(first, min(first + size, outputs)) for first in range(0, outputs, size))

    def curvatures(self, outputs: np.ndarray) -> np.ndarray:
        """Hessians by η, shape (runs, len(outputs), f, f), from the differences of gradients to the nearest runs.

        Least squares of H u = Δg/|Δη| over the unit vectors u to the neighbours, nearer ones weighing more; where there
        are too few, the smallest H that agrees.
        """
        runs, f = self.points.shape
        neighbours = min(runs - 1, 2 * f + 2)
        if neighbours == 0:
            return np.zeros((runs, len(outputs), f, f))
        nearest = KDTree(self.points).query(self.points, neighbours + 1)
        distance, near = map(np.asarray, nearest)
        hessians = np.empty((runs, len(outputs), f, f))
        i, j = np.triu_indices(f)
        for run in range(runs):
            others, apart = near[run, 1:], distance[run, 1:]
            weight = apart[0] / apart**2
            towards = (self.points[others] - self.points[run]) * weight[:, None]
            rows = np.zeros((neighbours, f, len(i)))
            rows[:, i, np.arange(len(i))] = towards[:, j]
            rows[:, j, np.arange(len(i))] = towards[:, i]
            change = (self.slopes[np.ix_(others, outputs)] - self.slopes[run, outputs]) * weight[:, None, None]
            right = np.moveaxis(change, 1, 2).reshape(neighbours * f, -1)
            entries = np.linalg.lstsq(rows.reshape(neighbours * f, -1), right, rcond=1e-8)[0]
            hessians[run][:, i, j] = entries.T
            hessians[run][:, j, i] = entries.T
        return hessians


def maxima(slope: np.ndarray, hessian: np.ndarray, lower: np.ndarray, upper: np.ndarray) -> np.ndarray:
    """Where g·u + u·H u/2 is largest in the boxes lower ≤ u ≤ upper, by one coordinate after the other.

    Parameters
    ----------
    slope : array, shape (n, f)
    hessian : array, shape (n, f, f)
    lower, upper : array, shape (n, f)

    Returns
    -------
    array, shape (n, f)
        A local maximum, from where the slope points.

    Examples
    --------
    >>> bowl = -np.array([[[2.0, 0.0], [0.0, 4.0]]])
    >>> maxima(np.array([[1.0, 8.0]]), bowl, -np.ones((1, 2)), np.ones((1, 2))).tolist()
    [[0.5, 1.0]]
    """
    u = np.zeros_like(slope)
    for _ in range(SWEEPS):
        before = u.copy()
        for k in range(u.shape[1]):
            curvature = hessian[:, k, k]
            rise = slope[:, k] + np.einsum("nj,nj->n", hessian[:, k], u) - curvature * u[:, k]
            low, high = lower[:, k], upper[:, k]
            ends = rise * (high - low) + curvature * (high**2 - low**2) / 2
            bent = curvature < 0
            peak = -rise / np.where(bent, curvature, 1.0)
            u[:, k] = np.where(
                bent, np.clip(peak, low, high), np.where(ends > 0, high, np.where(ends < 0, low, u[:, k]))
            )
        if np.max(np.abs(u - before), initial=0.0) < 1e-10:
            break
    return u


def expand(slope: np.ndarray, hessian: np.ndarray, u: np.ndarray) -> np.ndarray:
    """g·u + u·H u/2 for gradients (..., f), Hessians (..., f, f) and steps (..., f)."""
    return np.einsum("...i,...i->...", slope + np.einsum("...ij,...j->...i", hessian, u) / 2, u)
