"""What every noise model of a channel provides."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from dalembert.arguments import Checked
from dalembert.errors import InputError, shown
from dalembert.inverse.noise.correlation.series import Series
from dalembert.inverse.noise.models.whitening import Whitening
from dalembert.parameter import Parameter

Known = float | tuple[float, float] | None
"""A parameter of the noise: its value, its bounds, or None for bounds that follow from the data."""


@dataclass(frozen=True)
class Extent:
    """Sizes of a channel's data, from which the bounds of noise parameters follow."""

    size: float  # standard deviation of the data, in their unit
    unit: str
    # step, length: smallest interval of the samples and duration of the record, in units of the coordinate
    step: float
    length: float
    along: str  # unit of the coordinate


@dataclass(frozen=True)
class NoiseModel(Checked):
    """Noise of one channel: normally distributed, with a standard deviation that may depend on the response.

    Parameters
    ----------
    local : bool
        Whether each of several experiments has noise parameters that only it has. Otherwise channels of the same name
        share them.
    """

    name: ClassVar[str]

    local: bool = False

    def parameters(self, extent: Extent) -> tuple[Parameter, ...]:
        """Return the parameters of the noise, with their names within the channel."""
        raise NotImplementedError

    def deviations(self, response: np.ndarray, known: np.ndarray, values: Mapping[str, np.ndarray]) -> np.ndarray:
        """Return the standard deviation of each value, shape (..., values).

        Parameters
        ----------
        response : array, shape (..., values)
        given : array, shape (values,)
            Known deviations of the data, W^-½.
        values : mapping by the names of :meth:`parameters`
            Each broadcasts against the response.
        """
        raise NotImplementedError

    def slopes(self, response: np.ndarray, known: np.ndarray, values: Mapping[str, np.ndarray]) -> np.ndarray:
        """Return the derivative of :meth:`deviations` with respect to the response, of the same shape."""
        return np.zeros_like(response)

    def guess(self, series: Series, residual: np.ndarray, response: np.ndarray) -> dict[str, float]:
        """Return first guesses of the parameters from residuals and responses (values,)."""
        return {}

    def whitening(self, series: Series) -> Whitening | None:
        """Return what makes standardised residuals of a series independent; None where they are.

        Raises
        ------
        InputError
            For samples that the process does not allow.
        """
        return None


def noise_parameter(
    owner: NoiseModel, name: str, known: Known, bounds: tuple[float, float], start: float, unit: str = "", *, log: bool
) -> Parameter:
    """Return a parameter of the noise with known bounds or value, or with default ``bounds`` and ``start``.

    ``log`` parameters are positive.
    """
    if known is None:
        return Parameter(name, *bounds, unit, start=float(np.clip(start, *bounds)), log=log)
    lower, upper = known if isinstance(known, tuple | list) else (known, known)
    if lower == upper:
        return Parameter(name, lower, upper, unit)
    inside = start if lower <= start <= upper else np.sqrt(lower * upper) if log else (lower + upper) / 2
    return Parameter(name, lower, upper, unit, start=float(inside), log=log)


def check_known(owner: NoiseModel, name: str, known: Known, *, zero: bool = False) -> None:
    """Refuse bounds that are reversed, and values that are not positive; a single value may be ``zero``."""
    if known is None:
        return
    lower, upper = known if isinstance(known, tuple | list) else (known, known)
    if not (0 < lower <= upper or (zero and lower == upper == 0)):
        raise InputError(
            f"{type(owner).__name__}: {name} is {shown(known)}; expected a positive number, or two of them, the lower "
            "one first"
        )
