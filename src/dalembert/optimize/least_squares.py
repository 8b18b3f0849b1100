"""SciPy's trust-region least squares, with bounds and an exact jacobian."""

from dataclasses import dataclass

import numpy as np

from dalembert.arguments import limited
from dalembert.optimize.minimum import Minimum, reachable
from dalembert.optimize.path import Creeps, SearchPath
from dalembert.optimize.settle import settle
from dalembert.optimize.stopping import SMOOTH, WINDOW, Stopped, Stopping
from dalembert.optimize.sum_of_squares import SquaresMinimiser, SumOfSquares
from dalembert.optimize.valley import follow_valley

LEAST_GAIN = 1e-14  # fraction of the sum of squares. A step that gains less ends a descent, whatever is foreseen.
# Fraction of the sum of squares. With this ``gain`` a descent is one of many, of which the best continues: progress
# is judged sooner. With a larger one it only leads to another descent, and one step that gains less ends it.
COARSE = 1e-3
TRIALS = 100  # residuals at most, for each parameter and one more. Descents without progress stop long before.


@dataclass(frozen=True)
class LeastSquares(SquaresMinimiser):
    """Bounded nonlinear least squares by SciPy's trust-region reflective method.

    Parameters
    ----------
    trials : int, optional
        Most residuals to compute; 100 (1 + parameters) if not given.
    tolerance : float
        Ends when a step is shorter than this, relative to one unit a parameter.
    gain : float
        Ends when the linear model within the bounds foresees a fall of the sum of squares by less than this fraction,
        or when a step that goes as foreseen lowers it by less than the smaller of this and 1e-14. Above 1e-3 one step
        that lowers it by less than ``gain`` is enough.

    Notes
    -----
    The solver works in u = 1 + (x − start)/scale, with a trust region in the shape of the jacobian's columns: a
    parameter may move the farther, the less the residuals depend on it. The first trust radius is that of the first
    point, so every parameter may move by about one ``scale`` at first, wherever the origin of x lies.

    A descent also ends when 10 trial points for each parameter, or 4 with a ``gain`` from 1e-3 on, and at least 20,
    lowered the sum of squares by less than 2 %, and the foreseen fall did not shrink tenfold either: the residuals are
    rough then, the jacobian is wrong, or the descent follows a long curved valley. If the foreseen fall is below
    0.01 %, the minimum is reached up to the roughness. Otherwise, with a ``gain`` below 1e-3, steps with geodesic
    acceleration follow the valley, judged by the same rule. If they come no further, the descent has not converged.

    Where a descent creeps along directions that the residuals do not identify between the bounds, it ends by Gauss and
    Newton's steps in the other directions.

    Examples
    --------
    >>> import numpy as np
    >>> residual = lambda x: np.array([x[0] - 1.0, 10 * (x[1] - x[0] ** 2)])
    >>> jacobian = lambda x: np.array([[1.0, 0.0], [-20 * x[0], 10.0]])
    >>> LeastSquares().minimise(residual, jacobian, [-2, -2], [2, 2], [-1.2, 1.0]).x.round(12).tolist()
    [1.0, 1.0]
    """

    trials: int | None = limited(None, least=1)
    tolerance: float = reachable(1e-10)
    gain: float = reachable(1e-13)

    def descend(self, problem: SumOfSquares, start: np.ndarray) -> Minimum:
        # A curved valley needs more trial points before it shows progress, the more, the more parameters there are.
        window = max(WINDOW, (10 if self.gain < COARSE else 4) * len(start))
        most = TRIALS * (1 + len(start)) if self.trials is None else self.trials
        path = SearchPath(problem, start, Stopping(self.gain, window), most, type(self).__name__)
        try:
            end = self._trust_region(path)
        except Creeps as at:
            end = settle(path, at, Stopping(self.gain, window), self.tolerance)
        if end.success or self.gain >= COARSE or not np.isfinite(end.misfit):
            return end
        # The valley is judged anew: the trial points of the trust region would end it at once.
        path.stopping = Stopping(self.gain, window)
        try:
            follow_valley(path, path.x, path.stopping, self.tolerance)
        except Stopped as stopped:
            return path.minimum(stopped)

    def _trust_region(self, path: SearchPath) -> Minimum:
        from scipy.optimize import least_squares  # what does not minimise starts without it

        problem, start = path.problem, path.origin
        try:
            if not np.all(np.isfinite(path.residual(path.one))):
                return path.minimum(Stopped("the first point could not be simulated", success=False))
            result = least_squares(
                path.residual,
                path.one,
                path.jacobian,  # pyright: ignore[reportArgumentType]
                bounds=(1 + (problem.low - start) / problem.unit, 1 + (problem.high - start) / problem.unit),
                method="trf",
                x_scale="jac",
                # A larger one would end a descent along a curved valley, where steps are short.
                ftol=self.gain if self.gain > COARSE else min(LEAST_GAIN, self.gain),
                xtol=self.tolerance,
                # An absolute threshold on the gradient would depend on the units of the data.
                gtol=None,  # pyright: ignore[reportArgumentType]
                max_nfev=path.most,
            )
        except Stopped as stopped:
            return path.minimum(stopped)
        if result.status == 0:
            return path.minimum(path.spent())
        if result.status == 2:
            return path.minimum(Stopped("converged: the sum of squares falls no more"))
        return path.minimum(path.stopping.at_rest(max(SMOOTH, self.gain)))
