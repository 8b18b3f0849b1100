"""Second-order expansions of a response around all runs made so far: what they say about its extremes."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial import KDTree

SWEEPS = 40  # passes over the coordinates when an expansion is maximised
UNSEEN = 1e-10  # part of the largest spread of the neighbours below which a direction has none
CLOSE = 0.02  # distance of neighbours below which they say little about the error of an expansion
CHUNK = 2_000_000  # numbers in the largest array of Hessians at once


@dataclass(frozen=True, eq=False)
class Expansions:
    """Runs at coordinates η in [−1, 1]^f, with their responses and gradients, all outputs at once."""

    points: np.ndarray  # (runs, f)
    values: np.ndarray  # (runs, outputs)
    slopes: np.ndarray  # (runs, outputs, f): by η

    def chunks(self) -> Iterator[np.ndarray]:
        """Numbers of outputs, in parts whose Hessians are no large array."""
        runs, outputs, f = self.slopes.shape
        size = max(1, CHUNK // (runs * f * f))
        return (np.arange(first, min(first + size, outputs)) for first in range(0, outputs, size))

    def curvatures(self, outputs: np.ndarray) -> np.ndarray:
        """Return Hessians by η, shape (runs, len(outputs), f, f), from the differences of gradients to the nearest
        runs. The symmetric H of least Σ w² |H Δη − Δg|² over the neighbours, w = 1/|Δη|² so that nearer ones weigh
        more. It solves H S + S H = C + Cᵀ, S = Σ w² Δη Δηᵀ, C = Σ w² Δg Δηᵀ, in the eigenvectors of S; it is zero along
        those in which no neighbour lies.
        """
        runs, f = self.points.shape
        near, distance = self._neighbours
        if near.size == 0:
            return np.zeros((runs, len(outputs), f, f))
        # The weights are relative to the nearest neighbour. The factor cancels in H, and S keeps a moderate size.
        weight = (distance[:, :1] / distance**2)[..., None]
        towards = weight * (self.points[near] - self.points[:, None])
        slopes = self.slopes[:, outputs]
        changes = weight[..., None] * (slopes[near] - slopes[:, None])
        # S is symmetric and small, (f, f): its eigenvectors A turn the Lyapunov equation into f² scalar equations.
        spread, axes = np.linalg.eigh(np.einsum("rki,rkj->rij", towards, towards))
        # C A first, then Aᵀ C A: the sum over neighbours runs once, for all outputs of this part.
        mixed = np.einsum("rkoi,rkj->roij", changes, towards @ axes, optimize=True)
        mixed = axes.mT[:, None] @ mixed
        # In the eigenvectors (λ_i + λ_j) H_ij = (Aᵀ C A + its transpose)_ij.
        pairs = spread[:, :, None] + spread[:, None, :]
        # Along directions without a neighbour the sum vanishes. There the least H of all solutions has a zero.
        seen = pairs > UNSEEN * spread[:, -1, None, None]
        hessians = np.where(seen[:, None], (mixed + mixed.mT) / np.where(seen, pairs, 1.0)[:, None], 0.0)
        return axes[:, None] @ hessians @ axes.mT[:, None]

    def doubts(self, outputs: np.ndarray, hessians: np.ndarray) -> np.ndarray:
        """Largest error |Δη|⁻³ of each expansion at its neighbours, shape (runs, len(outputs)).

        Neighbours closer than ``CLOSE`` count as at this distance, where rounding would else be taken for an error.
        """
        near, distance = self._neighbours
        if near.size == 0:
            return np.zeros(hessians.shape[:2])
        values, slopes = self.values[:, outputs], self.slopes[:, outputs]
        # The first term that the expansion leaves out is of third order, so that its error counts relative to |Δη|³.
        steps = (self.points[near] - self.points[:, None])[:, :, None]
        foretold = values[:, None] + expand(slopes[:, None], hessians[:, None], steps)
        return np.max(np.abs(values[near] - foretold) / np.maximum(distance, CLOSE)[..., None] ** 3, axis=1)

    @cached_property
    def _neighbours(self) -> tuple[np.ndarray, np.ndarray]:
        """The runs nearest to each run, and their distances; both (runs, neighbours)."""
        runs, f = self.points.shape
        # H has f (f + 1)/2 unknowns and each neighbour gives f equations.
        # So 2 f + 2 neighbours, the run itself left out, have four times as many equations as unknowns.
        neighbours = KDTree(self.points).query(self.points, min(runs, 2 * f + 3))
        distance, near = (np.reshape(part, (runs, -1))[:, 1:] for part in neighbours)
        # Two runs at one point would give an infinite weight.
        return near, np.maximum(distance, np.finfo(float).eps)


def maxima(slope: np.ndarray, hessian: np.ndarray, lower: np.ndarray, upper: np.ndarray) -> np.ndarray:
    """Return where g·u + u·H u/2 is largest in the boxes lower ≤ u ≤ upper, (n, f): a local maximum, from where the
    slope points. ``slope``, ``lower``, ``upper`` (n, f): g and the ends of the boxes; ``hessian`` (n, f, f): H.
    """
    # Coordinate ascent: each pass solves f one-dimensional problems in closed form, for all boxes at once.
    # It never falls, and ends at a local maximum.
    u = np.zeros_like(slope)
    for _ in range(SWEEPS):
        before = u.copy()
        for k in range(u.shape[1]):
            curvature = hessian[:, k, k]
            # Slope of the expansion at u_k = 0, the others as they are.
            rise = slope[:, k] + np.einsum("nj,nj->n", hessian[:, k], u) - curvature * u[:, k]
            low, high = lower[:, k], upper[:, k]
            # Difference of the expansion between both ends. Where it bends upwards, one of them is largest.
            ends = rise * (high - low) + curvature * (high**2 - low**2) / 2
            bent = curvature < 0
            # Where it bends downwards, the zero of the slope, cut to the interval, is largest.
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
