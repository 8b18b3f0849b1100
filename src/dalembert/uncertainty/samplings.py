"""Methods that run the model at points chosen beforehand and keep the extremes: inner bounds."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from itertools import product
from typing import ClassVar

import numpy as np

from dalembert.arguments import Checked, limited
from dalembert.errors import InputError
from dalembert.findings import Finding
from dalembert.intervals import Box
from dalembert.latin_hypercube import latin_hypercube
from dalembert.uncertainty.method import Extremes, MethodBounds
from dalembert.uncertainty.runs import Runs
from dalembert.uncertainty.unknown_error import share_of, unknown_error


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
        halfway = _extremes(runs, first, Extremes.none(runs))
        extremes = _extremes(runs, rest, halfway)
        if not extremes:
            raise runs.none_succeeded()
        return MethodBounds(
            "inner bound",
            extremes.lower,
            extremes.upper,
            extremes.at_lower,
            extremes.at_upper,
            None,
            Finding("sampled-bounds", "note", {"points": len(first) + len(rest)}, self.message, self.advice),
            not runs.failures,
            (self._unknown(runs, np.concatenate([first, rest]), extremes, halfway),),
        )

    def _unknown(self, runs: Runs, points: np.ndarray, extremes: Extremes, halfway: Extremes) -> Finding:
        if not halfway:
            return unknown_error(runs, points, "No other runs test them.", {})
        widened = share_of(extremes.beyond(halfway), extremes.lower, extremes.upper)
        reason = f"The later part of the runs widened them by up to {widened:.2g} of the width."
        return unknown_error(runs, points, reason, {"widened": widened})


def _extremes(runs: Runs, points: np.ndarray, extremes: Extremes) -> Extremes:
    for batch, values in runs.batches(points):
        extremes = extremes.with_runs(batch, values)
    return extremes


@dataclass(frozen=True)
class Vertex(Sampling):
    """Runs at the 2^d corners of the box, exact where the response is monotone in each parameter.

    Parameters
    ----------
    most_runs : int
        More corners are refused.
    """

    name: ClassVar[str] = "vertex"
    message: ClassVar[str] = (
        "The bounds are the extremes over the corners of the box. They are exact where the response is monotone in "
        "each parameter, and too narrow elsewhere."
    )
    advice: ClassVar[str] = "Use 'optimise' for extremes inside the box."
    most_runs: int = 65536

    def size(self, box: Box) -> int:
        return _grid_size(self.name, 2, box, self.most_runs, "Taylor() or Optimise()")

    def points(self, box: Box, seed: int) -> tuple[np.ndarray, np.ndarray]:
        self.size(box)
        corners = box.corners()
        return corners[:0], corners


@dataclass(frozen=True)
class Scan(Sampling):
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
    points_each: int = limited(21, least=2)
    most_runs: int = 1_000_000

    def size(self, box: Box) -> int:
        return _grid_size(self.name, self.points_each, box, self.most_runs, "fewer points a parameter, or Optimise()")

    def points(self, box: Box, seed: int) -> tuple[np.ndarray, np.ndarray]:
        self.size(box)
        steps = [range(self.points_each) if wide else (0,) for wide in box.lower < box.upper]
        places = np.array(list(product(*steps)), dtype=float).reshape(-1, len(box))
        grid = box.points(2 * places / (self.points_each - 1) - 1)
        coarse = np.all(places % 2 == 0, axis=1) & (self.points_each % 2 == 1)
        return grid[coarse], grid[~coarse]


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
    message: ClassVar[str] = (
        "The bounds are the extremes over random points. They are too narrow, because few points lie near the "
        "corners of the box."
    )
    advice: ClassVar[str] = "Use 'optimise' or 'chebyshev', which need fewer runs."
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
    message: ClassVar[str] = (
        "The bounds are the extremes over a Latin hypercube. They are too narrow, because few points lie near the "
        "corners of the box."
    )
    advice: ClassVar[str] = "Use 'optimise' or 'chebyshev', which need fewer runs."
    runs: int = limited(200, least=2)

    def shares(self, dimensions: int, seed: int) -> np.ndarray:
        return latin_hypercube(dimensions, self.runs, np.random.default_rng(seed))


def _grid_size(name: str, each: int, box: Box, most: int, instead: str) -> int:
    wide = int(np.sum(box.lower < box.upper))
    if each**wide > most:
        raise InputError(
            f"method {name!r}: {each} points for each of {wide} intervals are {each**wide} runs, more than "
            f"most_runs = {most}; raise it, or use {instead}"
        )
    return each**wide
