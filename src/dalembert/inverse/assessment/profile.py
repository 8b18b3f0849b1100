"""Profile likelihood: how much worse the data are explained with one parameter held elsewhere."""

from collections.abc import Collection, Iterable, Sequence
from dataclasses import replace
from functools import partial

import numpy as np
from scipy.special import chdtri, fdtri

from dalembert.argument_readers import check_integer, names_of
from dalembert.arguments import takes_checked
from dalembert.data import Measurements
from dalembert.errors import InputError
from dalembert.forward import Executor, ForwardModel, check_derivatives, takes_executor
from dalembert.forward.provenance import provenance
from dalembert.inverse.assessment.elsewhere import elsewhere
from dalembert.inverse.assessment.profiled_likelihood import profiled_likelihood
from dalembert.inverse.assessment.profiles import Profile, Profiles
from dalembert.inverse.assessment.walk import ProfileWalk, walked
from dalembert.inverse.events import OnEvent
from dalembert.inverse.experiments.experiment import Experiment
from dalembert.inverse.experiments.experiments import joint, placed
from dalembert.inverse.fit.fit import Fit, check_level
from dalembert.inverse.least_squares.estimate import estimate
from dalembert.inverse.problem.journal import Journal
from dalembert.inverse.problem.problem import Linearisation, MisfitProblem, pose
from dalembert.optimize import LeastSquares

POINTS = 12  # values of a parameter on each side of the identified one, at most, if not given


@takes_executor
@takes_checked("level", "points")
def profile(
    model: ForwardModel | Sequence[Experiment],
    data: Measurements | None = None,
    fit: Fit | None = None,
    *,
    names: Collection[str] | None = None,
    level: float = 0.95,
    points: int = POINTS,
    on_event: OnEvent | None = None,
    executor: Executor = None,
) -> Profiles:
    """Profile likelihood of identified parameters, and the intervals where the data do not contradict them.

    Parameters
    ----------
    model : ForwardModel, or sequence of Experiment
        What was fitted.
    data : Measurements or None
        What it was fitted to; None for experiments, which have their own.
    fit : Fit
        Its weights are used.
    names : collection of str, optional
        Parameters to profile; all if not given.
    level : float
        Probability that an interval holds the true value.
    points : int
        Values on each side of the identified one at most, from 4.
    on_event : callable, optional
        Called with an event a value.
    executor : str or distributed.Client, optional
        Address of a Dask cluster, such as ``"tcp://10.0.0.1:8786"``, or a client of one, to which batches and both
        sides of each profile go.

    Returns
    -------
    Profiles

    Raises
    ------
    DataError
        For data that do not fit the model.
    InputError
        For an unknown parameter, too few points, a level that is no probability, a fit with a robust loss or of
        segments that did not merge into one run.
    SolveError
        If the response at the identified values cannot be simulated.

    Notes
    -----
    For values of one parameter p_k the misfit g is made least over all others, warm-started along the valley. The
    interval is where (g − g_fit)/s² stays below the quantile of chi-square with one degree of freedom; where the noise
    s² is estimated from the residuals, that of F(1, freedom). For a linear response it is the value ∓ quantile ×
    deviation; where the response bends, or other parameters make up for the change, only the profile is right. A side
    ends at the first crossing, or open at the parameter's bound. A scan of the parameter between its bounds, one batch,
    then looks for further intervals beyond, which are returned separately.

    Where residuals are correlated, s² is multiplied by the square of the ratio of the parameter's deviation to that for
    independent residuals, so that the profile of a linear response has the curvature of the corrected covariance.

    Where noise was estimated with the parameters, g is −2 log of the restricted likelihood, and the noise parameters
    are made best again for each value, as they are unknown and may be correlated with the others. The threshold of the
    quantile F is freedom · log(1 + F/freedom), so that the interval of a linear response is that of Student's t.

    Source: Raue et al., Bioinformatics 25 (2009), 1923-1929; Bates and Watts, Nonlinear Regression Analysis, 1988;
    J. T. Kent, Robust properties of likelihood ratio tests, Biometrika 69 (1982).

    Examples
    --------
    >>> from dalembert.forward import PythonModel
    >>> from dalembert.inverse import identify
    >>> times = np.linspace(0.0, 2.0, 21)
    >>> line = PythonModel(lambda slope: slope * times, {"slope": (0.0, 3.0)}, ["x"], times)
    >>> data = Measurements.of(times, {"x": 2 * times}, deviations=0.1)
    >>> told = profile(line, data, identify(line, data))
    >>> radius = np.sqrt(3.841458820694124) * 0.1 / np.sqrt(np.sum(times**2))
    >>> np.allclose(told.intervals["slope"], (2 - radius, 2 + radius), rtol=1e-8)
    True
    """
    check_level(level, "profile")
    if fit is None:
        raise InputError("profile: no fit was given; give the one whose parameters are profiled, fit=...")
    fit.needs_one_run("profile")
    check_integer("profile", "points", points, 4)
    if "loss" in fit.provenance:
        raise InputError(
            f"profile: the fit has the loss {fit.provenance['loss']['name']!r}, whose minimum is no likelihood; fit "
            "with the loss 'linear', the outliers left out"
        )
    chosen = _names(fit, names)
    problem = _problem(placed(model, executor), data, fit, on_event)
    noise, values = fit.residual_variance, fit.values
    if not noise > 0:
        raise InputError(
            "profile: the noise of the data is not known, and the fit leaves no residuals to estimate it from; give "
            "the data's deviations"
        )
    check_derivatives(problem.model, values)
    at = problem.linearise(values)
    best = float(np.sum(problem.residuals(values, at.response) ** 2))
    known = fit.noise_is_known
    threshold = _threshold(fit, level)
    likelihood = None if fit.noise is None else profiled_likelihood(problem, at, fit.noise)
    method = LeastSquares(trials=30)
    walks = [
        ProfileWalk(best, noise * factor, threshold, points, method, likelihood)
        for factor in _factors(fit, problem, at).tolist()
    ]
    ways = [(fit.parameters.names.index(name), side) for name in chosen for side in (-1, 1)]
    curves, sides = [], []
    for k, side in problem.prefetched(partial(_ahead, at, walks), ways):
        sides.append(walked(problem, at, k, side, walks[k]))
        if side < 0:
            continue
        curve = _curve(fit, k, sides[-2:])
        further = elsewhere(problem, values, k, (curve.lower, curve.upper), walks[k])
        curves.append(replace(curve, elsewhere=further))
    return Profiles(
        parameters=fit.parameters,
        values=values,
        deviations=fit.deviations,
        curves=tuple(curves),
        level=level,
        threshold=threshold,
        variance=noise,
        known=known,
        simulations=problem.journal.simulations,
        provenance=provenance(problem.model, LeastSquares(trials=30), level=level, points=points),
    )


