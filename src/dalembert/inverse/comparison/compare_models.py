"""Models of the same data side by side: criteria, predictive densities, and whether a difference means anything."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from dalembert.errors import InputError, shown
from dalembert.inverse.comparison.comparison_findings import comparison_findings
from dalembert.inverse.comparison.cross_validate import fits_of
from dalembert.inverse.comparison.cross_validation import CrossValidation
from dalembert.inverse.comparison.draws import Predictive, default_way, is_draws, of_draws
from dalembert.inverse.comparison.left_out import correlation_time, counted_groups, groups
from dalembert.inverse.comparison.linearisation import linearised
from dalembert.inverse.comparison.model_comparison import ModelComparison
from dalembert.inverse.fit.fit import Fit


@dataclass(frozen=True, eq=False)
class Criteria:
    """What one model's comparison is made of."""

    parameters: int
    rms: float
    log_likelihood: float
    densities: np.ndarray
    waic: float = np.nan


def compare_models(
    models: Mapping[str, Any], *, leave_out: str | None = None, blocks: int | None = None
) -> ModelComparison:
    """Rank models of the same data by how well they predict data that were left out.

    Parameters
    ----------
    models : mapping of str to Fit, CrossValidation, Posterior or InferenceData
        By the names of the models, all of one kind. Fits are judged by their linearisation, with no further
        simulation; :func:`cross_validate` fits again; draws are those of :func:`sample`, or of ArviZ with the group
        ``log_likelihood``.
    leave_out : {"values", "blocks", "experiments"}, optional
        What is left out together. Without it single values, or blocks where residuals or their noise are correlated.
        InferenceData have single values only.
    blocks : int, optional
        For fits: number of blocks of each record. Posteriors have those of ``sample(..., blocks=...)``.

    Returns
    -------
    ModelComparison

    Raises
    ------
    InputError
        For fewer than two models, different data or weights, a robust loss, a fit without a Jacobian, and where
        only values that are left out determine a parameter: choose smaller groups.

    Notes
    -----
    AIC = 2k − 2 log L, AICc = AIC + 2k (k + 1)/(n − k − 1), BIC = k log n − 2 log L for k parameters and n values. They
    assume independent values. elpd is the sum of the log predictive densities of groups that were left out. The
    standard deviation of a difference over G groups is √G times that of the groups' differences. A difference below 4,
    or below two of its standard deviations, means nothing. An estimated noise model of a fit is used:
    values that are left out are predicted from their correlated neighbours too, and all densities are normal, with the
    noise that the other values determine.

    Source: H. Akaike, A new look at the statistical model identification, IEEE Transactions on Automatic Control 19
    (1974); A. Vehtari, A. Gelman, J. Gabry, Practical Bayesian model evaluation using leave-one-out cross-validation
    and WAIC, Statistics and Computing 27 (2017); T. Sivula, M. Magnusson, A. Vehtari, Uncertainty in Bayesian
    leave-one-out cross-validation based model comparison (2020).

    Examples
    --------
    >>> from dalembert import Measurements, PythonModel, identify
    >>> times = np.linspace(0.0, 1.0, 40)
    >>> line = PythonModel(lambda slope: slope * times, {"slope": (0.0, 3.0)}, ["x"], times)
    >>> bent = PythonModel(lambda bend: bend * times**2, {"bend": (0.0, 3.0)}, ["x"], times)
    >>> data = Measurements.of(times, {"x": 2 * times + 0.1 * np.random.default_rng(0).standard_normal(40)})
    >>> found = compare_models({"bent": identify(bent, data), "line": identify(line, data)})
    >>> found.models, found.findings[0].code
    (('line', 'bent'), 'best-model')
    """
    named: dict[str, Any] = dict(models)
    if len(named) < 2:
        raise InputError(f"compare_models: {len(named)} model was given; expected at least two, by their names")
    if all(map(is_draws, named.values())):
        if blocks is not None:
            raise InputError("compare_models: the blocks of draws are those of sample; leave blocks out here")
        way = leave_out or default_way(named)
        return _compared_draws({name: of_draws(name, model, way) for name, model in named.items()}, way)
    for name, model in named.items():
        if not isinstance(model, Fit | CrossValidation) or type(model) is not type(next(iter(named.values()))):
            raise InputError(
                f"compare_models: {name!r} is {shown(model)}; expected fits alone, cross-validations alone, or "
                "posteriors alone"
            )
    fits = fits_of(named)
    _check_same_data(fits)
    estimated = any(fit.noise is not None for fit in fits.values())
    linear = {name: linearised(name, fit, normal=estimated) for name, fit in fits.items()}
    if any(isinstance(model, CrossValidation) for model in named.values()):
        numbers, left_out = _groups_of(named)
        _check_same_densities(fits)
        densities = {name: model.log_densities for name, model in named.items()}
        how = "cross-validation by fits without each group"
    else:
        slowest = max(fits.values(), key=correlation_time)
        left_out = leave_out or ("blocks" if correlation_time(slowest) > 0 else "values")
        numbers = groups(slowest, left_out, blocks)
        places = counted_groups(numbers)
        densities = {name: np.array([at.without(rows) for rows in places]) for name, at in linear.items()}
        how = "leave-out predictions of the linearised models"
    criteria = {}
    for name, at in linear.items():
        if not np.all(np.isfinite(densities[name])):
            raise InputError(
                f"compare_models: {name!r} cannot predict values that are left out, as they alone determine a "
                "parameter; leave out smaller groups"
            )
        rms = float(np.sqrt(np.mean(at.residual[at.fitted] ** 2)))
        criteria[name] = Criteria(at.parameters, rms, at.log_likelihood(), densities[name])
    correlated = [name for name, fit in fits.items() if fit.correlated is not None and fit.correlated.detected]
    data = next(iter(fits.values())).provenance["data"]
    number = int(np.count_nonzero(numbers >= 0))
    return _result(criteria, number, how, left_out, {"data": data}, correlated)


