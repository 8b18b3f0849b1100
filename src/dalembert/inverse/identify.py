"""Parameters from measurements."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from dalembert.arguments import check_whole, takes_checked
from dalembert.data import Measurements
from dalembert.errors import InputError, SolveError, require_known, shown
from dalembert.findings import Finding
from dalembert.forward import Executor, ForwardModel, check_derivatives, findings_at, takes_executor
from dalembert.forward.adjoint import GRADIENTS
from dalembert.forward.provenance import provenance
from dalembert.inverse.events import Finished, OnEvent
from dalembert.inverse.experiments.coverage import with_coverage
from dalembert.inverse.experiments.experiment import Experiment
from dalembert.inverse.experiments.experiments import begun, placed
from dalembert.inverse.experiments.explained import explained_findings
from dalembert.inverse.experiments.joined import joined
from dalembert.inverse.experiments.suspect_times import experiment_time_findings
from dalembert.inverse.experiments.suspect_units import unit_findings
from dalembert.inverse.experiments.validation import HeldOut, split, whole_jacobian
from dalembert.inverse.fit.fit import Fit
from dalembert.inverse.fit.integration import integration_bias, integration_findings
from dalembert.inverse.fit.outcome import outcome, too_few_findings
from dalembert.inverse.fit.settings import settings, weights_source
from dalembert.inverse.least_squares.descent import End
from dalembert.inverse.least_squares.estimate import Estimate, estimate, estimate_of, unknown_estimate
from dalembert.inverse.least_squares.roughness import roughness_findings
from dalembert.inverse.misfit.misfit import misfit_conclusions
from dalembert.inverse.mistakes.findings import with_mistakes
from dalembert.inverse.mistakes.record import FittedRecord
from dalembert.inverse.noise.correlation.correlated_residuals import CorrelatedResiduals
from dalembert.inverse.noise.correlation.correlation import correlation
from dalembert.inverse.noise.correlation.correlation_findings import correlation_findings
from dalembert.inverse.noise.likelihood.placing import Noise
from dalembert.inverse.noise.noise_floor import noise_floor
from dalembert.inverse.noise.smoothed import noise_findings, smooth_noise
from dalembert.inverse.noise.with_noise import check_noise, counted_values, whole_noise, whole_weights, with_noise
from dalembert.inverse.noise.with_noise import noise_findings as estimated_noise_findings
from dalembert.inverse.problem.journal import Journal
from dalembert.inverse.problem.loss import loss_of
from dalembert.inverse.problem.prior import priors
from dalembert.inverse.problem.problem import Linearisation, MisfitProblem, pose
from dalembert.inverse.shooting.growth import growth_findings
from dalembert.inverse.shooting.restarts import check_restart, check_segments
from dalembert.inverse.shooting.shooting import MultipleShooting, shots
from dalembert.inverse.starts.multistart import HORIZONS, multistart
from dalembert.inverse.starts.repeated import repeated
from dalembert.inverse.starts.rivals import rival_findings, rivals
from dalembert.inverse.starts.runs import Method, polished, runs
from dalembert.inverse.starts.spread import SPREADS
from dalembert.inverse.starts.unconfirmed import look_white, unconfirmed_findings
from dalembert.optimize import LeastSquares, Minimiser, Squares


@takes_executor
@takes_checked(
    "model", "data", "method", "starts", "seed", "loss", "loss_scale", "horizon", "spread", "weights", "start", "noise"
)
def identify(
    model: ForwardModel | Sequence[Experiment],
    data: Measurements | None = None,
    *,
    method: Squares | Method | str | None = None,
    starts: int | None = None,
    seed: int = 0,
    start: Mapping[str, float] | ArrayLike | None = None,
    weights: ArrayLike | Mapping[str, ArrayLike] | None = None,
    noise: Noise | None = None,
    polish: bool = False,
    horizon: str | None = "growing",
    spread: str = "latin-hypercube",
    loss: str = "linear",
    loss_scale: float | None = None,
    validation: HeldOut = None,
    shooting: MultipleShooting | None = None,
    derivative: str = "auto",
    on_event: OnEvent | None = None,
    executor: Executor = None,
) -> Fit:
    """Parameters p of a model that make its response R(p) agree with measurements: least Σ W (R(p) − data)².

    Parameters
    ----------
    model : ForwardModel or sequence of Experiment
        Its samples must be those of the data; it may have more channels. Several experiments are fitted at once;
        parameters of the same name are shared, except those that an experiment has for its own.
    data : Measurements
        Left out with experiments, which have their own.
    method : LeastSquares, ResponseSensitivity, ParticleSwarm, ImprovedParticleSwarm, Firefly, Minimiser or its name
        Least squares with exact sensitivities if not given.
    starts : int, optional
        Starts at most, 8 for least squares and response sensitivity, 3 for multiple shooting and 1 for the others if
        not given; descents beside the best end, and its polish, come on top.
    seed : int
        All random numbers follow from it.
    start : mapping by name, or array of shape (parameters,), optional
        Where the first start begins; for a swarm its first particle. Mechanisms are first built there.
    weights : array, shape (channels,) or (samples, channels), optional
        W; 1/deviation² of each channel if the data have deviations, else 1. With experiments a mapping from their
        names to such arrays; 1 for those that it leaves out. With ``noise`` each is 1, or 0 for a value to leave out.
    noise : NoiseModel, its name, mapping of channel to NoiseModel, or EstimatedNoise, optional
        Noise that is estimated with the parameters, from the minimum of the search on; ``noise`` of a fit means its
        models, with the orders that were chosen. If not given, the noise is independent, and correlated residuals are
        allowed for after the fit.
    polish : bool
        Whether least squares goes on from where another method ends.
    horizon : {"growing", None}
        For least squares: ``"growing"`` fits an eighth, a quarter, a half of the samples, then all, each from the end
        of the one before; None fits all samples at once. Each of several experiments is cut at the same part of its
        time.
    spread : {"latin-hypercube", "sobol"}
        How the points that starts are chosen from are spread over the bounds.
    loss : {"linear", "huber", "soft-l1", "cauchy"}
        What is summed of each weighted residual W^½ (R − data): its square, or, so that outliers pull less, scale² ϱ(x)
        of its size x over the scale, where ϱ(x) is x² up to 1 and 2x − 1 beyond; 2 (√(1 + x²) − 1); ln(1 + x²).
    loss_scale : float, optional
        The weighted residual from which one counts as an outlier; if the data have deviations and no weights are
        given, 1.345, 1.287 and 2.385, which cost 5 % of the efficiency where there are no outliers.
    validation : float, name or names of experiments, or mapping of name to float, optional
        Share of the samples, those at the end, or experiments that are not fitted, but predicted. A mapping gives the
        length of the first part of each experiment that is fitted all the same, in the unit of its coordinate (s): the
        parameters of its own, such as its initial state, come from there. 0 fits none of it.
    shooting : MultipleShooting, optional
        Least squares in segments that must meet, in place of the growing horizon: for chaotic motion.
    derivative : {"auto", "direct", "adjoint"}
        How minimisers that need only gradients get them: from the Jacobian, or from the adjoint of a model that has
        one (see :func:`dalembert.forward.pullback`). "auto" decides by the number of parameters.
    on_event : callable, optional
        Called with each event (see :mod:`dalembert.inverse.events`) as it happens.
    executor : str or distributed.Client, optional
        Address of a Dask cluster, such as ``"tcp://10.0.0.1:8786"``, or a client of one, to which batches and
        starts beyond the first go.

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
    Normal, log-normal, half-normal and correlated normal priors of parameters (``prior``, or ``deviation``) are squares
    that are added to what is made least; uniform ones add nothing. The fit then is the maximum of the posterior
    density, with a log-normal prior that of the logarithm.

    Parameters whose bounds are positive and more than a decade apart are searched by their logarithm
    (``Parameter.log`` overrules). A failed simulation is infinitely bad, and never ends the run.

    With ``noise`` the weights, and the whitening of correlated noise, follow from noise parameters. The restricted
    likelihood estimates them together with the model's, from where the search ended, without the bias that deviations
    and correlations have in short records. Parameters may have priors then, though the data have no deviations.

    The first least squares start is ``start`` or ``Parameters.start``. If it does not settle the matter, 8 points a
    parameter and start of a Latin hypercube are simulated in one batch, and further starts are those of the least
    misfit over half, a quarter, an eighth of the samples in turn. From the best end the misfit is scanned along the
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
    check_whole("identify", "seed", seed, 0)
    squares = isinstance(method, Squares)
    if shooting is not None:
        _check_shooting(method, validation)
    starts = starts if starts is not None else 3 if shooting is not None else 8 if squares else 1
    check_whole("identify", "starts", starts, 1)
    if horizon is not None:
        require_known("horizon", str(horizon), HORIZONS)
    require_known("spread", str(spread), SPREADS)
    require_known("derivative", str(derivative), GRADIENTS)
    recorded = begun(placed(model, executor), start), data
    model, data, weights, parts = joined("identify", *recorded, weights)
    counted, weights = (None, weights) if noise is None else (counted_values(weights, data), None)
    given = data.deviations is not None and weights is None
    check_noise(noise, loss=loss, shooting=shooting)
    smoothing = shooting is not None or (noise is not None and len(priors(model.parameters)) > 0)
    smooth = smooth_noise(data, parts) if smoothing and not given and weights is None else None
    journal = Journal(len(data.coordinate.values), on_event)
    weighed = weights if smooth is None else np.broadcast_to(smooth**-2.0, data.values.shape)
    posed = replace(
        pose(model, data, weighed, journal, noise_known=noise is not None),
        loss=loss_of(loss, loss_scale, known=given),
        derivative=derivative,
    )
    posed = posed if counted is None else replace(posed, weights=posed.weights * counted)
    parted = split(posed, validation)
    problem, journal.samples = parted.part, parted.part.samples
    origin = None if start is None else _origin(problem, start)
    floor = noise_floor(problem, smooth)

    first = _origin(problem, model.parameters.start) if origin is None else origin
    suspected = tuple(experiment_time_findings(*recorded, model, problem.search.vectors(first)))
    if shooting is not None:  # before anything is simulated
        check_segments(problem, shooting)
        check_restart(problem, shooting, problem.search.vectors(first))
    if squares:
        check_derivatives(problem.model, problem.search.vectors(first))
    if shooting is not None and isinstance(method, Squares):
        ends = shots(problem, shooting, method, floor, starts=starts, seed=seed, spread=spread, start=first)
    elif isinstance(method, Squares):
        ends = multistart(problem, method, floor, starts=starts, seed=seed, horizon=horizon, spread=spread, start=first)
    else:
        ends = runs(problem, method, floor, starts=starts, seed=seed, spread=spread, start=origin)
    best = min(ends, key=lambda end: end.misfit)
    if not np.isfinite(best.misfit):
        raise SolveError(
            f"none of {len(ends)} starts could be simulated; the first failure: {journal.failures[0]}; "
            "look at the model there, or change the bounds or the start"
        )
    if not best.stationary and (polish or (squares and starts > 1 and shooting is None)):
        best = polished(problem, method if isinstance(method, Squares) else LeastSquares(), best)
    searched, settled = (problem, best, floor), None
    if noise is not None:
        problem, best, settled = with_noise(problem, noise, best, known=given)
        floor = noise_floor(problem)

    vector = problem.search.vectors(best.point)
    at = best.linearisation or problem.linearised(vector)
    response = problem.responses(vector[None])[0] if at is None else at.response
    known = given or problem.priors > 0 if settled is None else settled.noise.known
    reached = best.misfit <= floor.misfit
    exact = reached and floor.source == "arithmetic"
    if settled is None:
        estimated, correlated = _estimated(problem, response, at, best, known=known, exact=exact)
    else:
        estimated, correlated = settled.estimate, None
    rounded = reached and floor.source == "rounded"
    deviations = estimated.deviations
    found = integration_bias(problem, at, best.nodes)
    undetermined = repeated(problem, vector, response) if best.nodes is None else ()
    one_run = best.nodes is None or best.nodes.segments == 1
    looked = None if exact or rounded or not one_run else at
    parts_of_time, followed = misfit_conclusions(problem, looked, known=known)
    unconfirmed: tuple[Finding, ...] = ()
    if squares and shooting is None:
        unconfirmed = tuple(unconfirmed_findings(*searched[:2], ends, floor, white=look_white(problem, response)))
    if looked is not None and (squares or best.stationary):  # residuals elsewhere show the search, not the record
        followed = with_mistakes(followed, FittedRecord(problem, looked, known), _seen(journal))
    others = rivals(*searched, deviations, known=known if settled is None else given)
    whole = response if problem is posed else posed.responses(vector[None])[0]
    predicted = parted.validation(whole)
    unexplained = () if predicted is None else explained_findings(predicted.explained)
    detected = correlated is not None and len(correlated.detected) > 0
    doubtful = best.misfit > floor.misfit and (detected or floor.known or not best.success)
    grown = tuple(growth_findings(problem, vector)) if squares and shooting is None and doubtful else ()
    fit = Fit(
        parameters=model.parameters,
        values=vector,
        **vars(estimated),
        misfit=best.misfit,
        response=whole,
        data=data,
        weights=np.where(parted.fitted, posed.weights, 0.0) if settled is None else whole_weights(parted, problem),
        history=tuple(journal.history),
        starts=tuple(journal.starts),
        success=best.success and not undetermined and not unconfirmed,
        outcome=(
            *outcome(
                problem,
                best,
                response,
                floor,
                correlated=detected or settled is not None,
                searched=searched[1].misfit,
            ),
            *unconfirmed,
        ),
        method=method.name if isinstance(method, Minimiser) else type(method).__name__,
        simulations=journal.simulations,
        provenance=provenance(
            model,
            method,
            data=data.fingerprint,
            units=dict(data.source_units),
            seed=seed,
            starts=starts,
            start=None if start is None else model.parameters.vector(start).tolist(),
            weights=weights_source(weights, smooth, noise),
            polish=polish,
            horizon=horizon,
            spread=spread,
            **settings(loss, posed, validation, shooting, settled),
        ),
        parts=parts,
        validation=predicted,
        nodes=best.nodes,
        findings=(
            *noise_findings(data, smooth if noise is None else None),
            *undetermined,
            *too_few_findings(problem, known=known),
            *rival_findings(searched[0], searched[1], others, searched[2]),
            *suspected,
            *unit_findings(problem, vector, response),
            *roughness_findings(problem, best, None if exact else at, deviations),
            *(() if settled is None else estimated_noise_findings(settled)),
            *correlation_findings(correlated, deviations, explained=rounded),
            *followed,
            *integration_findings(
                None if exact else found,
                problem,
                deviations,
                best.misfit,
                known=known,
                white=not detected and settled is None,
            ),
            *unexplained,
            *grown,
            *findings_at(model, vector),
        ),
        integration=found,
        correlated=correlated,
        halves=parts_of_time,
        jacobian=None if at is None or not one_run else whole_jacobian(posed, problem, at),
        noise=None if settled is None else whole_noise(parted, problem, settled.noise),
    )
    fit = with_coverage(fit, posed)
    fit = replace(fit, findings=(*fit.findings, *fit.diagnostics().findings))
    journal.tell(Finished(fit.success, fit.status, fit.misfit, fit.values, fit.simulations))
    return fit


