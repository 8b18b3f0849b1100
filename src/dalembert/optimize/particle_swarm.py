"""The textbook global-best particle swarm."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from dalembert.arguments import limited
from dalembert.optimize.swarm import Swarm, SwarmState


@dataclass(frozen=True)
class ParticleSwarm(Swarm):
    """Standard particle swarm: v ← ωv + c1 r1 (personal best − x) + c2 r2 (best of all − x), x ← x + v.

    Parameters
    ----------
    particles, iterations : int
        A run costs particles × iterations evaluations.
    inertia : float or (float, float)
        ω, constant, or falling linearly from the first value to the second.
    c1, c2 : float
        Pull towards the particle's own best and towards the best of all.
    velocity_limit : float or None
        Largest step of a parameter as a fraction of the width of its bounds.

    Notes
    -----
    Kennedy & Eberhart 1995; falling inertia: Shi & Eberhart 1998. Positions are clipped to the bounds.

    Examples
    --------
    >>> import numpy as np
    >>> sphere = lambda points: np.sum(points**2, axis=1)
    >>> found = ParticleSwarm(particles=20, iterations=60).minimise(sphere, [-5, -5], [5, 4], seed=1)
    >>> found.evaluations, bool(found.misfit < 1e-4)
    (1200, True)
    """

    name: ClassVar[str] = "standard-swarm"
    inertia: float | tuple[float, float] = (0.9, 0.4)
    c1: float = 2.0
    c2: float = 2.0
    velocity_limit: float | None = limited(0.2, above=0)

    def velocity_bound(self, lower: np.ndarray, upper: np.ndarray) -> np.ndarray:
        return (upper - lower) * (1.0 if self.velocity_limit is None else self.velocity_limit)

    def move(self, state: SwarmState, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
        inertia = self.inertia if isinstance(self.inertia, tuple) else (self.inertia, self.inertia)
        velocities = self.steered(state, rng, inertia, self.c1, self.c2)
        if self.velocity_limit is not None:
            limit = self.velocity_bound(state.lower, state.upper)
            velocities = np.clip(velocities, -limit, limit)
        return np.clip(state.positions + velocities, state.lower, state.upper), velocities
