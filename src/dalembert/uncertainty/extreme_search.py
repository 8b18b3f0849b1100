"""The search for extremes of all outputs at once: where the runs so far let expect more."""

from dataclasses import dataclass, field

import numpy as np
from scipy.spatial import KDTree

from dalembert.forward import prefetched
from dalembert.uncertainty.expansions import Expansions, expand, maxima
from dalembert.uncertainty.method import Extremes
from dalembert.uncertainty.runs import Runs

COVERED = 0.8  # part of an output's expected gain that a point proposed for another output must bring to serve it too
SAME = 1e-7  # coordinates closer than this are the same point
HALVINGS = 20  # of a step that ends nearest to a run that failed, before it is given up
MOST = 256  # proposals weighed against each other in one round, those with the largest gains


@dataclass(frozen=True, eq=False)
class Wanted:
    """Places η (n, f) where one side (−1 lower, 1 upper) of one output each is expected to gain."""

    points: np.ndarray
    outputs: np.ndarray
    sides: np.ndarray
    gains: np.ndarray

    def __getitem__(self, rows: np.ndarray) -> "Wanted":
        return Wanted(self.points[rows], self.outputs[rows], self.sides[rows], self.gains[rows])


class Tried:
    """All points η (n, f) where the model was run, and which of these runs failed."""

    def __init__(self, points: np.ndarray, failed: np.ndarray) -> None:
        self.points, self.failed = points, failed
        # Runs that failed stay in the tree: a point next to one of them is not worth another run.
        self._tree = KDTree(points)
        self._number = np.where(failed, -1, np.cumsum(~failed) - 1)

    def nearest(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Number of the nearest run among those that succeeded, −1 if it failed, and its distance; both (n,)."""
        apart, nearest = map(np.asarray, self._tree.query(points))
        return self._number[nearest], apart

    def short_of_failures(self, points: np.ndarray, steps: np.ndarray) -> np.ndarray:
        """Where steps (n, f) from points lead, halved until they end nearer to a run that succeeded."""
        steps = steps.copy()
        for _ in range(HALVINGS):
            blocked = np.flatnonzero(self.nearest(points + steps)[0] < 0)
            if len(blocked) == 0:
                break
            # Twenty halvings shorten a step to a millionth, so the loop ends near the run where it began.
            steps[blocked] /= 2
        return points + steps


@dataclass
class ExtremeSearch:
    """All runs so far, in the coordinates η of the intervals that have a width."""

    runs: Runs
    tolerance: float  # gains smaller than this part of the widest band of a channel are not looked for
    radius: float  # how far an expansion is followed along each coordinate
    tried: list[np.ndarray] = field(default_factory=list)
    failed: list[bool] = field(default_factory=list)
    values: list[np.ndarray] = field(default_factory=list)
    slopes: list[np.ndarray] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.extremes = Extremes.none(self.runs)

    def run(self, etas: np.ndarray) -> None:
        """Run the model with its gradients at coordinates (n, f)."""
        box, free = self.runs.box, self.runs.free
        complete = np.zeros((len(etas), len(box)))
        complete[:, free] = etas
        points = [box.points(row) for row in complete]
        ahead = prefetched(self.runs.model, lambda model, point: model.linearise(point), points)
        for eta, point in zip(etas, ahead, strict=True):
            at = self.runs.linearised(point)
            self.tried.append(eta)
            self.failed.append(at is None)
            if at is not None:
                self.values.append(at[0].ravel())
                # By the chain rule d/dη = radius d/dx, and only of intervals with a width.
                self.slopes.append((at[1] * box.radius)[..., free].reshape(at[0].size, len(free)))
                self.extremes = self.extremes.with_runs(point[None], at[0][None])

    def proposals(self) -> tuple[np.ndarray, np.ndarray]:
        """Largest gain expected at each output, (samples, channels), and points (n, f) to run next."""
        # Gains that remain when the search ends are its finding on the error.
        gains = np.zeros(self.runs.shape)
        if not len(self.runs.free):
            return gains, np.empty((0, 0))
        tried = Tried(np.array(self.tried), np.array(self.failed))
        known = Expansions(tried.points[~tried.failed], np.array(self.values), np.array(self.slopes))
        wanted = self._wanted(known, tried)
        np.maximum.at(gains.reshape(-1), wanted.outputs, wanted.gains)
        if len(wanted.gains) == 0:
            return gains, wanted.points
        # Gains relative to the least one compare outputs of different units.
        order = np.argsort(-wanted.gains / self._least[wanted.outputs], kind="stable")[:MOST]
        return gains, self._covering(known, tried.nearest(wanted.points)[0][order], wanted[order])

    @property
    def _least(self) -> np.ndarray:
        """Smallest gain that is looked for, (outputs,)."""
        # Relative to the widest band of a channel: samples at which it hardly varies need no exact bounds.
        width = np.max(self.extremes.upper - self.extremes.lower, axis=0)
        return np.broadcast_to(self.tolerance * width, self.runs.shape).ravel()

    def _wanted(self, known: Expansions, tried: "Tried") -> Wanted:
        """The best place of each output and side, where more than the least is expected there."""
        parts = []
        # An expansion is followed as far as the first points lie apart, and no farther than the box.
        lower, upper = np.maximum(-1 - known.points, -self.radius), np.minimum(1 - known.points, self.radius)
        for outputs in known.chunks():
            curvatures = known.curvatures(outputs)
            doubts = known.doubts(outputs, curvatures)
            for side, best in ((-1, self.extremes.lower), (1, self.extremes.upper)):
                # With the sign of the side both bounds are maxima.
                values, slopes = side * known.values[:, outputs], side * known.slopes[:, outputs]
                hessians, least = side * curvatures, side * best.ravel()[outputs] + self._least[outputs]
                # The bound by absolute values is cheap. It leaves few expansions to maximise.
                run, output = np.nonzero(values + _reach(slopes, hessians, lower, upper) > least)
                steps = maxima(slopes[run, output], hessians[run, output], lower[run], upper[run])
                points = np.clip(tried.short_of_failures(known.points[run], steps), -1, 1)
                # The run nearest to the end of a step knows more about it than the one where the step began.
                near, apart = tried.nearest(points)
                steps = points - known.points[near]
                expected = values[near, output] + expand(slopes[near, output], hessians[near, output], steps)
                # The error of the expansion counts in favour of a point, so that unknown parts of the box are run too.
                expected += doubts[near, output] * apart**3
                # A point that was run before, or next to a failed run, brings nothing.
                expected[(near < 0) | (apart < SAME)] = -np.inf
                # One point for each output and side is enough for a round: its run changes all expansions.
                # Sorted by groups, and in each by falling values, the first row of a group has its largest value.
                order = np.lexsort((-expected, output))
                first = order[np.unique(output[order], return_index=True)[1]]
                first = first[expected[first] > least[output[first]]]
                gain = expected[first] - (least - self._least[outputs])[output[first]]
                parts.append(Wanted(points[first], outputs[output[first]], np.full(len(first), side), gain))
        return Wanted(*(np.concatenate([getattr(part, name) for part in parts]) for name in Wanted.__annotations__))

    def _covering(self, known: Expansions, near: np.ndarray, wanted: Wanted) -> np.ndarray:
        """Few of the wanted points that serve all outputs; ``near`` (n,) are the runs that know about each point."""
        outputs, column = np.unique(wanted.outputs, return_inverse=True)
        curvatures = known.curvatures(outputs)
        doubts = known.doubts(outputs, curvatures)[near][:, column]
        steps = (wanted.points - known.points[near])[:, None]
        at = np.ix_(near, wanted.outputs)
        expected = known.values[at] + expand(known.slopes[at], curvatures[near][:, column], steps)
        expected += wanted.sides * doubts * np.linalg.norm(steps, axis=2) ** 3
        best = np.where(
            wanted.sides < 0, self.extremes.lower.ravel()[wanted.outputs], self.extremes.upper.ravel()[wanted.outputs]
        )
        # Does the point in a row serve the output in a column? It does if most of the expected gain is reached there.
        serves = wanted.sides * (expected - best) >= COVERED * wanted.gains
        np.fill_diagonal(serves, True)
        chosen, open_ = [], np.ones(len(near), dtype=bool)
        while open_.any():
            # Greedy set cover: next the point that serves most outputs of those left. The smallest set is not needed.
            chosen.append(int(np.argmax(np.sum(serves & open_, axis=1))))
            open_ &= ~serves[chosen[-1]]
        return wanted.points[chosen]


def _reach(slopes: np.ndarray, hessians: np.ndarray, lower: np.ndarray, upper: np.ndarray) -> np.ndarray:
    """What expansions (runs, outputs) cannot exceed within their boxes (runs, f)."""
    far = np.maximum(-lower, upper)
    # |g·u + u·H u/2| is at most Σ |g_i| far_i + Σ |H_ij| far_i far_j/2 for |u_i| <= far_i.
    rise = np.einsum("nmf,nf->nm", np.abs(slopes), far)
    return rise + np.einsum("nmfg,nf,ng->nm", np.abs(hessians), far, far) / 2
