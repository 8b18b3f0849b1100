"""The residuals of a fit if its record has a supposed mistake."""

from dataclasses import dataclass, replace

import numpy as np

from dalembert.errors import SolveError
from dalembert.inverse.mistakes.record import FittedRecord, Mistake
from dalembert.inverse.problem.journal import Journal
from dalembert.inverse.problem.prior import prior_residual, prior_slopes
from dalembert.inverse.problem.problem import Linearisation
from dalembert.optimize import LeastSquares

TRIALS = 25
"""Most residuals of a descent."""

GAIN = 1e-3
"""A descent ends when a step lowers the sum of squares by less than this part of it."""

LEAST = 1e-20
"""Ratio of squares below which residuals are rounding."""

NUMBER = 4.0
"""Log-likelihood by which a mistake with a number must be better than one without: a delay by half a period explains a
wrong sign, too."""

STEP = 0.02
"""Step of the differences by the number of a mistake, in distances of the numbers that are tried."""


@dataclass(frozen=True, eq=False)
class Supposed:
    """A supposed mistake and what it leaves."""

    mistake: Mistake
    at: Linearisation  # where the parameters are
    number: float  # that describes the mistake
    # ratio: mean of the squares of weighted residuals over that of the fit; over the values that the mistake leaves,
    # but in the fit over those, too, that it blames
    ratio: float
    values: int  # number of compared values
    # squares: (values of all channels,): of the weighted residuals; 0 where the mistake blames a value, NaN where it
    # leaves a value out
    squares: np.ndarray

    @property
    def by_chance(self) -> float:
        """Gain in log-likelihood that a free number brings by chance."""
        return NUMBER + np.log(len(self.mistake.numbers)) if np.isfinite(self.number) else 0.0

    @property
    def gain(self) -> float:
        """Gain in log-likelihood, n/2 ln(before/after), less that which a free number brings by chance."""
        return -self.values / 2 * np.log(max(self.ratio, LEAST)) - self.by_chance

    def better_than(self, other: "Supposed") -> float:
        """Gain in log-likelihood over another mistake, by the values that both compare."""
        common = np.isfinite(self.squares) & np.isfinite(other.squares)
        squares_here, squares_of_other = (
            max(float(np.sum(mistake.squares[common])), np.finfo(float).tiny) for mistake in (self, other)
        )
        return np.count_nonzero(common) / 2 * np.log(squares_of_other / squares_here) - self.by_chance + other.by_chance


def linear(record: FittedRecord, mistake: Mistake, at: Linearisation) -> Supposed:
    """Return the best number of a mistake, with the parameters by one step of Gauss and Newton within their bounds."""
    search = record.problem.search
    slopes, point = search.slope(at.vector), search.points(at.vector)
    jacobian = at.jacobian.reshape(-1, len(slopes)) * slopes
    tables = np.column_stack([at.response.ravel(), jacobian])
    best = Supposed(mistake, at, np.nan, np.inf, 0, np.zeros(0))
    places = record.ranked
    before, blamed = record.residual[places] ** 2, np.isin(places, mistake.blamed)
    root = np.sqrt(record.problem.weights.ravel()[places])
    parameters = record.problem.model.parameters
    of_priors = prior_residual(parameters, at.vector), prior_slopes(parameters, at.vector, slopes)
    for number in mistake.numbers:
        if mistake.shown_at is None:
            shown = mistake.shown(tables, float(number))[places]
        else:
            shown = mistake.shown_at(tables, float(number), places)
        kept = np.all(np.isfinite(shown), axis=1)
        residual = np.concatenate([record.compared(shown[kept, 0], places[kept]), of_priors[0]])
        rows = np.concatenate([root[kept, None] * shown[kept, 1:], of_priors[1]])
        # Normal equations are exact enough to rank mistakes, and ten times as fast as singular values of the rows.
        step = np.linalg.lstsq(rows.T @ rows, -rows.T @ residual, rcond=1e-12)[0]
        step = np.clip(point + step, search.lower, search.upper) - point
        ratio = _ratio(before[kept | blamed], residual + rows @ step, int(np.count_nonzero(kept)), len(places))
        if ratio < best.ratio:
            best = Supposed(mistake, at, float(number), ratio, record.problem.compared, np.zeros(0))
    return best


