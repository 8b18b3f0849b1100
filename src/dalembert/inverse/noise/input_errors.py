"""Errors of a measured input as parameters with priors."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from dalembert.argument_readers import samples_of
from dalembert.arguments import is_number, takes_checked
from dalembert.errors import InputError, shown
from dalembert.parameter import Parameter

WIDEST = 6.0
"""Bounds of an error, in standard deviations."""


@dataclass(frozen=True, eq=False)
class InputErrors:
    """A spline through unknown errors of a measured input.

    Parameters
    ----------
    parameters : tuple of Parameter
        The error at each knot, ``"NAME.error1"`` and so on, each with a normal prior of mean 0.
    basis : array, shape (samples, knots)
        Values of the spline at the samples for an error of 1 at each knot.
    """

    parameters: tuple[Parameter, ...]
    basis: np.ndarray

    def values(self, known: Mapping[str, Any]) -> np.ndarray:
        """Return the errors at the samples (samples,) for values of the parameters by name; others are ignored."""
        return self.basis @ np.array([known[item.name] for item in self.parameters])


@takes_checked("samples", "knots", "deviation")
def input_errors(
    name: str, samples: ArrayLike, *, deviation: float, knots: ArrayLike | int | None = None, unit: str = ""
) -> InputErrors:
    """Parameters for the errors of a measured input, so that it is estimated with the parameters of a model.

    Parameters
    ----------
    name : str
        Of the input; parameters are called ``"NAME.error1"`` and so on.
    samples : array, shape (samples,)
        Where the input was measured, increasing.
    deviation : float
        Standard deviation of the input's noise.
    knots : array, shape (knots,), or int, optional
        Where errors are parameters, or how many such places, evenly spaced. At each sample if not given, which is right
        for noise that is independent from sample to sample. Few knots describe a slow drift.
    unit : str
        Of the input.

    Returns
    -------
    InputErrors

    Raises
    ------
    InputError
        For a deviation that is not positive, samples or knots that do not increase, fewer than two knots.

    Notes
    -----
    With the measured input u and its errors e, which have the priors N(0, deviation²), the fit of a model with the
    input u + e makes Σ (y − ŷ(u + e))²/σ² + Σ e²/deviation² least. The estimate of a gain is then free of the
    attenuation that a fit with the measured input has. It needs the deviations of input and output: the ratio of the
    two cannot be estimated.

    Source: W. A. Fuller, Measurement Error Models, 1987, section 1.3.

    Examples
    --------
    >>> errors = input_errors("force", [0.0, 0.1, 0.2], deviation=0.5, unit="N")
    >>> errors.parameters[0].name, errors.parameters[0].deviation
    ('force.error1', 0.5)
    >>> errors.values({"force.error1": 0.1, "force.error2": 0.0, "force.error3": -0.2}).tolist()
    [0.1, 0.0, -0.2]
    """
    from scipy.interpolate import make_interp_spline

    places = _increasing(samples, "samples")
    if not is_number(deviation) or np.iscomplexobj(deviation) or not deviation > 0:
        raise InputError(f"input_errors: deviation is {shown(deviation)}; expected a positive number")
    if isinstance(knots, int):
        if knots < 2:
            raise InputError(f"input_errors: knots is {knots}; expected at least 2")
        knots = np.linspace(places[0], places[-1], knots)
    ends = places if knots is None else _increasing(knots, "knots")
    degree = min(3, len(ends) - 1)
    exact = np.eye(len(ends))
    basis = exact if knots is None else make_interp_spline(ends, exact, k=degree)(places)
    bound = WIDEST * float(deviation)
    parameters = tuple(
        Parameter(f"{name}.error{number}", -bound, bound, unit, start=0.0, deviation=float(deviation))
        for number in range(1, len(ends) + 1)
    )
    return InputErrors(parameters, np.asarray(basis))


def _increasing(numbers: ArrayLike | Sequence[float], what: str) -> np.ndarray:
    values = samples_of(numbers, "input_errors", what)
    if len(values) < 2 or not np.all(np.diff(values) > 0):
        raise InputError(f"input_errors: {what} are {shown(numbers)}; expected at least two increasing numbers")
    return values
