"""Direct optimisation of the model itself: every bound is taken by a run, and all outputs share all runs."""

from dataclasses import dataclass
from itertools import product
from typing import ClassVar

import numpy as np
import scipy

from dalembert.arguments import Checked, limited
from dalembert.findings import Finding
from dalembert.uncertainty.extreme_search import ExtremeSearch
from dalembert.uncertainty.method import MethodBounds
from dalembert.uncertainty.runs import Runs
from dalembert.uncertainty.unknown_error import share_of, unknown_error


@dataclass(frozen=True)
class Optimise(Checked):
    """Extremes by second-order steps from every run, with exact gradients of the model.

    Parameters
    ----------
    tolerance : float
        Stops when no run lets expect a gain above this part of the widest band of its channel.
    start : int, optional
        Points of a Latin hypercube to begin with, beside the middle of the box and of its faces and, for up to four
        intervals, its corners; 8 an interval if not given. More points see more of a response that swings within the
        box.
    most_runs : int
        Stops there with what was found; a response with its sensitivities counts as 1 + parameters.

    Notes
    -----
    Gradients of neighbouring runs give the curvature of every output at every run, and the values of these neighbours
    how wrong such an expansion is. Each run's expansion proposes where, within the distance of the first points, each
    output is smallest and largest; the expansion of the run that is nearest to that place says what is to be gained
    there, its own error in favour. A proposal that serves several outputs is run once. No search of this kind can prove
    that it has seen every peak: of random cubics in two parameters about one bound in a thousand is missed by 1e-5 of
    its width.
    """

    name: ClassVar[str] = "optimise"
    tolerance: float = limited(1e-6, above=0, below=1)
    start: int | None = limited(None, least=0)
    most_runs: int = 3000

    def most(self, runs: Runs) -> int | None:
        return None

    def bound(self, runs: Runs, seed: int) -> MethodBounds:
        design = self._design(runs, seed)
        # n points in a cube of side 2 lie about 2 n^(-1/f) apart: so far the expansion of a run is followed.
        search = ExtremeSearch(runs, self.tolerance, radius=2 * len(design) ** (-1 / max(1, len(runs.free))))
        search.run(design)
        if not search.extremes:
            raise runs.none_succeeded()
        gains, points = search.proposals()
        # A linearised run counts as 1 + parameters, since its gradient takes about as long as so many runs.
        while len(points) and (affordable := (self.most_runs - runs.count) // (1 + len(runs.box))) > 0:
            search.run(points[:affordable])
            gains, points = search.proposals()
        done, unknown = not len(points), self._unknown(runs, search, gains)
        return search.extremes.inner_bounds(self._outcome(done), unknown, success=done)

    def _outcome(self, done: bool) -> Finding:
        """Return whether the search came to its end."""
        taken = "Every bound is the response of a run of the model"
        if done:
            message = f"{taken}. Further runs are not expected to widen the bounds."
            return Finding("search-finished", "note", {}, message)
        message = f"{taken}, but the search stopped at most_runs = {self.most_runs} before it was finished."
        return Finding("search-stopped", "error", {"most_runs": self.most_runs}, message, "Increase most_runs.")

    def _unknown(self, runs: Runs, search: ExtremeSearch, gains: np.ndarray) -> Finding:
        """Return why the error is unknown: expansions around the runs see no more than these do."""
        extremes = search.extremes
        gain = share_of(gains, extremes.lower, extremes.upper)
        wider = "no wider bounds" if gain == 0 else f"bounds that are wider by {gain:.2g} of the width"
        reason = f"Expansions around the runs predict {wider}."
        points = runs.box.middle + np.zeros((len(search.tried), len(runs.box)))
        points[:, runs.free] += np.array(search.tried).reshape(len(points), -1) * runs.box.radius[runs.free]
        return unknown_error(runs, points, reason, {"expected gain": gain}, "Increase start to find narrower features.")

    def _design(self, runs: Runs, seed: int) -> np.ndarray:
        """First points η, shape (points, free intervals)."""
        f = len(runs.free)
        parts = [np.zeros((1, f))]
        if 0 < f <= 4:
            # Extremes of monotone responses are at corners; up to four intervals they are at most 16 runs.
            parts.append(np.array(list(product([-1.0, 1.0], repeat=f))))
        if f > 1:
            parts += [np.eye(f), -np.eye(f)]
        number = 8 * f if self.start is None else self.start
        if f and number:
            # Random permutations lower the discrepancy, so that no part of the box stays empty by chance.
            parts.append(2 * scipy.stats.qmc.LatinHypercube(f, optimization="random-cd", rng=seed).random(number) - 1)
        return np.concatenate(parts)
