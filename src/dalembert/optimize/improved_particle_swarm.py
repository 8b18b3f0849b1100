"""The improved particle swarm of Guo & Jin (2025): three groups and a memory of good positions."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from dalembert.errors import InputError, require_known
from dalembert.optimize.swarm import Swarm, SwarmState, pulled

SPANS = ("bound", "width")


@dataclass(frozen=True)
class ImprovedParticleSwarm(Swarm):
    """Improved particle swarm, as published.

    All visited positions with a misfit below ``quality_misfit`` form the quality set, kept to the best
    ``quality_size``. With U the mean of a random 90 % of it, the groups move so:

    1. v ← ωv + c1 r1 (personal best − x) + c2 r2 (best of all − x) + c3 r3 (U − x), x ← x + v;
    2. with probability ½ v ← (x − best of all)·r·α, x ← x + v, else as group 1;
    3. with probability ½ x ← mean of a random 50 % of the quality set, else as group 1.

    ω = 0.8 − 0.7 t/iterations; velocities and positions are clipped.

    Parameters
    ----------
    particles, iterations : int
        A run costs particles × iterations evaluations.
    groups : (int, int, int), optional
        Particles a group; the published 30, 5, 5 for 40 particles, and an eighth each in groups 2 and 3 for others.
    c1, c2, c3 : float
        Weights of the steps towards the particle's best, the best of all, and the quality set.
    alpha : float
        Reach of group 2's jumps.
    inertia : (float, float)
        First value ω, and value after the last iteration; t is the number of the iteration.
    velocity_limit : float
        The published 1/100.
    span : {"bound", "width"}
        What the velocity limit is a fraction of.
    quality_misfit : float
        h; only better positions enter the quality set. It has the unit of the misfit.
    quality_size : int

    Notes
    -----
    The velocity limit is published as ±X_max/100. X_max is read as the largest position that a parameter can take,
    the larger absolute bound (``span="bound"``); ``span="width"`` reads it as upper − lower. Random numbers are drawn
    for each particle and parameter, the random parts of the quality set for each particle. While the quality set is
    empty, group 1 moves without its third term, and group 3 moves as group 1.

    Source: Guo & Jin, Inverse dynamical problem of flexible multibody systems with interval uncertainty, 2025.

    Examples
    --------
    >>> import numpy as np
    >>> sphere = lambda points: np.sum(points**2, axis=1)
    >>> found = ImprovedParticleSwarm(iterations=200).minimise(sphere, [-1, -1], [1, 1], seed=1)
    >>> bool(found.misfit < 1e-4)
    True
    """

    name: ClassVar[str] = "improved-swarm"
    groups: tuple[int, int, int] | None = None
    c1: float = 1.0
    c2: float = 1.0
    c3: float = 1.0
    alpha: float = 0.5
    inertia: tuple[float, float] = (0.8, 0.1)
    velocity_limit: float = 0.01
    span: str = "bound"
    quality_misfit: float = 0.1
    quality_size: int = 500

    def __post_init__(self) -> None:
        require_known("span", self.span, SPANS, "ImprovedParticleSwarm")
        if self.groups is not None and (sum(self.groups) != self.particles or min(self.groups) < 0):
            raise InputError(
                f"ImprovedParticleSwarm: groups {self.groups} hold {sum(self.groups)} particles; "
                f"expected three sizes that sum to particles = {self.particles}"
            )

    @property
    def sizes(self) -> tuple[int, int, int]:
        """Particles in each group."""
        eighth = self.particles // 8
        return self.groups or (self.particles - 2 * eighth, eighth, eighth)

    def velocity_bound(self, lower: np.ndarray, upper: np.ndarray) -> np.ndarray:
        reach = np.maximum(np.abs(lower), np.abs(upper)) if self.span == "bound" else upper - lower
        return self.velocity_limit * reach

    def move(self, state: SwarmState, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
        x = state.positions
        # All particles draw the numbers of group 1 first: the random stream does not depend on the sizes of the groups.
        velocities = self.steered(state, rng, self.inertia, self.c1, self.c2)
        if len(state.quality):
            # c3 r3 (U − x), U the mean of a random 90 % of the quality set, another 90 % for each particle.
            velocities += pulled(rng, self.c3, subset_means(rng, state.quality, 0.9, len(x)), x)

        group = np.repeat([1, 2, 3], self.sizes)
        # One draw decides for groups 2 and 3: a particle is in one of them only.
        special = rng.random(self.particles) < 0.5
        # Group 2 leaves the best position: v ← (x − best of all) r α keeps the diversity that groups 1 and 3 lose.
        jump = (special & (group == 2))[:, None]
        velocities = np.where(jump, (x - state.best) * rng.random(x.shape) * self.alpha, velocities)

        # The published limit applies to the jumps, too.
        limit = self.velocity_bound(state.lower, state.upper)
        velocities = np.clip(velocities, -limit, limit)
        positions = np.clip(x + velocities, state.lower, state.upper)
        if len(state.quality):
            # Group 3 moves to the mean of a random half of the quality set; its velocity stays that of the iteration
            # before.
            gather = (special & (group == 3))[:, None]
            positions = np.where(gather, subset_means(rng, state.quality, 0.5, len(x)), positions)
            velocities = np.where(gather, state.velocities, velocities)
        return positions, velocities

    def remember(
        self, kept: np.ndarray, kept_misfit: np.ndarray, positions: np.ndarray, misfit: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        good = misfit < self.quality_misfit
        misfit = np.concatenate([kept_misfit, misfit[good]])
        order = np.argsort(misfit, kind="stable")[: self.quality_size]
        return np.concatenate([kept, positions[good]])[order], misfit[order]


def subset_means(rng: np.random.Generator, rows: np.ndarray, fraction: float, count: int) -> np.ndarray:
    """Means of ``count`` random subsets of the rows, shape (count, columns), each of the given fraction of them."""
    # The smallest of random keys choose a subset without replacement, for all particles in one partial sort.
    size = max(1, round(fraction * len(rows)))
    chosen = np.argpartition(rng.random((count, len(rows))), size - 1, axis=1)[:, :size]
    return rows[chosen].mean(axis=1)
