"""Enhanced response sensitivity: Tikhonov's weight from the L-curve, raised until the linear model can be trusted."""

from dataclasses import dataclass, field

import numpy as np

from dalembert.arguments import limited
from dalembert.errors import InputError, require_known
from dalembert.optimize.identifiable_part import creeps, identifiable_part
from dalembert.optimize.least_squares import LeastSquares
from dalembert.optimize.linear_model import LinearModel
from dalembert.optimize.minimum import Minimum, Progress, RegularisedStep, reachable
from dalembert.optimize.path import Creeps, SearchPath
from dalembert.optimize.settle import settle
from dalembert.optimize.stopping import WINDOW, Stopped, Stopping
from dalembert.optimize.sum_of_squares import SquaresMinimiser, SumOfSquares
from dalembert.optimize.tikhonov import Regularised

REGULARISATIONS = ("l-curve", "gcv", "discrepancy")


@dataclass(frozen=True)
class ResponseSensitivity(SquaresMinimiser):
    """Bounded nonlinear least squares by regularised steps, d = (SᵀS + μ²)⁻¹ Sᵀ (−r), within a trust region.

    In each iteration μ is chosen anew, from the corner of the L-curve, say, and raised until the sum of squares falls
    by the agreed part of what the linear model r + S d foresees.

    Parameters
    ----------
    regularisation : {"l-curve", "gcv", "discrepancy"}
        What chooses μ: the corner of the L-curve; least generalised cross-validation; or the largest μ that leaves no
        more than the noise. The last two end within the noise of the minimum, where the first goes to the minimum.
    agreement : float
        ϱ_cr, from 0.25 to 0.75: part of the foreseen fall that a step must reach.
    growth : float
        σ, by which μ is raised at least; published from 2 to 5.
    trials : int
        Most residuals to compute.
    iterations : int
        Most steps to take.
    tolerance : float
        Ends when a step would be shorter than this, relative to one ``scale`` a parameter.
    gain : float
        Ends with a step that is foreseen to lower the sum of squares by less than this fraction.
    noise : float, optional
        Standard deviation of a weighted residual, required for "discrepancy": 1 if the data have deviations and there
        are no other weights.

    Notes
    -----
    Steps, choice of μ and agreement are the published ones. Beyond them,

    - a rejected μ is raised by more than σ where it takes more to halve the step;
    - the length of a step is limited, at first to one ``scale`` a parameter. A step that is accepted at its first trial
      with a ratio of agreement above 0.75 raises the limit to three times its length; a step that had to be shortened
      sets the limit to its length;
    - a step that meets a bound is the minimum of the same linear model between the bounds;
    - where a descent creeps along directions that the residuals do not identify between the bounds, it ends by Gauss
      and Newton's steps in the other directions;
    - where the L-curve has no corner, the data determine every direction, and the step is Gauss and Newton's. As the
      residual falls towards zero the corner moves towards μ = 0 with it, so that convergence is quadratic.

    Source: Lu & Wang, An enhanced response sensitivity approach for structural damage identification, International
    Journal for Numerical Methods in Engineering 111 (2017); patent CN113806886A.

    Examples
    --------
    >>> import numpy as np
    >>> residual = lambda x: np.array([x[0] - 1.0, 10 * (x[1] - x[0] ** 2)])
    >>> jacobian = lambda x: np.array([[1.0, 0.0], [-20 * x[0], 10.0]])
    >>> ResponseSensitivity().minimise(residual, jacobian, [-2, -2], [2, 2], [-1.2, 1.0]).x.round(9).tolist()
    [1.0, 1.0]
    """

    regularisation: str = "l-curve"
    agreement: float = limited(0.5, least=0.25, most=0.75)
    growth: float = limited(2.0, above=1)
    trials: int = limited(100, least=1)
    iterations: int = limited(50, least=1)
    tolerance: float = reachable(1e-10)
    gain: float = reachable(1e-8)
    noise: float | None = limited(None, above=0)

    def __post_init__(self) -> None:
        where = "ResponseSensitivity"
        require_known("regularisation", self.regularisation, REGULARISATIONS, where)
        if self.regularisation == "discrepancy" and self.noise is None:
            raise InputError(
                f"{where}: regularisation 'discrepancy' needs noise, the standard deviation of a weighted residual; "
                "give noise=1.0 where the data have deviations"
            )

    def descend(self, problem: SumOfSquares, start: np.ndarray) -> Minimum:
        return _Descent(self, problem, start, problem.residual(start)).minimum()

    def weight(self, problem: Regularised) -> float:
        """μ for a linear problem; infinite where nothing but noise is left."""
        if self.regularisation == "discrepancy":
            most = problem.values + 2 * np.sqrt(2 * problem.values)  # two deviations above what is expected
            return problem.discrepancy((self.noise or 0.0) * np.sqrt(most))
        return problem.gcv() if self.regularisation == "gcv" else problem.corner()


