"""Parameters from measurements."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from numpy.typing import ArrayLike

from dalembert.arguments import takes_checked
from dalembert.data import Measurements
from dalembert.forward import Executor, ForwardModel, takes_executor
from dalembert.inverse.assessment.coverage import with_coverage
from dalembert.inverse.checks.catalogue import CHECKS, OUTCOME
from dalembert.inverse.events import Finished, OnEvent
from dalembert.inverse.experiments.experiment import Experiment
from dalembert.inverse.fit.fit import Fit
from dalembert.inverse.identification.assess import assess
from dalembert.inverse.identification.noise import with_noise
from dalembert.inverse.identification.pose import pose_identification
from dalembert.inverse.identification.result import fit_of
from dalembert.inverse.identification.search import find_minimum, search_settings
from dalembert.inverse.noise.likelihood.placing import Noise
from dalembert.inverse.shooting.shooting import MultipleShooting
from dalembert.inverse.starts.runs import Method
from dalembert.inverse.validation.validation import HeldOut
from dalembert.optimize import Squares


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
        Whether least squares continues from where another method ends.
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
        length of the first part of each experiment that is fitted all the same, in the unit of its coordinate (s): its
        local parameters, such as its initial state, come from there. 0 fits none of it.
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
    settings = search_settings(method, starts, seed, start, polish, horizon, spread, shooting)
    posed = pose_identification(
        model,
        data,
        start=start,
        weights=weights,
        noise=noise,
        loss=loss,
        loss_scale=loss_scale,
        validation=validation,
        shooting=shooting,
        derivative=derivative,
        on_event=on_event,
        executor=executor,
    )
    search = find_minimum(posed, settings)
    minimum = with_noise(posed, search)
    optimum = assess(posed, settings, search, minimum)
    findings = tuple(finding for check in CHECKS for finding in check(optimum))
    outcome = tuple(finding for check in OUTCOME for finding in check(optimum))
    fit = with_coverage(fit_of(optimum, outcome, findings), posed.whole)
    fit = replace(fit, findings=(*fit.findings, *fit.diagnostics().findings))
    search.problem.journal.tell(Finished(fit.success, fit.status, fit.misfit, fit.values, fit.simulations))
    return fit
