"""One start of least squares: a local descent, its horizon growing if asked."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from dalembert.errors import SolveError
from dalembert.forward import refined
from dalembert.inverse.problem.integration_error import as_residuals, integration_error
from dalembert.inverse.problem.nodes import Nodes
from dalembert.inverse.problem.problem import Linearisation, MisfitProblem
from dalembert.inverse.problem.random_residuals import random_residuals
from dalembert.optimize import Progress, Squares

MANY = 30
"""Values from which a test of their correlation distinguishes residuals of a false minimum from noise."""


@dataclass(frozen=True, eq=False)
class End:
    """Where a start ended: a search point (parameters,), its misfit over all samples, and how it was reached.

    At a ``stationary`` end a finer descent would change nothing; at a ``rough`` one the response is not smooth enough
    for it. Multiple shooting adds the ``nodes`` of its segments, and a ``spread`` S (parameters, parameters) with the
    covariance S Sᵀ of the parameters at unit variance. ``begun`` is the misfit where the descent over all samples
    began. The descent did not go along the directions ``left_out`` (directions, parameters), which are not
    identifiable.
    """

    point: np.ndarray
    misfit: float
    success: bool
    message: str
    stationary: bool = False
    linearisation: Linearisation | None = None
    nodes: Nodes | None = None
    rough: bool = False
    begun: float = np.inf
    spread: np.ndarray | None = None
    left_out: np.ndarray | None = None


class Memo:
    """Residual and jacobian of a problem at search points, so that a point is simulated at most twice. After an
    accepted point the next one is simulated with its sensitivities at once, since it will most likely be accepted too;
    after a rejected one without.
    """

    def __init__(self, problem: MisfitProblem, at: Linearisation | None = None) -> None:
        self.problem, self.hopeful = problem, True
        self.at = self.accepted = at
        self.systematic: np.ndarray | None = None
        self.simulated = np.inf  # sum of squares where the error of the integrator was simulated
        self.last: tuple[np.ndarray | None, np.ndarray] = (None, np.zeros(0))  # the last search point and its vector

    def vector(self, point: np.ndarray) -> np.ndarray:
        """The vector (parameters,) of a search point; that of the last one is kept."""
        if self.last[0] is None or not np.array_equal(self.last[0], point):
            self.last = point.copy(), self.problem.search.vectors(point)
        return self.last[1]

    def residual(self, point: np.ndarray) -> np.ndarray:
        vector, hopeful = self.vector(point), self.hopeful
        if (known := self.known(vector)) is not None:
            return self.problem.residuals(vector, known.response)
        self.hopeful = False
        if not hopeful:
            return self.problem.residuals(vector, self.problem.responses(vector[None])[0])
        try:
            at = self.problem.linearise(vector)
        except SolveError:
            return np.full(self.problem.weights.size + self.problem.priors, np.nan)
        self.at = at
        return self.problem.residuals(vector, at.response)

    def jacobian(self, point: np.ndarray) -> np.ndarray:
        vector = self.vector(point)
        self.at = self.known(vector) or self.problem.linearise(vector)
        self.hopeful, self.accepted = True, self.at
        return self.problem.slopes(self.at)

    def ahead(self, point: np.ndarray) -> np.ndarray:
        """Return the residual at a point that is no candidate, without sensitivities."""
        vector = self.vector(point)
        return self.problem.residuals(vector, self.problem.responses(vector[None])[0])

    def white(self, point: np.ndarray) -> bool:
        """Return True if the residuals at a linearised point are many and look like white noise."""
        at, problem = self.known(self.vector(point)), self.problem
        if at is None or problem.compared < MANY:
            return False
        return random_residuals(problem.residual(at.response), problem.weights.shape, problem.data.present)

    def error(self, point: np.ndarray) -> np.ndarray | None:
        """Return the integrator's part of the residual near a linearised point; None where it is not known.

        It is simulated again where the sum of squares is less than a tenth of that at the last such point.
        """
        at, finer = self.known(self.vector(point)), refined(self.problem.model)
        if at is None or finer is None:
            return None
        residual = self.problem.residuals(at.vector, at.response)
        squares = float(residual @ residual)
        if squares < self.simulated / 10:
            error = integration_error(self.problem, at, finer).error
            self.systematic = None if error is None else as_residuals(self.problem, at, error)
            self.simulated = squares
        return self.systematic

    def known(self, vector: np.ndarray) -> Linearisation | None:
        """The linearisation at a vector (parameters,), if it is that of the last or of the last accepted point."""
        both = (at for at in (self.at, self.accepted) if at is not None)
        return next((at for at in both if np.array_equal(at.vector, vector)), None)


def descend(ladder: Sequence[MisfitProblem], method: Squares, point: np.ndarray, misfit: float | None = None) -> End:
    """Least squares from a search point on each problem of a ladder, the last one the whole problem. The shorter
    horizons only lead the way and are left early. Where they lead to a larger misfit of the whole problem than the
    point's ``misfit``, if that is known, the descent over the whole begins at the point.
    """
    led = point
    for problem in ladder[:-1]:
        led = _local(Memo(problem), replace(method, trials=10, tolerance=1e-3, gain=1e-2), led).point
    memo = Memo(ladder[-1])
    if misfit is not None and len(ladder) > 1:
        residual = memo.residual(led)
        led = led if residual @ residual <= misfit else point
    return _local(memo, method, led)


def recorded(problem: MisfitProblem, point: np.ndarray, descent: Callable[[], End]) -> End:
    """End of a descent from a search point (parameters,), recorded in the journal as a start."""
    values = problem.search.vectors(point)
    problem.journal.began(values)
    end = descent()
    problem.journal.ended(values, problem.search.vectors(end.point), end.misfit, end.success, end.message)
    return end


def refine(problem: MisfitProblem, method: Squares, end: End) -> End:
    """Least squares from where a descent ended; what was simulated there is not simulated again."""
    return _local(Memo(problem, end.linearisation), method, end.point)


def _local(memo: Memo, method: Squares, point: np.ndarray) -> End:
    problem, journal, search = memo.problem, memo.problem.journal, memo.problem.search
    best, begun = End(point, np.inf, False, ""), np.inf

    def progress(now: Progress) -> None:
        nonlocal best, begun
        begun = now.best if now.iteration == 0 else begun
        best = End(now.x, now.best, False, "")
        journal.step(now.best, memo.vector(now.x), problem.samples, now.regularised)

    try:
        minimum = method.minimise(
            memo.residual,
            memo.jacobian,
            search.lower,
            search.upper,
            point,
            on_iteration=progress,
            ahead=memo.ahead,
            disturbance=memo,
        )
    except SolveError as error:
        return replace(best, message=f"the sensitivities could not be computed: {error}")
    reasons = [] if np.isfinite(minimum.misfit) else journal.failures[-1:]
    message = ": ".join([minimum.message, *reasons])
    kept = memo.known(memo.vector(minimum.x))
    return End(
        minimum.x,
        minimum.misfit,
        minimum.success,
        message,
        minimum.stationary,
        kept,
        rough=minimum.rough,
        begun=begun,
        left_out=minimum.left_out,
    )
