"""One surrogate over the whole search box, on which all candidate boxes are bounded."""

from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from dalembert.arguments import Checked as CheckedArguments
from dalembert.arguments import limited
from dalembert.inverse.bands.band_descent import descend, screened
from dalembert.inverse.bands.band_problem import BandProblem
from dalembert.inverse.bands.candidate import Candidate, candidate
from dalembert.inverse.bands.check import BandSolution, check, scale
from dalembert.inverse.bands.correction import corrected
from dalembert.inverse.events import Checked
from dalembert.inverse.problem.matching import place
from dalembert.inverse.problem.surrogates import surrogate_of
from dalembert.optimize import LeastSquares, Minimum
from dalembert.surrogate import Adaptive, Surrogate
from dalembert.surrogate.held_out import SHARE
from dalembert.surrogate.scheme import Scheme

SCREENED = 100  # boxes bounded on the surrogate to choose starts from, an unknown
ENOUGH = 1e-7  # checks end when surrogate and true runs agree to this part of a channel's range
NEGLIGIBLE = 0.1  # or when they agree to this part of the difference between given and reproduced bands
COARSE = 1e-4  # a surrogate that is wrong by more than this part of a channel's range is made anew around the answer
MOST_STARTS = 32  # most descents until the best end is reached twice; they make no runs of the model
SAME = 1e-3  # ends of descents are the same within this part of the unknowns' widths
MARGIN = (0.5, 0.02)  # how far around: parts of the answer's radius and of the search box's width


