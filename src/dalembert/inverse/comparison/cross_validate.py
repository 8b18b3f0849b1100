"""Fit a model again without each block of its data, and predict the block."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from dalembert.data import Measurements
from dalembert.errors import InputError
from dalembert.forward import Executor, ForwardModel
from dalembert.inverse.comparison.conditional import WithNoise
from dalembert.inverse.comparison.cross_validation import CrossValidation
from dalembert.inverse.comparison.left_out import counted_groups, groups
from dalembert.inverse.comparison.linearisation import linearised
from dalembert.inverse.comparison.predictive import log_density
from dalembert.inverse.experiments.experiment import Experiment
from dalembert.inverse.fit.fit import Fit
from dalembert.inverse.identify import identify
from dalembert.inverse.least_squares.estimate import UNSEEN
from dalembert.inverse.noise.models.noise_model import NoiseModel
from dalembert.inverse.problem.prior import prior_slopes
from dalembert.inverse.problem.search_coordinates import off_bounds

UNDETERMINED = (
    "cross_validate: without one group, the other data do not determine all parameters; leave out smaller blocks, or "
    "fix the parameters that only this group determines"
)


def cross_validate(
    model: ForwardModel | Sequence[Experiment],
    data: Measurements | None = None,
    *,
    fit: Fit,
    leave_out: str = "blocks",
    blocks: int | None = None,
    executor: Executor = None,
) -> CrossValidation:
    """Fit a model again without each group of its data, and predict the group.

    Parameters
    ----------
    model : ForwardModel or sequence of Experiment
    data : Measurements, optional
        Left out with experiments, which have their own.
    fit : Fit
        Of all data, with which each search begins.
    leave_out : {"blocks", "experiments", "values"}
        Blocks of neighbouring samples with all their channels, whole experiments, or single values.
    blocks : int, optional
        Number of blocks of each record; without it ten, or fewer where residuals are correlated.
    executor : str or distributed.Client, optional
        Where batches are computed.

    Returns
    -------
    CrossValidation

    Raises
    ------
    InputError
        For a fit of segments, with a robust loss or without a Jacobian; where a group alone determines a parameter.
    SolveError
        If the model cannot be simulated.

    Notes
    -----
    The density of a group is that of the linearised model at the values identified without it: normal, or Student's t
    where the noise is estimated from the residuals. It includes the uncertainty of the parameters.

    Source: S. Arlot, A. Celisse, A survey of cross-validation procedures for model selection, Statistics Surveys 4
    (2010); P. Burman, E. Chow, D. Nolan, A cross-validatory method for dependent data, Biometrika 81 (1994).

    Examples
    --------
    >>> from dalembert import Measurements, PythonModel, identify
    >>> times = np.linspace(0.0, 1.0, 40)
    >>> line = PythonModel(lambda slope: slope * times, {"slope": (0.0, 3.0)}, ["x"], times)
    >>> data = Measurements.of(times, {"x": 2 * times + 0.1 * np.random.default_rng(0).standard_normal(40)})
    >>> found = cross_validate(line, data, fit=identify(line, data), blocks=5)
    >>> found.values.shape, round(found.rms, 2)
    ((5, 1), 0.09)
    """
    linearised("cross_validate", fit)  # refuses what has no predictive density
    numbers = groups(fit, leave_out, blocks)
    places = counted_groups(numbers)
    errors = np.full(numbers.size, np.nan)
    values_left_out = [np.zeros(0)] * len(places)
    densities, converged = np.zeros(len(places)), np.zeros(len(places), dtype=bool)
    for number, rows in enumerate(places):
        again = _again(model, data, fit, rows, leave_out, executor)
        errors[rows] = again.residuals.ravel()[rows]
        densities[number] = predicted_density(again, fit, rows)
        values_left_out[number], converged[number] = again.values, again.success
    errors, values = errors.reshape(numbers.shape), np.array(values_left_out)
    return CrossValidation(fit, leave_out, numbers, errors, densities, values, converged)


def _again(
    model: ForwardModel | Sequence[Experiment],
    data: Measurements | None,
    fit: Fit,
    rows: np.ndarray,
    leave_out: str,
    executor: Executor,
) -> Fit:
    """Return the fit without the values at ``rows``."""
    counted = fit.weights if fit.noise is None else np.where(fit.weights > 0, 1.0, 0.0)
    weights, without = counted.ravel().copy(), None
    if leave_out == "experiments":
        without = next(
            part.name
            for part in fit.parts
            if rows[0] // fit.weights.shape[1] in part.rows and rows[0] % fit.weights.shape[1] in part.columns
        )
    else:
        weights[rows] = 0.0
    table = weights.reshape(fit.weights.shape)
    kept_weights = {part.name: table[part.block] for part in fit.parts} if fit.parts else table
    return identify(
        model,
        data,
        weights=kept_weights,
        validation=without,
        noise=_noise_without(fit, without),
        start=fit.values,
        starts=1,
        horizon=None,
        executor=executor,
    )


def _noise_without(fit: Fit, experiment: str | None) -> Mapping[str, NoiseModel] | None:
    """The noise models of a fit, less those of an experiment that is left out."""
    if fit.noise is None:
        return None
    kept = {name: model for name, model in fit.noise.models.items() if name.partition(".")[0] != experiment}
    for name in fit.noise.models.keys() - kept.keys():
        noise_names = [item for item in fit.noise.parameters.names if item.startswith(f"{fit.noise.bases[name]}.")]
        if noise_names and fit.noise.bases[name] not in {fit.noise.bases[other] for other in kept}:
            raise InputError(
                f"cross_validate: only experiment {experiment!r} has {noise_names[0]!r}, so that its noise cannot be "
                "predicted; share the noise of the experiments, or leave out blocks"
            )
    return kept if experiment is not None else fit.noise.models


def predicted_density(again: Fit, fit: Fit, rows: np.ndarray) -> float:
    """Return the log predictive density of the values at ``rows``, which ``again`` was not fitted to."""
    assert again.jacobian is not None
    if again.noise is not None and fit.noise is not None:
        described = replace(again.noise, models=fit.noise.models, bases=fit.noise.bases)
        prediction = WithNoise(replace(again, noise=described), fit.weights).predicted(rows)
        if not np.isfinite(prediction):
            raise InputError(UNDETERMINED)
        return prediction
    known = fit.noise_is_known
    scale, free = again.parameters.scale, off_bounds(again.parameters, again.values)
    slopes = (again.jacobian.reshape(-1, len(scale)) * scale)[:, free]
    roots, kept = np.sqrt(fit.weights).ravel(), again.weights.ravel() > 0
    prior = prior_slopes(again.parameters, again.values, scale)[:, free]
    _, singular, directions = np.linalg.svd(
        np.concatenate([roots[kept, None] * slopes[kept], prior]), full_matrices=False
    )
    if len(singular) and (len(singular) < slopes.shape[1] or singular[-1] <= UNSEEN * singular[0]):
        raise InputError(UNDETERMINED)
    rows_left_out = roots[rows, None] * slopes[rows] @ (directions.T / singular)
    values, vectors = np.linalg.eigh(np.eye(len(rows)) + rows_left_out @ rows_left_out.T)
    residual = roots[rows] * again.residuals.ravel()[rows]
    square = float(np.sum((vectors.T @ residual) ** 2 / values))
    logs = float(np.sum(np.log(roots[rows]))) - 0.5 * float(np.sum(np.log(values)))
    if known:
        return logs + log_density(square, len(rows), 1.0, None)
    freedom = np.count_nonzero(kept) + len(prior) - np.count_nonzero(free)
    squares = float(np.sum((roots[kept] * again.residuals.ravel()[kept]) ** 2))
    return logs + log_density(square, len(rows), squares / freedom, float(freedom))


Compared = Fit | CrossValidation  # what models are compared by


def fits_of(models: Mapping[str, Compared]) -> dict[str, Fit]:
    """Return the fits of all data, by name."""
    return {name: model.fit if isinstance(model, CrossValidation) else model for name, model in models.items()}
