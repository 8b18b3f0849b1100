"""Surrogates on smaller and smaller boxes around the set of consistent parameters."""

from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import product

import numpy as np

from dalembert.data.record import TURN
from dalembert.inverse.events import Paved
from dalembert.inverse.problem.journal import Journal
from dalembert.inverse.problem.surrogates import surrogate_of
from dalembert.inverse.sets.paving import Limits, Paving, pave
from dalembert.surrogate import Surrogate
from dalembert.surrogate.scheme import Scheme

COARSE = 1 / 16  # resolution of the pavings that only look for a smaller box around the set
ZOOMS = 8  # most surrogates, each on the box that the one before leaves
SHRINKS = 0.7  # another one is made where a side of that box shrinks below this part
SLACK = 1e-9  # part of the paving's extent by which a point may lie outside of a box for rounding
CORNERS = 6  # parameters up to which all corners of a box are checked by runs of the model


@dataclass(frozen=True, eq=False)
class Nearest:
    """The run that violates the data least: its point (d,), and its largest difference in units of the error."""

    point: np.ndarray
    excess: float
    output: int


@dataclass(eq=False)
class Inversion:
    """Search for the parameters whose outputs differ from ``data`` by at most ``error``. The method `zoomed` makes the
    surrogates, `paved` divides a box into boxes inside, outside and at the boundary of the set, `consistent` and
    `outside` check the result by runs of the model itself.
    """

    # Returns the outputs (n, outputs) of runs of the model at points (n, d); NaN where a run failed. Points are search
    # coordinates: p/scale, or ln(p/lower) for parameters whose logarithm is searched (`SearchCoordinates`).
    run: Callable[[np.ndarray], np.ndarray]
    # data, error (outputs,): in the units of the channels. NaN among the data for what was not measured.
    data: np.ndarray
    error: np.ndarray
    wraps: np.ndarray  # (outputs,): whether an output is an angle in rad that is compared modulo 2π
    shape: tuple[int, int]  # samples and channels; outputs are samples × channels, flat
    scheme: Scheme  # which terms a surrogate has, and its tolerance
    most_boxes: int  # number of boxes after which a paving stops; the result then has the finding "paving-unfinished"
    seed: int  # all random numbers follow from it
    journal: Journal  # counts the runs and passes on events
    nearest: Nearest | None = field(default=None, init=False)  # the run so far that differs least from the data
    # The surrogate on the whole search box, which decides which parts of it are left out.
    first: Surrogate | None = field(default=None, init=False)
    # (d,): points of the runs that differ from the data by at most the error.
    members: list[np.ndarray] = field(default_factory=list, init=False)

    def zoomed(self, lower: np.ndarray, upper: np.ndarray) -> tuple[Surrogate, Paving]:
        """The last surrogate, on a box close around the set, and a coarse paving on it."""
        for left in reversed(range(ZOOMS)):
            surrogate = surrogate_of(
                self._seen, lower, upper, self.scheme, self.journal, shape=self.shape, seed=self.seed
            )
            self.first = self.first or surrogate
            paving = self.paved(surrogate, COARSE)
            if paving.hull is None or left == 0:
                break
            low, high = paving.hull
            if np.all(high - low > SHRINKS * (upper - lower)):
                break
            lower, upper = low, high
        return surrogate, paving

    def paved(self, surrogate: Surrogate, resolution: float) -> Paving:
        """Paving of the box of a surrogate."""
        limits = Limits(self.data, self.error, surrogate.error, self.wraps)
        return pave(
            surrogate.polynomial, limits, resolution, self.most_boxes, lambda *boxes: self.journal.tell(Paved(*boxes))
        )

    def consistent(self, box: np.ndarray) -> bool:
        """Return True if runs at the corners of a box (2, d) are consistent; at two opposite corners of many."""
        d = box.shape[1]
        choices = list(product((0, 1), repeat=d)) if d <= CORNERS else [(0,) * d, (1,) * d]
        corners = box[np.array(choices), np.arange(d)]
        return bool(np.all(self._excess(self._seen(corners)) <= 1))

    def outside(self, paving: Paving) -> np.ndarray:
        """Return the points (n, d) of consistent runs that a paving leaves out."""
        boxes = np.concatenate([paving.inside, paving.boundary])
        points = np.array(self.members).reshape(len(self.members), boxes.shape[2])
        slack = SLACK * np.ptp(boxes.reshape(-1, boxes.shape[2]), axis=0) if len(boxes) else 0.0
        inside = [bool(np.any(np.all((boxes[:, 0] - slack <= p) & (p <= boxes[:, 1] + slack), axis=1))) for p in points]
        return points[~np.array(inside, dtype=bool)]

    def _excess(self, values: np.ndarray) -> np.ndarray:
        """|values − data| in units of the error, both (n, outputs); infinite where a run failed."""
        apart = values - self.data
        apart -= np.where(self.wraps, TURN * np.rint(apart / TURN), 0.0)
        excess = np.where(np.isnan(self.data), 0.0, np.abs(apart) / self.error)
        return np.where(np.isnan(excess), np.inf, excess)

    def _seen(self, points: np.ndarray) -> np.ndarray:
        """Return the outputs of runs of the model, and keep the nearest run."""
        values = self.run(points)
        excess = self._excess(values)
        worst = excess.max(axis=1)
        best = int(np.argmin(worst))
        self.members.extend(points[worst <= 1])
        if self.nearest is None or worst[best] < self.nearest.excess:
            self.nearest = Nearest(points[best], float(worst[best]), int(np.argmax(excess[best])))
        return values
