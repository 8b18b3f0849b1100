"""What particle swarms share: their state, one step of it, and the loop."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from dalembert.arguments import Checked, limited
from dalembert.intervals import corners
from dalembert.optimize.minimum import Minimum, Objective, OnIteration, Progress, misfits


@dataclass(frozen=True)
class SwarmState:
    """A swarm between two iterations: all that is needed to continue with the same bits.

    Each iteration draws from a separate generator, seeded with (seed, iteration), so no generator's inner state
    has to be kept.

    Parameters
    ----------
    seed, iteration, evaluations : int
        ``iteration`` counts evaluated swarms, the first random one included.
    lower, upper : array, shape (parameters,)
    positions, velocities : array, shape (particles, parameters)
    personal_best, personal_misfit : array, shape (particles, parameters), (particles,)
        Best position of each particle so far.
    quality, quality_misfit : array, shape (kept, parameters), (kept,)
        Good positions that the swarm remembers, best first; empty for swarms without such a memory.
    """

    seed: int
    iteration: int
    evaluations: int
    lower: np.ndarray
    upper: np.ndarray
    positions: np.ndarray
    velocities: np.ndarray
    personal_best: np.ndarray
    personal_misfit: np.ndarray
    quality: np.ndarray
    quality_misfit: np.ndarray

    @property
    def best(self) -> np.ndarray:
        """Best position of all, shape (parameters,)."""
        return self.personal_best[np.argmin(self.personal_misfit)]

    @property
    def best_misfit(self) -> float:
        return float(np.min(self.personal_misfit))


MOST_PARTICLES = 1_000_000  # a swarm of 1e9 would take the memory of the machine before it computes anything


@dataclass(frozen=True)
class Swarm(Checked, ABC):
    """Base of the swarms: a whole swarm is one batch, and ``advance`` is one iteration.

    Parameters
    ----------
    particles : int
    iterations : int
        Evaluated swarms, the first random one included, so a run costs particles × iterations evaluations.
    """

    name: ClassVar[str]
    """Name in study files; a subclass needs no other registration."""
    particles: int = limited(40, least=1, most=MOST_PARTICLES)
    iterations: int = limited(100, least=1)

    def start(
        self, objective: Objective, lower: ArrayLike, upper: ArrayLike, seed: int, start: ArrayLike | None = None
    ) -> SwarmState:
        """Scatter the particles evenly at random over the box, at random velocities, and evaluate them.

        Parameters
        ----------
        objective : callable
            Batch (particles, parameters) to misfit (particles,); NaN marks a failed sample.
        lower, upper : array, shape (parameters,)
        seed : int
        start : array, shape (parameters,), optional
            Where the first particle begins.
        """
        low, high = corners(lower, upper)
        rng = np.random.default_rng((seed, 0))
        positions = low + (high - low) * rng.random((self.particles, len(low)))
        if start is not None:
            positions[0] = np.clip(start, low, high)
        limit = self.velocity_bound(low, high)
        velocities = limit * (2 * rng.random(positions.shape) - 1)
        empty = np.empty((0, len(low)))
        misfit = misfits(objective, positions)
        quality = self.remember(empty, np.empty(0), positions, misfit)
        return SwarmState(seed, 1, len(positions), low, high, positions, velocities, positions, misfit, *quality)

    def advance(self, state: SwarmState, objective: Objective) -> SwarmState:
        """The state one iteration later."""
        # A generator for each iteration: a resumed swarm continues with the same bits from its state alone.
        rng = np.random.default_rng((state.seed, state.iteration))
        positions, velocities = self.move(state, rng)
        misfit = misfits(objective, positions)
        better = misfit < state.personal_misfit
        return SwarmState(
            state.seed,
            state.iteration + 1,
            state.evaluations + len(positions),
            state.lower,
            state.upper,
            positions,
            velocities,
            np.where(better[:, None], positions, state.personal_best),
            np.where(better, misfit, state.personal_misfit),
            *self.remember(state.quality, state.quality_misfit, positions, misfit),
        )

    def minimise(
        self,
        objective: Objective,
        lower: ArrayLike,
        upper: ArrayLike,
        seed: int,
        *,
        start: ArrayLike | None = None,
        on_iteration: OnIteration | None = None,
    ) -> Minimum:
        """Smallest misfit found in the box; parameters as in :meth:`start`.

        ``on_iteration`` is called with a :class:`Progress` after each evaluated swarm.
        """
        state = self.start(objective, lower, upper, seed, start)
        while True:
            if on_iteration is not None:
                on_iteration(Progress(state.iteration, state.evaluations, state.best_misfit, state.best))
            if state.iteration >= self.iterations:
                return self.end(state)
            state = self.advance(state, objective)

    def end(self, state: SwarmState) -> Minimum:
        """What a swarm found when it stops in this state."""
        success = bool(np.isfinite(state.best_misfit))
        message = f"all {state.iteration} iterations done" if success else "every sample of the swarm failed"
        return Minimum(state.best, state.best_misfit, success, message, state.iteration, state.evaluations)

    def steered(
        self, state: SwarmState, rng: np.random.Generator, inertia: tuple[float, float], c1: float, c2: float
    ) -> np.ndarray:
        """Velocities ωv + c1 r1 (personal best − x) + c2 r2 (best of all − x); ω falls linearly."""
        first, last = inertia
        # ω(t) = first + (last − first) t/iterations: Shi & Eberhart (1998), linear in the number of the iteration.
        kept = (first + (last - first) * state.iteration / self.iterations) * state.velocities
        x = state.positions
        return kept + pulled(rng, c1, state.personal_best, x) + pulled(rng, c2, state.best, x)

    @abstractmethod
    def velocity_bound(self, lower: np.ndarray, upper: np.ndarray) -> np.ndarray:
        """Largest speed a parameter, shape (parameters,); also the spread of the first velocities."""

    @abstractmethod
    def move(self, state: SwarmState, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
        """New positions and velocities, each (particles, parameters), inside their bounds."""

    def remember(
        self, kept: np.ndarray, kept_misfit: np.ndarray, positions: np.ndarray, misfit: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Good positions and their misfit after new ones were seen; a plain swarm remembers none."""
        return kept, kept_misfit


def pulled(rng: np.random.Generator, strength: float, towards: np.ndarray, positions: np.ndarray) -> np.ndarray:
    """The pull c·r·(target − x) with r evenly random in [0, 1] for each particle and parameter."""
    return strength * rng.random(positions.shape) * (towards - positions)
