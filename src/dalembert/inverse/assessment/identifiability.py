"""Which parameters data would determine, before anything is solved."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from dalembert.arguments import takes_checked
from dalembert.data import Measurements
from dalembert.errors import InputError
from dalembert.forward import ForwardModel
from dalembert.inverse.assessment.sensitivity import at_of, linearised, noise_of
from dalembert.inverse.least_squares.estimate import Identifiability, estimate
from dalembert.inverse.least_squares.identifiable import foreseen
from dalembert.inverse.problem.matching import check_samples, columns_of
from dalembert.inverse.problem.prior import prior_slopes


@takes_checked()
def identifiability(
    model: ForwardModel,
    at: Mapping[str, float] | ArrayLike | None = None,
    *,
    data: Measurements | None = None,
    deviations: Mapping[str, float] | ArrayLike | None = None,
) -> Identifiability:
    """Return which parameters measurements determine, from one run with its sensitivities.

    Parameters
    ----------
    model : ForwardModel
    at : mapping by name, or array of shape (parameters,), optional
        Values of the parameters; the first guesses if not given. The result holds near these values.
    data : Measurements, optional
        Existing data. Only their channels, gaps and deviations are used, not their values.
    deviations : number, mapping by channel, or array of shape (channels,), optional
        Standard deviations of the noise of future data, in SI units; a mapping names the measured channels.

    Returns
    -------
    Identifiability
        Singular values of W^½ ∂R/∂p · scale, the combinations that they belong to, the deviations to be expected (NaN
        where the noise is not known), their correlation, and findings.

    Raises
    ------
    InputError
        For data and deviations at once, an unknown channel or parameter.
    DataError
        For data that do not fit the model.
    SolveError
        If the simulation fails.

    Examples
    --------
    Of a decay of unknown height, gain and rate, only a combination of height and gain is identifiable.

    >>> from dalembert.forward import PythonModel
    >>> times = np.linspace(0, 2, 21)
    >>> box = {"rate": (0.5, 2.0), "height": (0.1, 1.0), "gain": (0.5, 2.0)}
    >>> model = PythonModel(lambda rate, height, gain: gain * height * np.exp(-rate * times), box, ["x"], times)
    >>> finding, *_ = identifiability(model, deviations=1e-3).findings
    >>> finding.code, finding.values["parameters"]
    ('unidentifiable-combination', 'height, gain')
    """
    if data is not None and deviations is not None:
        raise InputError("identifiability: data and deviations were given; expected one of them")
    vector, parameters = at_of(model, at, "identifiability"), model.parameters
    if data is not None:
        columns = columns_of(model, data)
        check_samples(model, data)
        weights, known = data.present.astype(float), data.deviations is not None
        noise = data.deviations if data.deviations is not None else np.ones(len(columns))
    else:
        known = deviations is not None
        _, columns, noise = noise_of(model, 1.0 if deviations is None else deviations, "identifiability")
        weights = np.ones((len(model.coordinate.values), len(columns)))
    slopes = (np.sqrt(weights) / noise)[:, :, None] * linearised(model, vector)[1][:, columns] * parameters.scale
    prior = [prior_slopes(parameters, vector, parameters.scale)] if known else []
    rows = [slopes.reshape(-1, len(vector)), *prior]
    estimated = estimate(np.concatenate(rows), parameters.scale, 1.0 if known else np.nan)
    findings = tuple(foreseen(parameters, estimated, noise_known=known))
    return Identifiability(
        estimated.singular_values, estimated.directions, findings, estimated.deviations, estimated.correlation
    )
