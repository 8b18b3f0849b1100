"""One side of a profile likelihood: a walk along the valley of the misfit, away from the identified values."""

from dataclasses import dataclass, field, replace

import numpy as np
from scipy.optimize import brentq

from dalembert.errors import SolveError
from dalembert.inverse.assessment.profiled_likelihood import ProfiledLikelihood
from dalembert.inverse.events import Profiled
from dalembert.inverse.least_squares.descent import Memo
from dalembert.inverse.problem.problem import Linearisation, MisfitProblem
from dalembert.optimize import LeastSquares

STEP = 0.25  # growth of √excess from value to value, in parts of its threshold
BEYOND = 1.15  # √excess, in parts of its threshold, at which a walk has gone far enough
EXACT = 1e-6  # accuracy of an interval's end, in parts of its distance from the identified value
HALVINGS = 4  # of a step that ends where the model fails, before the walk ends
LONGEST = 1 / 8  # longest step, as a part of the search box's width


@dataclass(frozen=True)
class ProfileWalk:
    """What a walk goes by: misfit at the fit, variance of a weighted residual, threshold of the excess, most points.

    ``likelihood`` takes the place of the misfit where noise was estimated with the parameters.
    """

    best: float
    variance: float
    threshold: float
    points: int
    method: LeastSquares
    likelihood: ProfiledLikelihood | None = None

    def fresh(self) -> "ProfileWalk":
        """Return the same, as it is before its first value."""
        return self if self.likelihood is None else replace(self, likelihood=self.likelihood.fresh())


@dataclass
class Side:
    """One side: excess and parameters (parameters,) outward, and where the interval ends."""

    rows: list[tuple[float, np.ndarray]] = field(default_factory=list)
    end: float = np.nan
    open: bool = False
    broken: str = ""


def walked(
    problem: MisfitProblem, at: Linearisation, k: int, side: int, walk: ProfileWalk, excess: float = 0.0
) -> Side:
    """One side of the profile of parameter ``k``: ``side`` −1 goes down, +1 up, from a minimum with this excess. Each
    value is chosen so that √excess grows by a quarter of its threshold, judging from the last two; once beyond, the
    crossing is found by Brent's method. The other parameters begin where the last two values lead them.
    """
    walk = walk.fresh()
    search = problem.search
    origin = search.points(at.vector)
    bound = (search.upper if side > 0 else search.lower)[k]
    width = search.upper[k] - search.lower[k]
    goal = np.sqrt(walk.threshold)
    branch = Side()
    path = [(_root(excess), origin)]  # √excess and search point, outward
    step, way = _first(problem, at, k, walk)
    step, failed = step * STEP * goal, ""
    while abs(bound - path[-1][1][k]) > 1e-9 * width:
        if path[-1][0] >= goal or len(path) > walk.points:
            break
        step = min(step, LONGEST * width, abs(bound - path[-1][1][k]))
        for _ in range(HALVINGS):
            value = path[-1][1][k] + side * step
            value = bound if abs(bound - value) < 1e-9 * width else value
            here = least(problem, k, path[-1][1] + way * (value - path[-1][1][k]), walk)
            if isinstance(here, str):
                failed, step = here, step / 2
                continue
            break
        else:
            branch.broken = failed
            break
        root = _root(here[0])
        path.append((root, here[1]))
        branch.rows.append((here[0], search.vectors(here[1])))
        problem.journal.tell(Profiled(problem.model.parameters.names[k], here[0], problem.journal.simulations))
        move = path[-1][1] - path[-2][1]
        way = move / move[k]
        # Next step: that over which √excess would grow by a part of its threshold, at most twice the last one.
        rise, run = path[-1][0] - path[-2][0], abs(path[-1][1][k] - path[-2][1][k])
        wanted = min(STEP * goal, BEYOND * goal - path[-1][0])
        step = 2 * run if rise <= 0 else min(2 * run, max(wanted * run / rise, run / 4))
    if path[-1][0] >= goal:
        last = path[-1][1].copy()
        last[k] = _crossing(problem, k, path, walk, branch)
        branch.end = float(search.vectors(last)[k])
    elif not branch.broken and abs(bound - path[-1][1][k]) <= 1e-9 * width:
        branch.end, branch.open = float(getattr(problem.model.parameters, "upper" if side > 0 else "lower")[k]), True
    else:
        branch.end = float(search.vectors(path[-1][1])[k])
        branch.broken = branch.broken or "the threshold was not reached; increase points"
    return branch