def refitted(record: FittedRecord, supposed: Supposed) -> Supposed:
    """Return a supposed mistake with the parameters, and its number, by least squares from where they are."""
    problem = replace(record.problem, journal=Journal(record.problem.samples), loss=None)
    search, mistake, count = problem.search, supposed.mistake, len(supposed.at.vector)
    numbered = bool(np.isfinite(supposed.number))
    spacing = float(np.min(np.diff(mistake.numbers))) if numbered else 0.0
    numbers = supposed.number + spacing * np.array([-1.0, 0.0, 1.0]) if numbered else np.array([np.nan])
    reach = supposed.number + (1 + STEP) * (numbers - supposed.number) if numbered else numbers
    shown = [mistake.shown(supposed.at.response.ravel(), float(number_at)) for number_at in reach]
    kept = np.all(np.isfinite(shown), axis=0) & (record.problem.weights.ravel() > 0)
    known: dict[bytes, Linearisation] = {search.points(supposed.at.vector).tobytes(): supposed.at}

    def at(point: np.ndarray) -> Linearisation:
        key = point[:count].tobytes()
        if key not in known:
            known.clear()
            known[key] = problem.linearise(search.vectors(point[:count]))
        return known[key]

    def number(point: np.ndarray) -> float:
        return float(point[count]) if numbered else np.nan

    def residual(point: np.ndarray) -> np.ndarray:
        try:
            now = at(point)
        except SolveError:
            return np.full(np.count_nonzero(kept) + problem.priors, np.nan)
        compared, _ = _compared(record, mistake.shown(now.response.ravel()[:, None], number(point)), kept)
        return np.concatenate([compared, prior_residual(problem.model.parameters, now.vector)])

    def jacobian(point: np.ndarray) -> np.ndarray:
        now = at(point)
        slopes = search.slope(now.vector)
        flat = now.jacobian.reshape(-1, count) * slopes
        _, rows = _compared(record, mistake.shown(np.column_stack([now.response.ravel(), flat]), number(point)), kept)
        rows = np.concatenate([rows, prior_slopes(problem.model.parameters, now.vector, slopes)])
        if not numbered:
            return rows
        moved = point.copy(), point.copy()
        moved[0][count] += STEP * spacing
        moved[1][count] -= STEP * spacing
        return np.column_stack([rows, (residual(moved[0]) - residual(moved[1])) / (2 * STEP * spacing)])

    ends = np.array([numbers[0], numbers[-1]]) if numbered else np.zeros(0)
    lower, upper = (np.concatenate([side, ends[k : k + 1]]) for side, k in ((search.lower, 0), (search.upper, 1)))
    if not numbered:
        lower, upper = search.lower, search.upper
    start = np.concatenate([search.points(supposed.at.vector), [supposed.number] if numbered else []])
    method = LeastSquares(trials=TRIALS, gain=GAIN)
    scale = np.concatenate([np.ones(count), [spacing] if numbered else []])
    try:
        minimum = method.minimise(residual, jacobian, lower, upper, start, scale=scale)
        end = at(minimum.x)
    except SolveError:
        return replace(supposed, ratio=np.inf)
    finally:
        record.problem.journal.simulations += problem.journal.simulations
    left = residual(minimum.x)
    before = kept.copy()
    before[mistake.blamed] = record.problem.weights.ravel()[mistake.blamed] > 0
    total = int(np.count_nonzero(record.problem.weights))
    ratio = _ratio(record.residual[before] ** 2, left, int(np.count_nonzero(kept)), total)
    squares = np.full(kept.shape, np.nan)
    squares[kept] = left[: np.count_nonzero(kept)] ** 2
    squares[mistake.blamed] = 0.0
    return Supposed(mistake, end, number(minimum.x), ratio, problem.compared, squares)


def _compared(record: FittedRecord, shown: np.ndarray, kept: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Weighted residuals (kept,) of a response in the first column, and weighted derivatives (kept, parameters)."""
    problem = record.problem
    response = np.where(np.isfinite(shown[:, 0]), shown[:, 0], 0.0).reshape(problem.weights.shape)
    root = np.sqrt(problem.weights).ravel()[kept]
    return root * problem.unweighted_residual(response).ravel()[kept], root[:, None] * shown[kept, 1:]


def _ratio(before: np.ndarray, residual: np.ndarray, kept: int, total: int) -> float:
    """Mean square of residuals of ``kept`` values, those of priors behind them, over that before.

    ``before`` are the squares of the fit. Infinite if less than half of the ``total`` is kept.
    """
    mean = float(np.sum(before)) / max(1, len(before))
    if 2 * kept < total or not mean > 0:
        return np.inf
    return float(np.sum(residual**2)) / max(1, kept) / mean