@dataclass
class _Descent:
    """A descent under way: its point x, the residual r there, and how far the linear model is trusted."""

    method: ResponseSensitivity
    problem: SumOfSquares
    x: np.ndarray
    r: np.ndarray
    trials: int = 1
    iterations: int = 0
    radius: float = field(init=False)
    before: float = np.inf
    foreseen: float = np.inf

    def __post_init__(self) -> None:
        self.radius = float(np.sqrt(len(self.x)))

    def minimum(self) -> Minimum:
        if not np.all(np.isfinite(self.r)):
            return Minimum(self.x, np.inf, False, "the first point could not be simulated", 0, 1)
        last: RegularisedStep | None = None
        try:
            while True:
                self.tell(last)
                model = self.linear()
                if self.creeps(model):
                    return self.settled(model)
                last = self.advance(model)
        except Stopped as end:
            misfit = float(self.r @ self.r)
            return Minimum(self.x, misfit, end.success, str(end), self.iterations, self.trials, end.stationary)

    def tell(self, last: RegularisedStep | None) -> None:
        self.problem.on_iteration(Progress(self.iterations, self.trials, float(self.r @ self.r), self.x, last))

    def linear(self) -> LinearModel:
        """The linear model about x, in units of the scale."""
        if not self.r.any():
            raise Stopped("converged: the fit is perfect", stationary=True)
        if self.iterations == self.method.iterations:
            raise self.spent(f"{self.iterations} steps", "iterations")
        low, high, unit = self.problem.low, self.problem.high, self.problem.unit
        slopes = self.problem.jacobian(self.x) * unit
        if not slopes.any():
            raise Stopped("converged: the residual does not change with the parameters", stationary=True)
        model = LinearModel(self.r, slopes, (low - self.x) / unit, (high - self.x) / unit)
        if not slopes[:, model.free].any():
            raise Stopped("converged: bounds hold all parameters that the residual changes with", stationary=True)
        return model

    def creeps(self, model: LinearModel) -> bool:
        """Return True if the last step crept along directions that are not identifiable."""
        now = float(self.r @ self.r)
        crept, fall = creeps(self.before, now, self.foreseen), self.before - now
        self.before, self.foreseen = now, model.foreseen(model.step(0.0)) / now
        return crept and identifiable_part(self.problem, self.x, self.r, model.slopes, fall).final

    def settled(self, model: LinearModel) -> Minimum:
        """Return the end of the descent in the identifiable directions."""
        stopping, name = Stopping(self.method.gain, WINDOW), type(self.method).__name__
        path = SearchPath(
            self.problem, self.x, stopping, self.method.trials, name, self.before, self.trials, 1 + self.iterations
        )
        return settle(path, Creeps(self.x, self.r, model.slopes), stopping, self.method.tolerance)

    def advance(self, model: LinearModel) -> RegularisedStep:
        """Take one step; its account."""
        problem, shortest = model.regularised, self.method.tolerance * np.sqrt(len(self.x))
        chosen = self.method.weight(problem)
        if np.isinf(chosen):
            raise Stopped("converged: what is left is within the noise")
        # Whether there is anything to gain is judged by the step that μ alone chooses, before the trust region shortens
        # it.
        wish = model.step(chosen)
        if np.linalg.norm(wish) < shortest:
            raise Stopped("converged: the parameters move no more", stationary=True)
        last = model.foreseen(wish) < self.method.gain * float(self.r @ self.r)

        mu, before = max(chosen, problem.weight_of(self.radius)), self.trials
        while True:
            step = model.step(mu)
            length = float(np.linalg.norm(step))
            if length < shortest:
                raise Stopped("converged: the parameters move no more", stationary=True)
            point, trial = self.trial(step)
            # ϱ = (‖r‖² − ‖r_new‖²)/(foreseen fall); as a product of sum and difference, without cancellation.
            agreement = float((self.r - trial) @ (self.r + trial)) / max(model.foreseen(step), np.finfo(float).tiny)
            if agreement >= self.method.agreement:
                break
            if last:  # what there is to gain is lost in rounding
                raise Stopped("converged: the sum of squares falls no more")
            # Published: μ ← σ μ. Where σ alone takes many trials, the weight that halves the step is tried.
            mu = max(self.method.growth * mu, problem.weight_of(length / 2))

        tried = self.trials - before
        curve = problem.weights, problem.residual_norms(problem.weights), problem.step_norms(problem.weights)
        account = RegularisedStep(mu, chosen, agreement, tried, float(np.linalg.norm(self.r)), length, *curve)
        # The limit follows the length that the linear model was good for.
        if tried > 1:
            self.radius = length
        elif agreement > 0.75:
            self.radius = max(self.radius, 3 * length)
        self.x, self.r, self.iterations = point, trial, self.iterations + 1
        if last:
            self.tell(account)
            raise Stopped("converged: the sum of squares falls no more")
        return account

    def trial(self, step: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """A point to try and the residual there."""
        if self.trials == self.method.trials:
            raise self.spent(f"{self.trials} trial points", "trials")
        self.trials += 1
        point = np.clip(self.x + self.problem.unit * step, self.problem.low, self.problem.high)
        return point, self.problem.residual(point)

    def spent(self, what: str, setting: str) -> Stopped:
        advice = f"allow more with ResponseSensitivity({setting}=...)"
        return Stopped(f"stopped after {what}, not converged; {advice}", success=False)


Squares = LeastSquares | ResponseSensitivity
"""``minimise(residual, jacobian, lower, upper, start, *, scale, on_iteration)``; settings ``trials``, ``tolerance``,
``gain``."""