def _method(given: Squares | Method | str | None) -> Squares | Method:
    if given is None:
        return LeastSquares()
    if isinstance(given, str):
        return Minimiser(given)
    if isinstance(given, type) or not hasattr(given, "minimise"):
        hint = f"; write {given.__name__}(...)" if isinstance(given, type) else ""
        raise InputError(
            f"method is {shown(given)}; expected LeastSquares(), ResponseSensitivity(), ParticleSwarm(), "
            f"ImprovedParticleSwarm(), Firefly(), or a Minimiser or its name{hint}"
        )
    return given


def _seen(journal: Journal) -> list[np.ndarray]:
    """Vectors (parameters,) of the first guesses and of the ends of starts, the best first."""
    ends = sorted((start for start in journal.starts if np.isfinite(start.misfit)), key=lambda start: start.misfit)
    return [*([] if journal.first is None else [journal.first.vector]), *(start.end for start in ends)]


def _origin(problem: MisfitProblem, start: Mapping[str, float] | ArrayLike) -> np.ndarray:
    """Search point of a first guess."""
    return problem.search.points(problem.model.parameters.start_vector(start))


def _estimated(
    problem: MisfitProblem, response: np.ndarray, at: Linearisation | None, best: End, *, known: bool, exact: bool
) -> tuple[Estimate, CorrelatedResiduals | None]:
    """Deviations and correlations, NaN without a jacobian; the noise is known, or estimated from the residuals.

    Residuals of data that are ``exact`` to rounding are not tested for correlation.
    """
    scale, plain = problem.model.parameters.scale, replace(problem, loss=None)
    freedom = problem.compared - len(scale)
    variance = 1.0 if known else best.misfit / freedom if freedom > 0 else np.nan
    residual, slopes = plain.residual(response), None if at is None else plain.slopes(at, scale)
    if problem.loss is not None:
        counted = problem.weights.ravel() > 0
        variance, known = problem.loss.variance(residual[counted], freedom), False
        residual[counted] = problem.loss.influence(residual[counted])
    correlated = None if exact else correlation(problem, response, slopes, residual, variance, known=known)
    if slopes is None:
        return unknown_estimate(len(scale)), correlated
    noise = variance if correlated is None else correlated.noise
    if best.spread is not None:
        return estimate_of(best.spread, scale, noise), correlated
    return estimate(slopes, scale, noise), correlated


def _check_shooting(method: Squares | Method, validation: object) -> None:
    if not isinstance(method, Squares):
        raise InputError(
            f"shooting: method is {type(method).__name__}; multiple shooting is a way of least squares; leave one out"
        )
    if validation is not None:
        raise InputError(
            "shooting: validation was given, but a chaotic motion cannot be predicted; leave one of the two out"
        )
