"""Which parameters cause the variance of a response: Sobol indices from a surrogate."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from dalembert.argument_readers import check_integer, check_model
from dalembert.arguments import is_number, takes_checked
from dalembert.errors import InputError, SolveError, listed, shown
from dalembert.findings import Finding
from dalembert.forward import Executor, ForwardModel, findings_at, on_cluster, takes_executor
from dalembert.forward.provenance import provenance
from dalembert.surrogate import Adaptive, Checks, SobolIndices, Surrogate, fit, sobol_indices
from dalembert.surrogate.scheme import Scheme
from dalembert.surrogate.unseen import unseen
from dalembert.uncertainty.events import Began, Ended, OnEvent
from dalembert.uncertainty.inputs import Distributions, Inputs, described, inputs_of
from dalembert.uncertainty.runs import Runs
from dalembert.uncertainty.sensitivity_indices import SensitivityIndices

NAME = "global_sensitivity"
FEWEST, SHARE, MOST = 30, 0.1, 1000  # checks at least, as a part of the runs of the surrogate, and at most
# Tolerance of the surrogate, as a part of that of the indices: the root of a part of the variance is as exact.
USUAL = 0.05
NEGLIGIBLE = 0.01  # total index below which a parameter may be fixed


@takes_executor
@takes_checked("tolerance", "checks", "seed")
def global_sensitivity(
    model: ForwardModel,
    intervals: Distributions | None = None,
    scheme: Scheme | None = None,
    *,
    tolerance: float = 0.02,
    checks: int | None = None,
    seed: int = 0,
    on_event: OnEvent | None = None,
    executor: Executor = None,
) -> SensitivityIndices:
    """Return the Sobol indices of every channel, at every sample and of the channel as a whole.

    The parameters are independent. The first-order index of a parameter is the part of the variance that it causes
    alone; its total index contains its interactions with others. Both come from a Chebyshev surrogate in closed form.

    Parameters
    ----------
    model : ForwardModel
    intervals : Box, or mapping of str to Interval, (lower, upper), number or prior, optional
        One for each parameter of the model, in SI units. It is uniform within an interval. A distribution such as
        ``Normal(mean, deviation)`` is truncated by the bounds of the parameter, or where its tails are below 1e-5. If
        not given, the priors of the parameters; without prior a parameter is uniform between its bounds.
    scheme : TotalDegree, Tensor or Adaptive, optional
        Of the surrogate, see :func:`dalembert.surrogate.fit`; ``Adaptive(tolerance / 20)`` if not given.
    tolerance : float
        Largest uncertainty of the indices of a whole channel, which follows from the error of the surrogate and from
        tails of distributions that are cut off.
    checks : int, optional
        Random runs that the surrogate is compared with: at least 2. Without it a tenth of those of the surrogate, and
        from 30 to 1000.
    seed : int
        Of the runs that test the surrogate.
    on_event : callable, optional
        Called with each event (see :mod:`dalembert.uncertainty.events`) as it happens.
    executor : str or distributed.Client, optional
        Address of a Dask cluster, or a client of one, to which batches go.

    Returns
    -------
    SensitivityIndices

    Raises
    ------
    InputError
        For a parameter without an interval, correlated priors, and a tolerance that is not between 0 and 1.
    SolveError
        If the indices of a channel are more uncertain than the tolerance.

    Notes
    -----
    The indices of a whole channel are Σ V_u / Σ V, summed over its samples (Lamboni, Monod and Makowski, Multivariate
    sensitivity analysis to measure global contribution of input factors in dynamic models, 2011).

    Examples
    --------
    >>> import numpy as np, dalembert as da
    >>> times = np.linspace(0.0, 1.0, 11)
    >>> model = da.PythonModel(lambda a, b: a * times + 0.1 * b, {"a": (0, 1), "b": (-9, 9)}, ["x"], times)
    >>> found = da.global_sensitivity(model, {"a": (0.0, 1.0), "b": (0.0, 1.0)})
    >>> found.first[0, 0].round(3).tolist(), found.first[-1, 0].round(3).tolist()
    ([0.0, 1.0], [0.99, 0.01])
    >>> found = da.global_sensitivity(model, {"a": (0.0, 1.0), "b": da.Normal(0.0, 1.0)})
    >>> found.first[-1, 0].round(3).tolist()
    [0.893, 0.107]
    """
    check_model(NAME, model)
    check_integer(NAME, "seed", seed, 0)
    if checks is not None:
        check_integer(NAME, "checks", checks, 2)
    if not is_number(tolerance) or not 0 < tolerance < 1:
        raise InputError(f"{NAME}: tolerance is {shown(tolerance)}; expected a number between 0 and 1")
    model = on_cluster(model, executor)
    inputs, scheme = inputs_of(model, intervals, NAME), scheme or Adaptive(USUAL * tolerance)
    runs = Runs(model, inputs.box, "global sensitivity", on_event)
    runs.tell(Began(runs.method, None))
    made_by = provenance(model, scheme, seed=seed, tolerance=tolerance, intervals=dict(described(inputs)))
    result = _indices(runs, inputs, _surrogate(runs, inputs, scheme, checks, seed), tolerance, made_by)
    runs.tell(Ended(runs.method, result.success, result.status, runs.count, 0.0))
    return result


@dataclass(frozen=True, eq=False)
class _CheckedSurrogate:
    """A surrogate of all samples and channels, the channel of each of its outputs, and its checks."""

    surrogate: Surrogate
    groups: np.ndarray
    checks: Checks | None


def _surrogate(runs: Runs, inputs: Inputs, scheme: Scheme, count: int | None, seed: int) -> _CheckedSurrogate:
    samples, channels = runs.shape
    groups, box = np.tile(np.arange(channels), samples), inputs.box

    def function(points: np.ndarray) -> np.ndarray:
        return runs.values(points).reshape(len(points), -1)

    surrogate = fit(function, box.lower, box.upper, scheme, seed=seed, groups=groups)
    if not len(runs.free):
        return _CheckedSurrogate(surrogate, groups, None)
    # Checks are drawn from the distributions, so that their errors count as the variance does.
    # The part of the seed keeps them apart from the held-out runs of the surrogate.
    number = int(np.clip(SHARE * surrogate.runs, FEWEST, MOST)) if count is None else count
    points = inputs.random(number, np.random.default_rng((seed, 5)))
    errors = function(points) - surrogate(points)
    known = np.isfinite(errors).all(axis=1)
    checks = Checks(inputs.eta(points[known]), errors[known]) if known.sum() > 1 else None
    return _CheckedSurrogate(surrogate, groups, checks)


def _indices(
    runs: Runs, inputs: Inputs, surrogate: _CheckedSurrogate, tolerance: float, made_by: Mapping[str, Any]
) -> SensitivityIndices:
    """Return the indices of each output, and of whole channels, if these are certain enough."""
    model, (samples, channels) = runs.model, runs.shape
    # Without groups indices of each output; with the channels as groups the ratios of sums over the samples.
    each, overall = (
        sobol_indices(surrogate.surrogate, rules=inputs.rules, groups=groups, checks=surrogate.checks)
        for groups in (None, surrogate.groups)
    )
    # The error of the surrogate and the tails are independent causes; their bounds add.
    names = tuple(channel.name for channel in model.channels)
    uncertainty = overall.uncertainty + _of_tails(inputs, overall, names, tolerance)
    worst = int(np.argmax(np.nan_to_num(uncertainty)))
    if uncertainty[worst] > tolerance:
        raise SolveError(
            f"{NAME}: the error of the surrogate leaves the indices of channel {names[worst]!r} uncertain by "
            f"{uncertainty[worst]:.2g}, more than the tolerance of {tolerance:g}. Improve the surrogate "
            f"({surrogate.surrogate.improvement}), increase checks, narrow the intervals, or raise the tolerance. For "
            "a response with kinks or jumps, estimate the indices by Monte Carlo: scipy.stats.sobol_indices."
        )
    shape = samples, channels, len(inputs.box)
    return SensitivityIndices(
        coordinate=model.coordinate,
        channels=names,
        units=tuple(channel.unit for channel in model.channels),
        box=inputs.box,
        distributions=inputs.texts,
        parameter_units=model.parameters.units(inputs.box.names),
        mean=each.mean.reshape(samples, channels),
        deviations=np.sqrt(each.variance).reshape(samples, channels),
        first=each.first.T.reshape(shape),
        total=each.total.T.reshape(shape),
        aggregated_first=overall.first.T,
        aggregated_total=overall.total.T,
        uncertainty=uncertainty,
        runs=runs.count,
        checks=0 if surrogate.checks is None else len(surrogate.checks.eta),
        failures=tuple(runs.failures),
        provenance=made_by,
        findings=(
            *failed_runs(runs),
            *_constant(names, overall),
            *_without_indices(names, overall, each.variance.reshape(samples, channels)),
            *_negligible(inputs, overall),
            unseen(surrogate.surrogate, inputs.box.names),
            *findings_at(model, inputs.box.middle),
        ),
    )


def _of_tails(inputs: Inputs, overall: SobolIndices, names: tuple[str, ...], tolerance: float) -> np.ndarray:
    """Return how much the tails that are cut off can change an index of each channel, (channels,)."""
    # The cut removes the part m of the variance of an input. In a linear model with the share S = V_i/V the whole
    # distribution has V_i/(1 - m), and so the share S/(1 - m (1 - S)). The change is S (1 - S) m/(1 - m (1 - S)).
    lost, share = np.array(inputs.lost)[:, None], np.nan_to_num(np.clip(overall.total, 0.0, 1.0))
    each = share * (1 - share) * lost / np.maximum(1 - lost * (1 - share), np.finfo(float).tiny)
    # Tails of several inputs add, as bounds of first order do.
    total = each.sum(axis=0)
    if np.max(total) > tolerance:
        channel = int(np.argmax(total))
        worst = int(np.argmax(each[:, channel]))
        inside = f"[{inputs.box.lower[worst]:.3g}, {inputs.box.upper[worst]:.3g}]"
        raise SolveError(
            f"{NAME}: the distribution of {inputs.box.names[worst]!r} has {inputs.lost[worst]:.2g} of its variance in "
            f"tails beyond {inside}, which leaves the indices of channel "
            f"{names[channel]!r} uncertain by {total[channel]:.2g}, more than the tolerance of {tolerance:g}. Give the "
            "parameter narrower bounds, or a distribution with lighter tails."
        )
    return total


def _constant(names: tuple[str, ...], overall: SobolIndices) -> list[Finding]:
    """Finding on channels without a variance, which have no indices."""
    still = [name for name, variance in zip(names, overall.variance, strict=True) if not variance > 0]
    if not still:
        return []
    message = f"The response of {listed(list(map(repr, still)))} is constant: it has no indices."
    advice = "Check that the channels depend on the parameters, or widen the intervals."
    return [Finding("constant-response", "warning", {"channels": ", ".join(still)}, message, advice)]


def _without_indices(names: tuple[str, ...], overall: SobolIndices, variances: np.ndarray) -> list[Finding]:
    """Finding on samples without a variance, (samples, channels), of channels that vary at others."""
    still = np.count_nonzero(~(variances > 0), axis=0)
    values = {
        name: int(count)
        for name, count, variance in zip(names, still, overall.variance, strict=True)
        if count and variance > 0
    }
    if not values:
        return []
    where = listed([f"{count} of {len(variances)} of {name!r}" for name, count in values.items()])
    message = f"Samples without indices, where the response does not vary: {where}. The indices there are NaN."
    return [Finding("samples-without-indices", "note", values, message, "")]


def _negligible(inputs: Inputs, overall: SobolIndices) -> list[Finding]:
    """Finding on parameters that may be fixed, as the upper ends of their total indices are small in all channels."""
    varying = overall.variance > 0
    if not varying.any():
        return []
    # By the upper end, so that the error of the surrogate cannot hide an influence.
    most = overall.total_ends[1][:, varying].max(axis=1)
    values = {
        name: float(index)
        for name, index, width in zip(inputs.box.names, most, inputs.box.radius, strict=True)
        if index < NEGLIGIBLE and width > 0
    }
    if not values:
        return []
    names = ", ".join(values)
    message = f"The total indices of these parameters are below {NEGLIGIBLE:g} in all channels: {names}."
    return [Finding("negligible-parameters", "note", values, message, "They may be fixed within their intervals.")]


def failed_runs(runs: Runs) -> list[Finding]:
    """Return the finding of the runs that failed, if there are any."""
    if not runs.failures:
        return []
    number, first = len(runs.failures), runs.failures[0]
    message = f"{number} of {runs.count} runs failed and were left out, the first: {first}."
    advice = "Narrow the intervals to where the model can be run."
    return [Finding("failed-runs", "error", {"failures": number, "first": first}, message, advice)]
