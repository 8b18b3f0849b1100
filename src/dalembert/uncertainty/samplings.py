"""Methods that run the model at points chosen beforehand and keep the extremes: inner bounds."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from itertools import product
from typing import ClassVar

import numpy as np

from dalembert.arguments import Checked, limited
from dalembert.errors import InputError
from dalembert.findings import Finding
from dalembert.forward.folds import Fold
from dalembert.intervals import Box
from dalembert.latin_hypercube import latin_hypercube
from dalembert.uncertainty.method import Extremes, MethodBounds
from dalembert.uncertainty.runs import Runs
from dalembert.uncertainty.unknown_error import share_of, unknown_error

BATCH = 128  # runs between two events; enough to keep many cores busy
_NARROW = "They are too narrow, because few points lie near the corners of the box."
_FEWER = "Use 'optimise' or 'chebyshev', which need fewer runs."


class Sampling(Checked, ABC):
    """Extremes over chosen points. Their error is unknown; what the later part of them still widened is a finding."""

    name: ClassVar[str]
    message: ClassVar[str]
    advice: ClassVar[str] = ""

    @abstractmethod
    def size(self, box: Box) -> int:
        """Number of points."""

    @abstractmethod
    def points(self, box: Box, seed: int) -> tuple[np.ndarray, np.ndarray]:
        """Points (n, parameters) in two parts; the first may be empty."""

    def most(self, runs: Runs) -> int:
        return self.size(runs.box)

    def bound(self, runs: Runs, seed: int) -> MethodBounds:
        first, rest = self.points(runs.box, seed)
        # The extremes of the first part are a coarser answer. What the rest widened hints at the error.
        halfway = _extremes(runs, first, Extremes.none(runs))
        extremes = _extremes(runs, rest, halfway)
        if not extremes:
            raise runs.none_succeeded()
        points = np.concatenate([first, rest])
        outcome = Finding("sampled-bounds", "note", {"points": len(points)}, self.message, self.advice)
        return extremes.inner_bounds(outcome, self._unknown(runs, points, extremes, halfway))

    def _unknown(self, runs: Runs, points: np.ndarray, extremes: Extremes, halfway: Extremes) -> Finding:
        if not halfway:
            return unknown_error(runs, points, "No other runs test them.", {})
        widened = share_of(extremes.beyond(halfway), extremes.lower, extremes.upper)
        reason = f"The later part of the runs widened them by up to {widened:.2g} of the width."
        return unknown_error(runs, points, reason, {"widened": widened})


def _extremes(runs: Runs, points: np.ndarray, extremes: Extremes) -> Extremes:
    """Return the extremes with runs at more points (n, parameters)."""
    fold = Fold(runs.model, runs.method, points, extremes.arrays)
    for number, first in enumerate(range(0, len(points), BATCH)):
        batch = points[first : first + BATCH]
        # These runs are in a checkpoint: they count, but are not made again.
        if number < fold.done:
            runs.repeat(len(batch), fold.notes[number])
            continue
        with fold.batch():
            failed = len(runs.failures)
            values = runs.values(batch)
            kept = ~np.isnan(values[:, 0, 0])
            extremes = Extremes(*fold.state).with_runs(batch[kept], values[kept])
            fold.used(extremes.arrays, runs.failures[failed:])
    return Extremes(*fold.state)


class Grid(Sampling):
    """Runs on a grid of ``points_each`` evenly spaced points a parameter, the corners of the box among them."""

    instead: ClassVar[str]
    points_each: int
    most_runs: int

    def size(self, box: Box) -> int:
        wide = int(np.sum(box.lower < box.upper))
        number = self.points_each**wide
        if number > self.most_runs:
            raise InputError(
                f"method {self.name!r}: {self.points_each} points for each of {wide} intervals are {number} runs, more "
                f"than most_runs = {self.most_runs}; raise it, or use {self.instead}"
            )
        return number

    def points(self, box: Box, seed: int) -> tuple[np.ndarray, np.ndarray]:
        self.size(box)
        steps = [range(self.points_each) if wide else (0,) for wide in box.lower < box.upper]
        places = np.array(list(product(*steps)), dtype=float).reshape(-1, len(box))
        grid = box.points(2 * places / (self.points_each - 1) - 1)
        # Even places are a grid of twice the spacing, with both ends if there is an odd number of points.
        coarse = np.all(places % 2 == 0, axis=1) & (self.points_each % 2 == 1)
        return grid[coarse], grid[~coarse]


@dataclass(frozen=True)
class Vertex(Grid):
    """Runs at the 2^d corners of the box, exact where the response is monotone in each parameter.

    Parameters
    ----------
    most_runs : int
        More corners are refused.
    """

    name: ClassVar[str] = "vertex"
    message: ClassVar[str] = (
        "The bounds are the extremes over the corners of the box. They are exact where the response is monotone in "
        "each parameter, and can be too narrow elsewhere."
    )
    advice: ClassVar[str] = "Use the method 'optimise', which also finds extremes inside the box."
    instead: ClassVar[str] = "Taylor() or Optimise()"
    points_each: ClassVar[int] = 2
    most_runs: int = 65536


@dataclass(frozen=True)
class Scan(Grid):
    """Runs on a grid of evenly spaced points, the corners of the box among them.

    Parameters
    ----------
    points_each : int
        Points a parameter, at least 2. For an odd number, the difference from the grid of every other point is a
        finding.
    most_runs : int
        More grid points are refused.
    """

    name: ClassVar[str] = "scan"
    message: ClassVar[str] = (
        "The bounds are the extremes over the points of a grid. They are too narrow where the response peaks between "
        "them."
    )
    advice: ClassVar[str] = "Use 'optimise' to find peaks."
    instead: ClassVar[str] = "fewer points a parameter, or Optimise()"
    points_each: int = limited(21, least=2)
    most_runs: int = 1_000_000


@dataclass(frozen=True)
class Drawn(Sampling):
    """Runs at points drawn by chance, in halves: what the second half still widened is a finding."""

    runs: int = limited(least=2)

    def size(self, box: Box) -> int:
        return self.runs

    def points(self, box: Box, seed: int) -> tuple[np.ndarray, np.ndarray]:
        points = box.points(2 * self.shares(len(box), seed) - 1)
        return points[: self.runs // 2], points[self.runs // 2 :]

    @abstractmethod
    def shares(self, dimensions: int, seed: int) -> np.ndarray:
        """Points (runs, dimensions) of the unit cube."""


@dataclass(frozen=True)
class MonteCarlo(Drawn):
    """Runs at points drawn evenly from the box.

    Parameters
    ----------
    runs : int
        At least 2; by how much their second half still widened the bounds is a finding.
    """

    name: ClassVar[str] = "monte-carlo"
    message: ClassVar[str] = f"The bounds are the extremes over random points. {_NARROW}"
    advice: ClassVar[str] = _FEWER
    runs: int = limited(1000, least=2)

    def shares(self, dimensions: int, seed: int) -> np.ndarray:
        return np.random.default_rng(seed).random((self.runs, dimensions))


@dataclass(frozen=True)
class LatinHypercube(Drawn):
    """Runs at the points of a Latin hypercube: one in each of as many slices along every parameter.

    Parameters
    ----------
    runs : int
        At least 2; by how much their second half still widened the bounds is a finding.
    """

    name: ClassVar[str] = "latin-hypercube"
    message: ClassVar[str] = f"The bounds are the extremes over a Latin hypercube. {_NARROW}"
    advice: ClassVar[str] = _FEWER
    runs: int = limited(200, least=2)

    def shares(self, dimensions: int, seed: int) -> np.ndarray:
        return latin_hypercube(dimensions, self.runs, np.random.default_rng(seed))
