"""True runs of a function at points of the reference box, remembered."""

from collections.abc import Callable

import numpy as np

from dalembert.errors import InputError, SolveError
from dalembert.intervals import placed

# Points (n, d) to outputs (n, outputs); a row of NaN marks a run that failed.
Function = Callable[[np.ndarray], np.ndarray]


class Runs:
    """A function over its box, evaluated at coordinates η in [−1, 1]^f of the directions that have a width. ``lower``,
    ``upper`` (d,); ``on_runs``: called with the number of runs so far, after each batch.
    """

    def __init__(
        self, function: Function, lower: np.ndarray, upper: np.ndarray, on_runs: Callable[[int], None] | None = None
    ) -> None:
        self._function, self._on_runs = function, on_runs
        self.lower, self.upper = lower, upper
        self.free = np.flatnonzero(upper > lower)
        self._points: list[np.ndarray] = []
        self._values: list[np.ndarray] = []
        #: Least and largest outputs of the runs that succeeded, shape (2, outputs); None before the first of them.
        self.range: np.ndarray | None = None

    @property
    def directions(self) -> int:
        """Number f of directions with a width."""
        return len(self.free)

    @property
    def count(self) -> int:
        """Number of runs so far, failed ones included."""
        return sum(map(len, self._points))

    @property
    def points(self) -> np.ndarray:
        """All points so far, shape (runs, d)."""
        return np.concatenate([np.empty((0, len(self.lower))), *self._points])

    @property
    def values(self) -> np.ndarray:
        """Outputs of all runs so far, shape (runs, outputs)."""
        return np.concatenate(self._values)

    def place(self, eta: np.ndarray) -> np.ndarray:
        """Points (n, d) of coordinates (n, f)."""
        points = np.tile(self.lower, (len(eta), 1))
        points[:, self.free] = placed(self.lower[self.free], self.upper[self.free], eta)
        return points

    def __call__(self, eta: np.ndarray) -> np.ndarray:
        """Outputs (n, outputs) at coordinates (n, f)."""
        points = self.place(eta)
        values = np.asarray(self._function(points), dtype=float)
        outputs = self._values[0].shape[1] if self._values else "outputs"
        if values.ndim != 2 or len(values) != len(points) or outputs not in (values.shape[1], "outputs"):
            raise InputError(
                f"the function returned an array of shape {values.shape} for {len(points)} points; "
                f"expected ({len(points)}, {outputs})"
            )
        self._points.append(points)
        self._values.append(values)
        kept = values[~failed(values)]
        if len(kept):
            least, largest = kept.min(axis=0), kept.max(axis=0)
            low, high = (least, largest) if self.range is None else self.range
            self.range = np.array([np.minimum(low, least), np.maximum(high, largest)])
        if self._on_runs is not None:
            self._on_runs(self.count)
        return values

    def complete(self, eta: np.ndarray, kind: str) -> np.ndarray:
        """Outputs (n, outputs) at coordinates (n, f) for a surrogate of a kind that needs all of them."""
        values = self(eta)
        lost = failed(values)
        if lost.any():
            raise SolveError(
                f"{lost.sum()} of {len(values)} runs of {kind} surrogate failed, the first at the point "
                f"{self.place(eta[lost])[0].tolist()}; it needs all of them; keep the box away from where the model "
                "fails, or use TotalDegree, which can do without some"
            )
        return values


def failed(values: np.ndarray) -> np.ndarray:
    """Mask of the rows (n, outputs) of runs that failed, shape (n,)."""
    return ~np.all(np.isfinite(values), axis=1)
