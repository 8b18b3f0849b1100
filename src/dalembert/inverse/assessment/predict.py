"""What a fitted model foretells, and how surely."""

from collections.abc import Iterator, Sequence

import numpy as np
from scipy.special import chdtri, ndtri

from dalembert.arguments import takes_checked
from dalembert.errors import require_known
from dalembert.findings import Finding
from dalembert.forward import ForwardModel
from dalembert.forward.provenance import provenance
from dalembert.inverse.assessment.prediction import Prediction
from dalembert.inverse.assessment.sensitivity import linearised
from dalembert.inverse.experiments.experiment import Experiment
from dalembert.inverse.fit.fit import Fit, check_level
from dalembert.inverse.least_squares.estimate import UNSEEN

EXCESSIVE = 0.001  # probability of noise as large as the residuals, below which their given deviation is too small
# Findings of the fit that concern its predictions, too.
INHERITED = ("correlated-residuals", "systematic-residuals", "model-misfit")


@takes_checked("level")
def predict(model: ForwardModel | Experiment, fit: Fit, level: float = 0.95) -> Prediction:
    """Response at identified parameters, with bands in which the true response, and a new measurement, are expected.

    Parameters
    ----------
    model : ForwardModel or Experiment
        Its parameters must be among the fit's: the model that was fitted, or one with other channels or over another
        horizon; or one of several experiments that were fitted.
    fit : Fit
    level : float
        Probability that the band holds the true value, sample by sample.

    Returns
    -------
    Prediction

    Raises
    ------
    InputError
        For a model with a parameter that was not identified, a fit of segments that did not merge into one run, or a
        level that is no probability.
    SolveError
        If the simulation fails.

    Notes
    -----
    The response's covariance is J C Jᵀ, with its jacobian J and the covariance C of the parameters. Bands are
    ± quantile × deviation, from the normal distribution where the noise is known, else from Student's t; with noise,
    a measurement's variance is added. C and that variance allow for correlated residuals, the variance also for
    residuals that are larger than their given deviation explains. A combination that the data
    did not see, but this response does, leaves the band infinitely wide.

    Bands follow from the linearised response. Where a band grows as wide on each side as the amplitude of its channel,
    as in chaotic motion, it ends: from there it is NaN, and a finding names the place.

    Examples
    --------
    The mean of four values with deviation 0.2 each is known to 0.1, and so is what comes next.

    >>> from dalembert.data import Measurements
    >>> from dalembert.forward import PythonModel
    >>> from dalembert.inverse import identify
    >>> model = PythonModel(lambda mean: mean + np.zeros(4), {"mean": (0.0, 2.0)}, ["x"], np.arange(4.0))
    >>> data = Measurements.of(np.arange(4.0), {"x": [0.9, 1.1, 1.2, 0.8]}, deviations=0.2)
    >>> told = predict(model, identify(model, data))
    >>> ((told.upper - told.lower) / 2).round(3)[0].tolist()
    [0.196]
    """
    check_level(level, "predict")
    fit.needs_one_run("predict")
    data, prefix = fit.data, ""
    if isinstance(model, Experiment):
        parameters, data, prefix, model = model.parameters, model.data, f"{model.name}.", model.model
    else:
        parameters = tuple(model.parameters)
    known = fit.parameters.names
    for item in parameters:
        require_known("parameter", item.name, known, "predict: the model has one that was not identified")
    wiring = np.array([known.index(item.name) for item in parameters], dtype=int)
    response, slopes = linearised(model, fit.values[wiring])
    jacobian = np.zeros((*response.shape, len(fit.values)))
    jacobian[:, :, wiring] = slopes
    names = tuple(channel.name for channel in model.channels)
    wraps = [prefix + name in fit.data.wraps for name in names]
    deviations, width = response_deviations(fit, jacobian), fit.quantile(level)
    ends = [
        band_end(width * slopes, column, wraps=turns)
        for slopes, column, turns in zip(deviations.T, response.T, wraps, strict=True)
    ]
    for column, end in enumerate(ends):
        deviations[len(response) if end is None else end :, column] = np.nan
    noise = [noise_deviations(fit, prefix + name, column) for name, column in zip(names, response.T, strict=True)]
    same = data.coordinate.name == model.coordinate.name and set(names) & set(data.channels)
    return Prediction(
        coordinate=model.coordinate,
        channels=names,
        units=tuple(channel.unit for channel in model.channels),
        response=response,
        deviations=deviations,
        noise=np.array([np.sqrt(np.mean(slopes**2)) for slopes in noise]),
        data=data if same else None,
        level=level,
        quantile=width,
        known=fit.noise_is_known,
        simulations=1 + len(wiring),
        provenance=provenance(model, level=level, data=fit.data.fingerprint),
        findings=(*(item for item in fit.findings if item.code in INHERITED), *_ended(model, names, ends)),
        noise_of_samples=np.array(noise).T if fit.noise is not None else None,
    )