def _threshold(fit: Fit, level: float) -> float:
    """Return the excess at the ends of the intervals. Where noise was estimated with the parameters, the excess is that
    of twice a log-likelihood, and the threshold makes the interval of a linear response that of Student's t.
    """
    if fit.noise_is_known:
        return float(chdtri(1, 1 - level))
    freedom = fit.effective_degrees_of_freedom
    quantile = float(fdtri(1, freedom, level))
    return quantile if fit.noise is None else float(freedom * np.log1p(quantile / freedom))


def _factors(fit: Fit, problem: MisfitProblem, at: Linearisation) -> np.ndarray:
    """Return the variance of each parameter relative to that for independent residuals of the weights."""
    plain, factors = fit.plain_deviations, np.ones(len(fit.values))
    if fit.noise is not None:
        scale = fit.parameters.scale
        plain = estimate(problem.slopes(at, scale), scale, 1.0).deviations
    seen = np.isfinite(fit.deviations) & np.isfinite(plain)
    factors[seen] = (fit.deviations[seen] / plain[seen]) ** 2
    return factors


def _ahead(at: Linearisation, walks: Sequence[ProfileWalk], problem: MisfitProblem, way: tuple[int, int]) -> None:
    """The same side on a worker of a cluster."""
    walked(problem, at, *way, walks[way[0]])


def _names(fit: Fit, names: Collection[str] | None) -> Iterable[str]:
    known = fit.parameters.names
    names = None if names is None else names_of(names, "profile", "names")
    for name in names or ():
        fit.parameters.check_name(name, where="profile: names")
    return known if names is None else [name for name in known if name in names]


def _problem(
    model: ForwardModel | Sequence[Experiment], data: Measurements | None, fit: Fit, on_event: OnEvent | None
) -> MisfitProblem:
    if isinstance(model, ForwardModel):
        if data is None:
            raise InputError("profile: data is missing; give the measurements that the model was fitted to")
        complete, measured = model, data
    else:
        complete, measured = joint(model)
    if complete.parameters.identity != fit.parameters.identity:
        raise InputError(
            f"profile: the model has the parameters {_listed(complete)}, the fit {_listed(fit)}; expected the same"
        )
    journal = Journal(len(measured.coordinate.values), on_event)
    return pose(complete, measured, fit.weights, journal)


def _listed(owner: ForwardModel | Fit) -> str:
    known = [f"{item.name} = {item.lower:.6g}" for item in owner.parameters.fixed]
    return ", ".join([*owner.parameters.names, *known])


def _curve(fit: Fit, k: int, sides: list) -> Profile:
    """Both sides of a profile, joined at the identified value."""
    below, above = sides
    rows = [*below.rows[::-1], (0.0, fit.values), *above.rows]
    points = np.array([vector for _, vector in rows])
    return Profile(
        name=fit.parameters.names[k],
        values=points[:, k].copy(),
        excess=np.array([excess for excess, _ in rows]),
        points=points,
        lower=below.end,
        upper=above.end,
        open=(below.open, above.open),
        broken=(below.broken, above.broken),
    )