def _groups_of(named: Mapping[str, CrossValidation]) -> tuple[np.ndarray, str]:
    first = next(iter(named.values()))
    for name, model in named.items():
        if not np.array_equal(model.groups, first.groups):
            raise InputError(
                f"compare_models: the cross-validation of {name!r} left out other groups; use the same leave_out and "
                "blocks for all models"
            )
    return first.groups, first.left_out


def _check_same_densities(fits: Mapping[str, Fit]) -> None:
    """Refuse cross-validations with Student's t and with normal densities side by side."""
    plain = [name for name, fit in fits.items() if fit.noise is None and not fit.noise_is_known]
    with_noise = [name for name, fit in fits.items() if fit.noise is not None]
    if plain and with_noise:
        raise InputError(
            f"compare_models: {plain[0]!r} has no noise model, but {with_noise[0]!r} has one, so that their predictive "
            f"densities differ; identify {plain[0]!r} with noise='constant', and cross-validate it again"
        )


def _check_same_data(fits: Mapping[str, Fit]) -> None:
    (first, reference), *rest = fits.items()
    for name, fit in rest:
        if fit.provenance["data"] != reference.provenance["data"]:
            raise InputError(
                f"compare_models: {name!r} was fitted to other data than {first!r}; fit both models to the same "
                "samples and channels"
            )
        if fit.noise is not None or reference.noise is not None:  # the deviations are a part of the models
            alike = np.array_equal(fit.weights > 0, reference.weights > 0)
        else:
            alike = np.array_equal(fit.weights, reference.weights) and fit.noise_is_known == reference.noise_is_known
        if not alike:
            raise InputError(
                f"compare_models: {name!r} was fitted with other weights or other held-out samples than {first!r}; "
                "use the same for both"
            )


def _compared_draws(known: Mapping[str, Predictive], leave_out: str) -> ModelComparison:
    (first, reference), *rest = known.items()
    for name, densities in rest:
        if not np.array_equal(densities.observed, reference.observed, equal_nan=True):
            raise InputError(f"compare_models: the draws of {name!r} are of other data than those of {first!r}")
        if not np.array_equal(densities.groups, reference.groups):
            raise InputError(
                f"compare_models: the draws of {name!r} have other blocks than those of {first!r}; sample both with "
                "the same number of blocks"
            )
    criteria = {
        name: Criteria(-1, np.nan, np.nan, densities.densities, densities.waic) for name, densities in known.items()
    }
    unreliable = {name: densities.unreliable for name, densities in known.items() if densities.unreliable}
    how = "PSIS-LOO of posterior draws"
    return _result(criteria, len(reference.groups), how, leave_out, {}, (), unreliable)


def _result(
    criteria: Mapping[str, Criteria],
    number: int,
    how: str,
    left_out: str,
    provenance: Mapping[str, Any],
    correlated: Sequence[str],
    unreliable: Mapping[str, int] | None = None,
) -> ModelComparison:
    names = sorted(criteria, key=lambda name: -float(np.sum(criteria[name].densities)))
    ordered = [criteria[name] for name in names]
    densities = np.array([item.densities for item in ordered])
    size = np.sqrt(densities.shape[1])
    apart = densities - densities[0]
    count = np.array([item.parameters for item in ordered])
    logs = np.array([item.log_likelihood for item in ordered])
    aic = 2 * count - 2 * logs
    left = number - count - 1
    aicc = np.where(left > 0, aic + 2 * count * (count + 1) / np.where(left > 0, left, 1), np.nan)
    comparison = ModelComparison(
        models=tuple(names),
        parameters=count,
        rms=np.array([item.rms for item in ordered]),
        log_likelihood=logs,
        aic=aic,
        aicc=aicc,
        bic=count * np.log(number) - 2 * logs,
        elpd=np.sum(densities, axis=1),
        elpd_deviation=size * np.std(densities, axis=1, ddof=1),
        difference=np.sum(apart, axis=1),
        difference_deviation=size * np.std(apart, axis=1, ddof=1),
        waic=np.array([item.waic for item in ordered]),
        densities=densities,
        values=number,
        how=how,
        left_out=left_out,
        provenance=dict(provenance),
    )
    return comparison_findings(comparison, correlated, unreliable or {})