@dataclass(frozen=True)
class GlobalSurrogate(CheckedArguments):
    """Least squares over the middles and radii of the intervals, on one surrogate over the whole search box.

    Parameters
    ----------
    scheme : Adaptive, Tensor or TotalDegree
        Of the surrogate over the search box. It must be accurate enough to lead near the answer.
    local : Adaptive, Tensor or TotalDegree
        Of a second surrogate around the answer. It is made only if the first one is too inaccurate there.
    starts : int
        Fewest descents, from the best of many scattered boxes. Up to 32 are made until two reach the best end, unless
        ``starts`` is 1; they make no runs of the model.
    checks : int
        Most times that true runs are made where the surrogate has the minima and maxima of the answer. After each but
        the last they correct the surrogate; where it is far off, it is made again around the answer. 0 for none.
    tolerance : float
        An answer is refused when the surrogate is wrong by more than this part of a channel's range: at the true runs
        of the last check, or by its estimated error over the search box if ``checks`` is 0.
    held_out : int
        Runs of the model that only test the surrogate.

    Raises
    ------
    InputError
        For settings that cannot be meant.

    Notes
    -----
    A bound is the value of the polynomial at its extreme point in the box. Its derivative by the box is that of the
    polynomial there (envelope theorem), so the jacobian is exact. A few true runs check all bounds, since most are
    taken at the same corners. The checks end when surrogate and true runs agree to 1e-7 of a channel's range. This
    limits the accuracy of the answer if the bands have no noise; the deviations do not include it.
    """

    scheme: Scheme = field(default_factory=lambda: Adaptive(tolerance=1e-2, cautious=False))
    local: Scheme = field(default_factory=lambda: Adaptive(tolerance=2e-4, cautious=False))
    starts: int = limited(4, least=1)
    checks: int = limited(4, least=0)
    tolerance: float = limited(1e-3, above=0)
    held_out: int = limited(4, least=0)

    @property
    def name(self) -> str:
        return "global"

    def search(self, problem: BandProblem, seed: int) -> BandSolution:
        """The best box.

        Raises
        ------
        SolveError
            For a surrogate that cannot be made, or that is not to be trusted.
        """
        surrogate = self._surrogate(problem, self.scheme, seed)
        allowed = self.tolerance * scale(problem)
        if self.checks == 0:
            surrogate.demand(allowed, partial(place, problem.bands))
        best, times = self._descended(problem, surrogate, seed)
        solution, surrogate = self._refined(problem, surrogate, best, seed)
        if solution.check is not None:
            judged = replace(
                surrogate, tail=np.minimum(surrogate.tail, solution.error), held_out=SHARE * solution.error
            )
            # A surrogate that is better than the misfit of the bands does not limit the answer.
            if np.any(judged.error > np.maximum(allowed, _misfit(problem, solution.candidate))):
                judged.demand(allowed, partial(place, problem.bands), problem.model.parameters.names)
        return replace(solution, reached=times)

    def _descended(self, problem: BandProblem, surrogate: Surrogate, seed: int) -> tuple[Minimum, int]:
        """Return the best of the descents, and how many of them reached it: more of them until two did."""
        number = SCREENED * len(problem.unknowns.lower)
        origins = screened(problem, surrogate.polynomial, number, max(self.starts, MOST_STARTS), seed)
        ends: list[Minimum] = []
        for origin in origins:
            ends.append(descend(problem, surrogate.polynomial, LeastSquares(), origin))
            best = min(ends, key=lambda end: end.misfit)
            width = problem.unknowns.upper - problem.unknowns.lower
            times = sum(bool(np.all(np.abs(end.x - best.x) <= SAME * width)) for end in ends)
            if len(ends) >= self.starts and (times > 1 or self.starts == 1):
                break
        return best, times

    def _surrogate(self, problem: BandProblem, scheme: Scheme, seed: int) -> Surrogate:
        low, high = problem.unknowns.bounds
        return surrogate_of(
            problem.run, low, high, scheme, problem.journal, shape=problem.shape, seed=seed, held_out=self.held_out
        )

    def _refined(
        self, problem: BandProblem, surrogate: Surrogate, best: Minimum, seed: int
    ) -> tuple[BandSolution, Surrogate]:
        """In turn checked by true runs, made better by them or around them, and descended from the answer so far."""
        polynomial, points, values = surrogate.polynomial, surrogate.points, surrogate.values
        solution = BandSolution(
            polynomial, candidate(problem, polynomial, best.x), surrogate.error, None, best.success, best.message
        )
        sharpest = np.inf
        for left in reversed(range(self.checks)):
            at = candidate(problem, polynomial, best.x)
            checked = check(problem, polynomial, at)
            if checked is None:
                break
            misfit, largest = float(problem.misfit(checked.lower, checked.upper)), float(checked.error.max())
            problem.journal.tell(Checked(len(checked.points), problem.journal.simulations, misfit, largest))
            worst = float(np.max(checked.error / scale(problem)))
            if worst > sharpest:  # the correction made it worse
                break
            sharpest = worst
            solution = BandSolution(polynomial, at, checked.error, checked, best.success, best.message)
            if left == 0 or worst <= ENOUGH or np.all(checked.error <= NEGLIGIBLE * _misfit(problem, at)):
                break
            points, values = np.concatenate([points, checked.points]), np.concatenate([values, checked.values])
            if worst > COARSE and problem.unknowns.leaves(at.lower, at.upper):
                problem = replace(problem, unknowns=problem.unknowns.around(at.lower, at.upper, *MARGIN))
                surrogate = self._surrogate(problem, self.local, seed)
                polynomial, sharpest = surrogate.polynomial, np.inf
                points, values = np.concatenate([points, surrogate.points]), np.concatenate([values, surrogate.values])
            else:
                polynomial = corrected(polynomial, at, points, values, len(checked.points))
            best = descend(problem, polynomial, LeastSquares(), problem.unknowns.of(at.lower, at.upper))
        return solution, surrogate


def _misfit(problem: BandProblem, at: Candidate) -> float:
    """Root mean square of the difference between the bounds and the given ones."""
    apart = problem.residual(at.bounds.lower, at.bounds.upper)
    return float(np.sqrt(np.sum(apart**2) / (2 * np.sum(problem.weights))))
