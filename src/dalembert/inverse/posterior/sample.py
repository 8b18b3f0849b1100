"""Draws of the posterior distribution of parameters."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from threading import Lock

from numpy.typing import ArrayLike

from dalembert.argument_readers import check_integer
from dalembert.data import Measurements
from dalembert.forward import Executor, ForwardModel, takes_executor
from dalembert.inverse.events import Drawn, OnEvent
from dalembert.inverse.experiments.blocks import USUAL
from dalembert.inverse.experiments.experiment import Experiment
from dalembert.inverse.experiments.experiments import placed
from dalembert.inverse.fit.fit import Fit
from dalembert.inverse.identify import identify
from dalembert.inverse.noise.likelihood.placing import Noise
from dalembert.inverse.posterior.drawn import draw, posterior_of
from dalembert.inverse.posterior.model_variants import without_priors
from dalembert.inverse.posterior.modes import find_modes
from dalembert.inverse.posterior.posed import Length, pose_posterior, search_start
from dalembert.inverse.posterior.posterior import Posterior
from dalembert.inverse.posterior.posterior_findings import inherited
from dalembert.inverse.posterior.sampler_choice import choose_sampler, requested_sampler
from dalembert.inverse.posterior.samplers.sampler import OnDraws, Sampler
from dalembert.priors import AnyPrior
from dalembert.surrogate.scheme import Scheme


@takes_executor
def sample(
    model: ForwardModel | Sequence[Experiment],
    data: Measurements | None = None,
    *,
    noise: Noise | None = None,
    weights: ArrayLike | Mapping[str, ArrayLike] | None = None,
    priors: Mapping[str, AnyPrior] | None = None,
    sampler: Sampler | str | None = None,
    surrogate: Scheme | bool | None = None,
    start: Fit | Mapping[str, float] | ArrayLike | None = None,
    chains: int = 4,
    draws: int = 1000,
    warmup: int = 500,
    seed: int = 0,
    blocks: int = USUAL,
    on_event: OnEvent | None = None,
    executor: Executor = None,
) -> Posterior:
    """Draw parameters from their posterior distribution p(parameters | data) ∝ p(data | parameters) p(parameters).

    Parameters
    ----------
    model : ForwardModel or sequence of Experiment
        Its parameters have the priors that they declare (``Parameter.prior``); uniform ones within their bounds if they
        declare none.
    data : Measurements, optional
        Left out with experiments, which have their own.
    noise : NoiseModel, its name, mapping of channel to NoiseModel, or EstimatedNoise, optional
        As in :func:`likelihood`. Parameters of the noise are sampled, too.
    weights : array, or mapping of experiments to arrays, optional
        1/variance of the values, in place of the data's deviations.
    priors : mapping of str to prior, optional
        In place of those that parameters declare, also of noise parameters: ``{"noise.x.deviation": HalfNormal(0.1)}``.
        Deviations of noise are log-uniform within their bounds if nothing is given.
    sampler : NUTS, AffineInvariant, DelayedAcceptance or their names, optional
        :class:`NUTS` for models with a jacobian, else :class:`AffineInvariant`.
    surrogate : TotalDegree, Tensor, Adaptive or bool, optional
        A Chebyshev surrogate proposes the draws, and the model decides (:class:`DelayedAcceptance`): for models that
        cost seconds. ``True`` for one of relative error 1e-4.
    start : Fit, mapping by name, or array of shape (parameters,), optional
        Where the posterior is large; identified by least squares if not given.
    chains, draws, warmup : int
        ``draws`` of each of ``chains`` are kept, after ``warmup`` that are not.
    seed : int
        All random numbers follow from it.
    blocks : int
        Blocks of neighbouring samples of each record, whose log densities after all other values are kept for
        :func:`compare_models`.
    on_event : callable, optional
        Called with each event (see :mod:`dalembert.inverse.events`) as it happens.
    executor : str or distributed.Client, optional
        Address of a Dask cluster, such as ``"tcp://10.0.0.1:8786"``, or a client of one, to which chains and batches
        go.

    Returns
    -------
    Posterior

    Raises
    ------
    DataError
        For data that do not fit the model.
    InputError
        For unknown names, a sampler whose package is not installed, priors that are not proper.
    SolveError
        If the start cannot be simulated, or a surrogate is too inaccurate.

    Notes
    -----
    Samplers move in coordinates without bounds, z = logit((p − lower)/(upper − lower)), of ln p for parameters whose
    logarithm is searched; the Jacobian of the map is part of the density. They are preconditioned by the Cholesky
    factor of JᵀΣ⁻¹J and the curvature of the priors at the mode, so that the posterior is nearly round.

    Further modes are searched from the ends of the fit's starts and from local maxima among points all over the
    prior. Each mode of at least 1 % of the probability has a chain, if there are enough chains. If no chain connects
    two modes, the finding ``separate-modes`` is an error.

    Source: A. Gelman and others, Bayesian Data Analysis, third edition, 2013, chapters 11 and 12.

    Examples
    --------
    >>> import numpy as np
    >>> from dalembert.forward import PythonModel
    >>> times = np.linspace(0.0, 1.0, 11)
    >>> line = PythonModel(lambda slope: slope * times, {"slope": (0.0, 4.0)}, ["x"], times)
    >>> data = Measurements.of(times, {"x": 2 * times}, deviations=0.1)
    >>> posterior = sample(line, data, chains=2, draws=200, warmup=100)
    >>> exact = 0.1 / np.sqrt(np.sum(times**2))
    >>> bool(abs(posterior.deviations[0] - exact) < 0.15 * exact)
    True
    """
    least = {"seed": 0, "blocks": 2}
    counts = {"chains": chains, "draws": draws, "warmup": warmup, "seed": seed, "blocks": blocks}
    for name, number in counts.items():
        check_integer("sample", name, number, least.get(name, 1))
    length = Length(chains, draws, warmup, seed)
    requested = requested_sampler(sampler, surrogate)
    posed = pose_posterior(placed(model, executor), data, noise, weights, priors, on_event)

    def identified() -> Fit:
        alone = model if posed.known_noise else without_priors(model)
        return identify(alone, data, weights=weights, seed=seed, on_event=on_event, executor=executor)

    begin = search_start(posed, start, identified)
    choice = choose_sampler(requested, posed.likelihood, begin.vector)
    all_modes = find_modes(posed, begin, length, gradients=choice.differentiable)
    drawn = draw(all_modes, choice.sampler, length, _announced(on_event))
    posterior = posterior_of(drawn, blocks)
    return replace(posterior, findings=(*posterior.findings, *inherited(begin.fit, posed)))


def _announced(on_event: OnEvent | None) -> OnDraws:
    """A function that announces each hundredth of the draws; threads may call it, and the events are the same."""
    lock, count = Lock(), 0

    def on_draws(draws: int, of: int) -> None:
        nonlocal count
        with lock:
            before, count = count, count + draws
            for part in range(1 + 100 * before // of, 1 + 100 * count // of):
                if on_event is not None:
                    on_event(Drawn(part * of // 100, of))

    return on_draws
