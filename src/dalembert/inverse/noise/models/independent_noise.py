"""Independent noise: what its standard deviation is, and what it depends on."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from dalembert.inverse.noise.correlation.series import Series
from dalembert.inverse.noise.models.noise_model import Extent, Known, NoiseModel, check_known, noise_parameter
from dalembert.parameter import Parameter

BOUNDS = 1e-9, 10.0
"""Bounds of a deviation, relative to the size of the data or of the response."""

START = 0.05
"""First guess of the same."""


@dataclass(frozen=True)
class KnownNoise(NoiseModel):
    """Independent noise of the standard deviation that the data have.

    Parameters
    ----------
    local : bool
        Without effect: this noise has no parameters.
    """

    name: ClassVar[str] = "known"

    def parameters(self, extent: Extent) -> tuple[Parameter, ...]:
        return ()

    def deviations(self, response: np.ndarray, known: np.ndarray, values: Mapping[str, np.ndarray]) -> np.ndarray:
        return np.broadcast_to(known, response.shape)


@dataclass(frozen=True)
class ConstantNoise(NoiseModel):
    """Independent noise of one standard deviation σ, which is estimated.

    Parameters
    ----------
    local : bool
        Whether each experiment has its σ.
    deviation : float, (float, float) or None
        σ in the channel's unit: its value, or bounds between which it is estimated.

    Examples
    --------
    >>> ConstantNoise(deviation=(1e-4, 1e-2)).deviation
    (0.0001, 0.01)
    """

    name: ClassVar[str] = "constant"

    deviation: Known = None

    def __post_init__(self) -> None:
        check_known(self, "deviation", self.deviation)

    def parameters(self, extent: Extent) -> tuple[Parameter, ...]:
        return (_deviation(self, self.deviation, extent),)

    def deviations(self, response: np.ndarray, known: np.ndarray, values: Mapping[str, np.ndarray]) -> np.ndarray:
        return values["deviation"] + np.zeros_like(response)

    def guess(self, series: Series, residual: np.ndarray, response: np.ndarray) -> dict[str, float]:
        return {"deviation": _root_mean_square(residual)}


@dataclass(frozen=True)
class ProportionalNoise(NoiseModel):
    """Independent noise whose standard deviation is proportional to the response ŷ: ``σ = b |ŷ|``.

    Parameters
    ----------
    local : bool
        Whether each experiment has its b.
    relative : float, (float, float) or None
        b: its value, or bounds between which it is estimated.

    Notes
    -----
    A response that passes zero has no noise there, which data contradict: :class:`MixedNoise` is for such channels.
    """

    name: ClassVar[str] = "proportional"

    relative: Known = None

    def __post_init__(self) -> None:
        check_known(self, "relative", self.relative)

    def parameters(self, extent: Extent) -> tuple[Parameter, ...]:
        return (_relative(self, self.relative),)

    def deviations(self, response: np.ndarray, known: np.ndarray, values: Mapping[str, np.ndarray]) -> np.ndarray:
        return values["relative"] * response * np.sign(np.real(response))

    def slopes(self, response: np.ndarray, known: np.ndarray, values: Mapping[str, np.ndarray]) -> np.ndarray:
        return values["relative"] * np.sign(np.real(response))

    def guess(self, series: Series, residual: np.ndarray, response: np.ndarray) -> dict[str, float]:
        return {"relative": _root_mean_square(residual) / _root_mean_square(response)}


@dataclass(frozen=True)
class MixedNoise(NoiseModel):
    """Independent noise with a constant and a proportional part: σ² = a² + (b ŷ)², ŷ the response.

    Parameters
    ----------
    local : bool
        Whether each experiment has its a and b.
    deviation : float, (float, float) or None
        a in the channel's unit: its value, or bounds between which it is estimated.
    relative : float, (float, float) or None
        b, in the same way.

    Examples
    --------
    >>> noise = MixedNoise()
    >>> noise.deviations(np.array([0.0, 3.0]), np.ones(2), {"deviation": 0.4, "relative": 0.1}).round(12)
    array([0.4, 0.5])
    """

    name: ClassVar[str] = "mixed"

    deviation: Known = None
    relative: Known = None

    def __post_init__(self) -> None:
        check_known(self, "deviation", self.deviation, zero=True)
        check_known(self, "relative", self.relative, zero=True)

    def parameters(self, extent: Extent) -> tuple[Parameter, ...]:
        return _deviation(self, self.deviation, extent), _relative(self, self.relative)

    def deviations(self, response: np.ndarray, known: np.ndarray, values: Mapping[str, np.ndarray]) -> np.ndarray:
        return np.sqrt(values["deviation"] ** 2 + (values["relative"] * response) ** 2)

    def slopes(self, response: np.ndarray, known: np.ndarray, values: Mapping[str, np.ndarray]) -> np.ndarray:
        return values["relative"] ** 2 * response / self.deviations(response, known, values)

    def guess(self, series: Series, residual: np.ndarray, response: np.ndarray) -> dict[str, float]:
        size = _root_mean_square(residual) / np.sqrt(2)
        return {"deviation": size, "relative": size / _root_mean_square(response)}


def _root_mean_square(values: np.ndarray) -> float:
    """Return the root mean square, and not 0."""
    return max(float(np.sqrt(np.mean(values**2))), np.finfo(float).tiny)


def _deviation(owner: NoiseModel, known: Known, extent: Extent) -> Parameter:
    lower, upper, start = (part * extent.size for part in (*BOUNDS, START))
    return noise_parameter(owner, "deviation", known, (lower, upper), start, extent.unit, log=True)


def _relative(owner: NoiseModel, known: Known) -> Parameter:
    return noise_parameter(owner, "relative", known, BOUNDS, START, log=True)