def band_end(half_widths: np.ndarray, response: np.ndarray, *, wraps: bool = False) -> int | None:
    """Return the sample at which a band becomes as wide on each side as the response's amplitude, or None.
    ``half_widths``, ``response`` (samples,); ``wraps``: whether the channel is an angle known up to whole turns, of an
    amplitude of at most half a turn. The band must have been less than half as wide before: one that is wide from the
    start is of a badly known level, not of a motion that becomes unpredictable.
    """
    amplitude = min(float(np.ptp(response)) / 2, np.pi if wraps else np.inf)
    wide = np.flatnonzero(half_widths >= amplitude)
    if not len(wide) or not np.any(half_widths[: wide[0]] < amplitude / 2) or np.isinf(half_widths[wide[0]]):
        return None
    return int(wide[0])


def _ended(model: ForwardModel, names: Sequence[str], ends: Sequence[int | None]) -> Iterator[Finding]:
    along = model.coordinate
    for name, end in zip(names, ends, strict=True):
        if end is None:
            continue
        at = float(along.values[end])
        message = (
            f"The band of {name!r} ends at {f'{at:.4g} {along.unit}'.rstrip()}, where it is as wide as the motion. "
            "Beyond, these data do not predict the motion."
        )
        advice = "Predict a shorter time, or determine the initial state more exactly."
        yield Finding("band-ends", "warning", {"channel": name, "at": at}, message, advice)


def response_deviations(fit: Fit, jacobian: np.ndarray) -> np.ndarray:
    """Return standard deviations (samples, channels) of a response with a jacobian (samples, channels, parameters)."""
    singular, directions = fit.singular_values, fit.directions
    if not np.all(np.isfinite(singular)):
        return np.full(jacobian.shape[:2], np.nan)
    slopes = jacobian * fit.parameters.scale @ directions.T  # along each combination
    unseen = singular <= UNSEEN * (singular[0] or 1.0)
    spread = slopes[..., ~unseen] / singular[~unseen]
    lost = np.any(np.abs(slopes[..., unseen]) > 1e-6 * np.linalg.norm(slopes, axis=-1, keepdims=True), axis=-1)
    if fit.correlated is None:
        squares = fit.residual_variance * np.sum(spread**2, axis=-1)
    else:
        noise = fit.correlated.noise[np.ix_(~unseen, ~unseen)]
        squares = np.sum((spread @ noise) * spread, axis=-1)
    return np.where(lost, np.inf, np.sqrt(squares))


def noise_deviations(fit: Fit, channel: str, response: np.ndarray) -> np.ndarray:
    """Return the standard deviation of a channel's noise at a response, both (samples,); NaN if it was not measured.

    A channel of an experiment that was not fitted has the noise of the same channel in the experiments that were.
    """
    if channel not in fit.data.channels:
        return np.full(response.shape, np.nan)
    column = fit.data.channels.index(channel)
    squares = [_noise_at(fit, like, column, response) ** 2 for like in _fitted(fit, column)]
    return np.sqrt(np.mean(squares, axis=0))


def _noise_at(fit: Fit, column: int, wanted: int, response: np.ndarray) -> np.ndarray:
    if fit.noise is None:
        return np.full(response.shape, _noise(fit, column, wanted))
    known = np.nan if fit.data.deviations is None else float(fit.data.deviations[wanted])
    return fit.noise.sizes(fit.data.channels[column], response, known)


def _fitted(fit: Fit, column: int) -> list[int]:
    """Columns with fitted values of the same channel: the column itself, or those of other experiments."""
    names = {place: name for part in fit.parts for place, name in zip(part.columns, part.channels, strict=True)}
    seen = np.any(fit.weights > 0, axis=0)
    alike = [place for place, name in names.items() if seen[place] and name == names.get(column)]
    return [column] if seen[column] or not alike else alike


def _noise(fit: Fit, column: int, wanted: int) -> float:
    """Deviation of the noise in a column, in proportion to the given one of the wanted column."""
    processes = () if fit.correlated is None else fit.correlated.processes
    process = next((item for item in processes if item.channel == fit.data.channels[column]), None)
    weights = fit.weights[:, column]
    if fit.data.deviations is not None and process is None:
        return float(fit.data.deviations[wanted]) * _excess(fit, column)
    if not np.any(weights > 0):
        return np.nan
    of_channel = (
        fit.residual_variance
        if process is None
        else max(process.variance, fit.residual_variance if fit.noise_is_known else 0.0)
    )
    return float(np.sqrt(of_channel / np.mean(weights[weights > 0])))


def _excess(fit: Fit, column: int) -> float:
    """Residuals of a channel over their given deviation, 1 where noise explains them: the root mean square. With a
    robust loss it is the median over that of the normal distribution, which outliers do not change; its standard error
    is 1.17/√n.
    """
    compared = fit.weights[:, column] > 0
    count = np.count_nonzero(compared)
    ratios = np.abs(fit.residuals[compared, column]) / fit.data.deviations[column]  # pyright: ignore[reportOptionalSubscript]
    if not count:
        return 1.0
    if "loss" in fit.provenance:
        size = float(np.median(ratios) / ndtri(0.75))
        return size if size > 1 - 1.17 / np.sqrt(count) * ndtri(EXCESSIVE) else 1.0
    squares = float(ratios @ ratios)
    return float(np.sqrt(squares / count)) if squares > chdtri(count, EXCESSIVE) else 1.0