def _first(problem: MisfitProblem, at: Linearisation, k: int, walk: ProfileWalk) -> tuple[float, np.ndarray]:
    """Deviation of search coordinate k, and how all coordinates follow it (parameters,), by the linearised response."""
    slopes = problem.slopes(at)
    free = np.arange(slopes.shape[1]) != k
    way = np.zeros(slopes.shape[1])
    way[k] = 1.0
    way[free] = -np.linalg.lstsq(slopes[:, free], slopes[:, k], rcond=1e-10)[0]
    length = float(np.linalg.norm(slopes @ way))
    return (np.sqrt(walk.variance) / length if length > 0 else np.inf), way


def least(problem: MisfitProblem, k: int, guess: np.ndarray, walk: ProfileWalk) -> tuple[float, np.ndarray] | str:
    """Excess and search point (parameters,) of the least misfit with coordinate k as in ``guess``, or why it failed."""
    if walk.likelihood is not None:
        return walk.likelihood.least(problem, k, guess)
    search = problem.search
    guess = np.clip(guess, search.lower, search.upper)
    free = np.arange(len(guess)) != k
    memo = Memo(problem)

    def full(rest: np.ndarray) -> np.ndarray:
        point = guess.copy()
        point[free] = rest
        return point

    before = len(problem.journal.failures)
    if not free.any():
        memo.hopeful = False
        misfit, point = float(np.sum(memo.residual(guess) ** 2)), guess
    else:
        try:
            end = walk.method.minimise(
                lambda rest: memo.residual(full(rest)),
                lambda rest: memo.jacobian(full(rest))[:, free],
                search.lower[free],
                search.upper[free],
                guess[free],
                ahead=lambda rest: memo.ahead(full(rest)),
            )
        except SolveError as error:
            return str(error)
        misfit, point = end.misfit, full(end.x)
    if not np.isfinite(misfit):
        reasons = problem.journal.failures[before:]
        return reasons[0] if reasons else "the misfit is not finite"
    return (misfit - walk.best) / walk.variance, point


def _root(excess: float) -> float:
    return float(np.sqrt(max(excess, 0.0)))


def _crossing(
    problem: MisfitProblem, k: int, path: list[tuple[float, np.ndarray]], walk: ProfileWalk, side: Side
) -> float:
    """Value of search coordinate k where √excess passes its threshold, between the last two points of the path.

    The others begin where those of the points around lie on a line.
    """
    goal, known = np.sqrt(walk.threshold), {float(point[k]): (root, point) for root, point in path[-2:]}

    def beyond(value: float) -> float:
        if value not in known:
            places = sorted(known)
            points = np.array([known[place][1] for place in places])
            guess = np.array([np.interp(value, places, column) for column in points.T])
            here = least(problem, k, guess, walk)
            if isinstance(here, str):
                raise SolveError(here)
            known[value] = _root(here[0]), here[1]
            side.rows.append((here[0], problem.search.vectors(here[1])))
        return known[value][0] - goal

    low, high = (float(point[k]) for _, point in path[-2:])
    try:
        end = brentq(beyond, low, high, xtol=EXACT * abs(high - path[0][1][k]))
    except SolveError as error:
        side.broken, end = str(error), low
    origin = problem.search.vectors(path[0][1])[k]
    side.rows.sort(key=lambda row: abs(row[1][k] - origin))
    return float(end)  # pyright: ignore[reportArgumentType]
