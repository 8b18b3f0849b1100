"""The firefly algorithm with a memory of Zhang and Ding (2021)."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from dalembert.arguments import Checked, limited
from dalembert.intervals import corners
from dalembert.optimize.minimum import Minimum, Objective, OnIteration, Progress, misfits
from dalembert.optimize.swarm import MOST_PARTICLES


@dataclass(frozen=True)
class Firefly(Checked):
    """Firefly algorithm whose fireflies fly to the brightest one and remember how they flew.

    Every generation tries x ← x + η for each firefly, where η ← α η + β (brightest − x), β = β₀ exp(−γ Rᵛ) and R is the
    distance from the brightest. A firefly moves only where that lowers its misfit; η changes in any case.

    Parameters
    ----------
    fireflies : int
    absorption : float
        γ, of the light on its way.
    attraction : float
        β₀, at no distance.
    randomness : float
        α, in [0, 1), which weighs the memory η. The classical algorithm multiplies random numbers by it; here chance
        has a part in the first places alone.
    target : float
        Misfit below which the search ends.
    generations : int
        After which it ends.
    exponent : float
        ν, of the distance.
    resolution : float
        Share of the box's width below which two places count as one; 0 distinguishes all floating-point numbers.

    Notes
    -----
    Zhang & Ding, "Firefly algorithm for solving multibody dynamics differential-algebraic equations" (2021); the
    classical algorithm: Yang 2008. Distances are measured in widths of the box, so that units do not matter, and places
    are clipped to the box. After the first scatter nothing is random: a place that was refused is not
    computed again, and the search ends where no firefly has another place to try.

    Examples
    --------
    >>> import numpy as np
    >>> sphere = lambda points: np.sum((points - 0.3) ** 2, axis=1)
    >>> found = Firefly().minimise(sphere, [-1, -1], [1, 1], seed=1)
    >>> found.message, found.x.round(6).tolist()
    ('the misfit fell below the target of 1e-15', [0.3, 0.3])
    """

    fireflies: int = limited(60, least=1, most=MOST_PARTICLES)
    absorption: float = limited(1.0, least=0)
    attraction: float = limited(0.7, above=0)
    randomness: float = limited(0.7, least=0, below=1)
    target: float = limited(1e-15, least=0)
    generations: int = limited(1000, least=1)
    exponent: float = limited(2.0, above=0)
    resolution: float = limited(1e-10, least=0)

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
        """Smallest misfit found in the box.

        Parameters
        ----------
        objective : callable
            Batch (batch, parameters) to misfit (batch,), at most as many as there are fireflies; NaN marks a failed
            sample.
        lower, upper : array, shape (parameters,)
        seed : int
        start : array, shape (parameters,), optional
            Where the first firefly begins.
        on_iteration : callable, optional
            Called with a :class:`Progress` after each generation.
        """
        low, high = corners(lower, upper)
        width = high - low
        places = low + width * np.random.default_rng(seed).random((self.fireflies, len(low)))
        if start is not None:
            places[0] = np.clip(start, low, high)
        misfit = misfits(objective, places)
        memory, tried = np.zeros_like(places), places
        evaluations, generation = len(places), 1
        while True:
            brightest = int(np.argmin(misfit))
            best = float(misfit[brightest])
            if on_iteration is not None:
                on_iteration(Progress(generation, evaluations, best, places[brightest]))
            if best < self.target:
                message = f"the misfit fell below the target of {self.target:g}"
                break
            if generation >= self.generations:
                message = f"all {generation} generations done"
                break
            away = places[brightest] - places
            # η ← α η + β (brightest − x) of Zhang & Ding (2021). For the brightest one the second term is zero: it
            # flies on by its memory alone.
            memory = self.randomness * memory + self._pull(away / width) * away
            trial = np.clip(places + memory, low, high)
            # A place that the firefly tried before, or where it is, has a known misfit: the run ends where none is
            # fresh.
            fresh = self._apart(trial, places, width) & self._apart(trial, tried, width)
            tried = np.where(fresh[:, None], trial, tried)
            generation += 1
            if not fresh.any():
                message = f"no firefly moves any more after {generation} generations"
                break
            misfit_values = np.full(len(places), np.inf)
            misfit_values[fresh] = misfits(objective, trial[fresh])
            evaluations += int(fresh.sum())
            # Only downhill moves are taken, so the sequence of best values never rises.
            better = misfit_values < misfit
            places, misfit = np.where(better[:, None], trial, places), np.where(better, misfit_values, misfit)
        success = bool(np.isfinite(best))
        message = message if success else "every sample failed"
        return Minimum(places[brightest], best, success, message, generation, evaluations)

    def _apart(self, place: np.ndarray, other: np.ndarray, width: np.ndarray) -> np.ndarray:
        """Which places (fireflies, parameters) are not the same, (fireflies,)."""
        return np.any(np.abs(place - other) > self.resolution * width, axis=1)

    def _pull(self, away: np.ndarray) -> np.ndarray:
        """β of fireflies that are so far away, in widths of the box: (fireflies, parameters) to (fireflies, 1)."""
        # R² once, then (R²)^(ν/2) = Rᵛ: no root is taken for the usual ν = 2.
        square = np.sum(away**2, axis=1, keepdims=True)
        return self.attraction * np.exp(-self.absorption * square ** (self.exponent / 2))
