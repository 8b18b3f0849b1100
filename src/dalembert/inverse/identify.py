"""Parameters from measurements."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from dalembert.data import Measurements
from dalembert.errors import DalembertError, InputError, SolveError, unknown
from dalembert.forward import ForwardModel
from dalembert.forward.provenance import provenance
from dalembert.inverse.estimate import Estimate, estimate
from dalembert.inverse.events import Finished, OnEvent
from dalembert.inverse.fit import Fit
from dalembert.inverse.journal import Journal
from dalembert.inverse.multistart import HORIZONS, multistart
from dalembert.inverse.noise import noise_floor
from dalembert.inverse.problem import Linearisation, Problem, pose
from dalembert.inverse.runs import Method, polished, runs
from dalembert.inverse.status import status
from dalembert.optimize import LeastSquares, Minimiser


def identify(
    model: ForwardModel,
    data: Measurements,
    *,
    method: LeastSquares | Method | str | None = None,
    starts: int | None = None,
    seed: int = 0,
    start: Mapping[str, float] | ArrayLike | None = None,
    weights: ArrayLike | None = None,
    polish: bool = False,
    horizon: str | None = "growing",
    on_event: OnEvent | None = None,
) -> Fit:
    """Parameters p of a model that make its response R(p) agree with measurements: least Σ W (R(p) − data)².

    Parameters
    ----------
    model : ForwardModel
        Its samples must be those of the data; it may have more channels.
    data : Measurements
    method : LeastSquares, ParticleSwarm, ImprovedParticleSwarm, Minimiser or its name
        Least squares with exact sensitivities if not given.
    starts : int, optional
        Starts at most; 8 for least squares and 1 for the others if not given.
    seed : int
        All random numbers follow from it.
    start : mapping by name, or array of shape (parameters,), optional
        Where the first start begins; for a swarm its first particle.
    weights : array, shape (channels,) or (samples, channels), optional
        W; 1/deviation² of each channel if the data have deviations, else 1.
    polish : bool
        Whether least squares goes on from where another method ends.
    horizon : {"growing", None}
        For least squares: ``"growing"`` fits an eighth, a quarter, a half of the samples, then all, each from the end
        of the one before; None fits all samples at once.
    on_event : callable, optional
        Called with each event (see :mod:`dalembert.inverse.events`) as it happens.

    Returns
    -------
    Fit

    Raises
    ------
    DataError
        For a NaN in the data, a channel that the model lacks, samples that are not the model's.
    InputError
        For arguments that cannot be meant.
    SolveError
        If not one start could be simulated.

    Notes
    -----
    Parameters whose bounds are positive and more than a decade apart are searched by their logarithm
    (``Parameter.log`` overrules). A failed simulation is infinitely bad, and never ends the run.

    The first least squares start is ``start`` or ``Parameters.start``. If it does not settle the matter, 8 points a
    parameter and start of a Latin hypercube are simulated in one batch, and further starts are those of the least
    misfit over half, a quarter, an eighth of the samples in turn. From the best end the fitness is scanned along the
    combinations of parameters that the singular values belong to, and up to two dips beside it are descended into, as
    long as that finds a better end. The best end is polished at last.

    The matter is settled when a misfit is within the 99.9 % quantile of noise known to be below 0.1 % of the signal
    (from given deviations or from rounding of the data; with neither, a millionth of the signal), or, from the third
    start on, when the best end was reached twice and leaves residuals whose autocorrelation looks like noise.

    Examples
    --------
    >>> import numpy as np
    >>> from dalembert.forward import PythonModel
    >>> times = np.linspace(0, 10, 41)
    >>> swing = PythonModel(lambda rate: np.cos(rate * times), {"rate": (0.5, 8.0)}, ["x"], times)
    >>> data = Measurements.of(times, {"x": np.cos(6.3 * times)})
    >>> fit = identify(swing, data)
    >>> round(fit.values[0], 9), fit.success
    (np.float64(6.3), True)
    """
    method = _method(method)
    squares = isinstance(method, LeastSquares)
    starts = _starts(starts, 8 if squares else 1)
    if horizon not in HORIZONS:
        raise InputError(unknown("horizon", str(horizon), [name for name in HORIZONS if name]))
    journal = Journal(len(data.coordinate.values), on_event)
    problem = pose(model, data, weights, journal)
    origin = None if start is None else _origin(problem, start)
    floor = noise_floor(problem)

    if isinstance(method, LeastSquares):
        first = _origin(problem, model.parameters.start) if origin is None else origin
        ends = multistart(problem, method, floor, starts=starts, seed=seed, horizon=horizon, start=first)
    else:
        ends = runs(problem, method, floor, starts=starts, seed=seed, start=origin)
    best = min(ends, key=lambda end: end.fitness)
    if not np.isfinite(best.fitness):
        raise SolveError(
            f"none of {len(ends)} starts could be simulated; the first failure: {journal.failures[0]}; "
            "look at the model there, or change the bounds or the start"
        )
    if not best.stationary and (polish or (squares and starts > 1)):
        best = polished(problem, method if isinstance(method, LeastSquares) else LeastSquares(), best)

    vector = problem.search.vectors(best.point)
    at = best.linearisation or _linearised(problem, vector)
    response = problem.responses(vector[None])[0] if at is None else at.response
    told = _told(problem, at, best.fitness, known=data.deviations is not None and weights is None)
    fit = Fit(
        parameters=model.parameters,
        values=vector,
        deviations=told.deviations,
        correlation=told.correlation,
        singular_values=told.singular_values,
        directions=told.directions,
        fitness=best.fitness,
        response=response,
        data=data,
        weights=np.array(problem.weights),
        history=tuple(journal.history),
        starts=tuple(journal.starts),
        success=best.success,
        status=status(problem, best, response, floor),
        method=method.name if isinstance(method, Minimiser) else type(method).__name__,
        simulations=journal.simulations,
        provenance=provenance(
            model,
            method,
            data=data.fingerprint,
            seed=seed,
            starts=starts,
            start=None if start is None else model.parameters.vector(start).tolist(),
            weights="given" if weights is not None else "data",
            polish=polish,
            horizon=horizon,
        ),
    )
    journal.tell(Finished(fit.success, fit.status, fit.fitness, fit.values, fit.simulations))
    return fit


def _method(given: LeastSquares | Method | str | None) -> LeastSquares | Method:
    if given is None:
        return LeastSquares()
    if isinstance(given, str):
        return Minimiser(given)
    if not hasattr(given, "minimise"):
        raise InputError(
            f"method is {given!r}; expected LeastSquares(), ParticleSwarm(), ImprovedParticleSwarm(), or a Minimiser "
            "or its name"
        )
    return given


def _starts(given: int | None, usual: int) -> int:
    if given is not None and given < 1:
        raise InputError(f"starts is {given}; expected at least 1")
    return usual if given is None else given


def _origin(problem: Problem, start: Mapping[str, float] | ArrayLike) -> np.ndarray:
    """Search point of a first guess."""
    parameters = problem.model.parameters
    vector = parameters.vector(start)
    for item, value in zip(parameters, vector, strict=True):
        if not item.lower <= value <= item.upper:
            raise InputError(
                f"start: {item.name!r} is {value}, outside its bounds ({item.lower}, {item.upper}); "
                "widen the bounds or move the start"
            )
    return problem.search.points(vector)


def _linearised(problem: Problem, vector: np.ndarray) -> Linearisation | None:
    """Response and jacobian at the identified values; None where the model gives no jacobian."""
    try:
        return problem.linearise(vector)
    except DalembertError:
        return None


def _told(problem: Problem, at: Linearisation | None, fitness: float, known: bool) -> Estimate:
    """Deviations and correlations, NaN without a jacobian; the noise is known, or estimated from the residuals."""
    scale = problem.model.parameters.scale
    if at is None:
        lost = np.full(len(scale), np.nan)
        return Estimate(
            lost, np.full((len(scale), len(scale)), np.nan), lost, np.full((len(scale), len(scale)), np.nan)
        )
    freedom = problem.compared - len(scale)
    variance = 1.0 if known else fitness / freedom if freedom > 0 else np.nan
    return estimate(problem.slopes(at, scale), scale, variance)
