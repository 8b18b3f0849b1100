"""True runs of a function at points of the reference box, remembered."""

from collections.abc import Callable

import numpy as np

from dalembert.errors import InputError
from dalembert.intervals import placed

Function = Callable[[np.ndarray], np.ndarray]
"""Points (n, d) to outputs (n, outputs); a row of NaN marks a run that failed."""


class Runs:
    """A function over its box, asked at coordinates η in [−1, 1]^f of the directions that have a width.

    Parameters
    ----------
    function : Function
    lower, upper : array, shape (d,)
    on_runs : callable, optional
        Called with the number of runs so far, after each batch.
    """

    def __init__(
        self, function: Function, lower: np.ndarray, upper: np.ndarray, on_runs: Callable[[int], None] | None = None
    ) -> None:
        self._function, self._on_runs = function, on_runs
        self.lower, self.upper = lower, upper
        self.free = np.flatnonzero(upper > lower)
        self._points: list[np.ndarray] = []
        self._values: list[np.ndarray] = []
        self._range: np.ndarray | None = None

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

    @property
    def range(self) -> np.ndarray | None:
        """Least and largest outputs of the runs that succeeded, shape (2, outputs); None before the first of them."""
        return self._range

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
            now = np.array([kept.min(axis=0), kept.max(axis=0)])
            self._range = now if self._range is None else _joined(self._range, now)
        if self._on_runs is not None:
            self._on_runs(self.count)
        return values


def _joined(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.array([np.minimum(a[0], b[0]), np.maximum(a[1], b[1])])


def failed(values: np.ndarray) -> np.ndarray:
    """Mask of the rows (n, outputs) of runs that failed, shape (n,)."""
    return ~np.all(np.isfinite(values), axis=1)
