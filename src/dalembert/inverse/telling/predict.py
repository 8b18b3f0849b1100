"""What a fitted model foretells, and how surely."""

import numpy as np

from dalembert.errors import InputError, unknown
from dalembert.forward import ForwardModel
from dalembert.forward.provenance import provenance
from dalembert.inverse.confidence import check_level, noise_is_known, quantile, variance
from dalembert.inverse.estimate import UNSEEN
from dalembert.inverse.experiments import Experiment
from dalembert.inverse.fit import Fit
from dalembert.inverse.telling.prediction import Prediction
from dalembert.inverse.telling.sensitivity import linearised


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
    a measurement's variance is added. A combination that the data did not see, but this response does, leaves the band
    infinitely wide.

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
    wiring = _wiring([item.name for item in parameters], fit)
    response, own = linearised(model, fit.values[wiring])
    jacobian = np.zeros((*response.shape, len(fit.values)))
    jacobian[:, :, wiring] = own
    names = tuple(channel.name for channel in model.channels)
    same = data.coordinate.name == model.coordinate.name and set(names) & set(data.channels)
    return Prediction(
        coordinate=model.coordinate,
        channels=names,
        units=tuple(channel.unit for channel in model.channels),
        response=response,
        deviations=_deviations(fit, jacobian),
        noise=np.array([_noise(fit, prefix + name) for name in names]),
        data=data if same else None,
        level=level,
        quantile=quantile(fit, level),
        known=noise_is_known(fit),
        simulations=1 + len(wiring),
        provenance=provenance(model, level=level, data=fit.data.fingerprint),
    )


def _wiring(names: list[str], fit: Fit) -> np.ndarray:
    """Where parameters stand among the identified ones."""
    known = fit.parameters.names
    for name in names:
        if name not in known:
            raise InputError(unknown("parameter", name, known, "predict: the model has one that was not identified"))
    return np.array([known.index(name) for name in names], dtype=int)


def _deviations(fit: Fit, jacobian: np.ndarray) -> np.ndarray:
    """Standard deviations (samples, channels) of a response with this jacobian (samples, channels, parameters)."""
    singular, directions = fit.singular_values, fit.directions
    if not np.all(np.isfinite(singular)):
        return np.full(jacobian.shape[:2], np.nan)
    slopes = jacobian * fit.parameters.scale @ directions.T  # along each combination
    unseen = singular <= UNSEEN * (singular[0] or 1.0)
    spread = slopes[..., ~unseen] / singular[~unseen]
    lost = np.any(np.abs(slopes[..., unseen]) > 1e-6 * np.linalg.norm(slopes, axis=-1, keepdims=True), axis=-1)
    return np.where(lost, np.inf, np.sqrt(variance(fit) * np.sum(spread**2, axis=-1)))


def _noise(fit: Fit, channel: str) -> float:
    """Standard deviation of a channel's noise; NaN for one that was not measured."""
    if channel not in fit.data.channels:
        return np.nan
    column = fit.data.channels.index(channel)
    if fit.data.deviations is not None:
        return float(fit.data.deviations[column])
    weights = fit.weights[:, column]
    return float(np.sqrt(variance(fit) / np.mean(weights[weights > 0]))) if np.any(weights > 0) else np.nan
