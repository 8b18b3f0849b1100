"""Correlated noise: what neighbouring samples have in common."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from dalembert.errors import InputError, shown
from dalembert.inverse.noise.correlation.autoregression import levinson
from dalembert.inverse.noise.correlation.series import Series
from dalembert.inverse.noise.correlation.whiteness import lagged, on_grid, pairs
from dalembert.inverse.noise.models.independent_noise import ConstantNoise
from dalembert.inverse.noise.models.noise_model import Extent, Known, NoiseModel, check_known, noise_parameter
from dalembert.inverse.noise.models.whitening import DecayWhitening, GridWhitening, Whitening, correlations_of
from dalembert.parameter import Parameter

LARGEST = 0.9999
"""Largest partial autocorrelation."""

STRONGEST = 0.95
"""Largest autocorrelation of a first guess."""

SAMPLES = 10
"""Fewest samples for each order of a process."""


@dataclass(frozen=True)
class CorrelatedNoise(NoiseModel):
    """Noise whose standardised values are correlated; its deviation is that of an independent model."""

    deviation: NoiseModel = field(default_factory=ConstantNoise)

    def __post_init__(self) -> None:
        kind = type(self).__name__
        if isinstance(self.deviation, CorrelatedNoise):
            raise InputError(f"{kind}: deviation is {shown(self.deviation)}; expected a model of independent noise")
        if self.deviation.local:
            raise InputError(f"{kind}: local is an argument of {kind}, not of its deviation; give it there")

    def parameters(self, extent: Extent) -> tuple[Parameter, ...]:
        return self.deviation.parameters(extent)

    def deviations(self, response: np.ndarray, known: np.ndarray, values: Mapping[str, np.ndarray]) -> np.ndarray:
        return self.deviation.deviations(response, known, values)

    def slopes(self, response: np.ndarray, known: np.ndarray, values: Mapping[str, np.ndarray]) -> np.ndarray:
        return self.deviation.slopes(response, known, values)

    def guess(self, series: Series, residual: np.ndarray, response: np.ndarray) -> dict[str, float]:
        return self.deviation.guess(series, residual, response)


@dataclass(frozen=True)
class AutoregressiveNoise(CorrelatedNoise):
    """Autoregressive noise of even samples: e_t = Σ_j φ_j e_{t−j} + white noise, with gaps or without.

    Parameters
    ----------
    local : bool
        Whether each experiment has its noise parameters.
    deviation : NoiseModel
        Model of the standard deviation σ of e; the process describes e/σ.
    order : int, optional
        Number of coefficients; chosen by the corrected Akaike criterion (AICc) if not given.
    partial : tuple of float, optional
        Fixed partial autocorrelations, as many as the order. Otherwise they are estimated.

    Notes
    -----
    The parameters are the partial autocorrelations, ``partial1`` and so on: each process with values between −1 and 1
    is stationary. For order 1 the only one is φ; otherwise φ follows by Durbin's recursion.

    Source: O. Barndorff-Nielsen, G. Schou, On the parametrization of autoregressive models by partial autocorrelations,
    Journal of Multivariate Analysis 3 (1973).

    Examples
    --------
    >>> AutoregressiveNoise(order=2).order
    2
    """

    name: ClassVar[str] = "autoregressive"

    order: int | None = None
    partial: tuple[float, ...] | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.partial is not None:
            wrong = next((number for number in self.partial if not -1 < number < 1), None)
            if wrong is not None:
                raise InputError(f"AutoregressiveNoise: partial has {shown(wrong)}; expected numbers between -1 and 1")
            object.__setattr__(self, "partial", tuple(map(float, self.partial)))
            if self.order is None:
                object.__setattr__(self, "order", len(self.partial))
            elif self.order != len(self.partial):
                raise InputError(
                    f"AutoregressiveNoise: order is {self.order}, but partial has {len(self.partial)} numbers; give as "
                    "many"
                )
        if self.order is not None and self.order < 0:
            raise InputError(f"AutoregressiveNoise: order is {self.order}; expected a whole number, at least 0")

    def parameters(self, extent: Extent) -> tuple[Parameter, ...]:
        fixed = self.partial or (None,) * (self.order or 0)
        partials = [
            noise_parameter(self, f"partial{number}", known, (-LARGEST, LARGEST), 0.0, log=False)
            for number, known in enumerate(fixed, start=1)
        ]
        return (*self.deviation.parameters(extent), *partials)

    def whitening(self, series: Series) -> Whitening | None:
        where = f"noise of channel {series.name!r}"
        if series.grid is None:
            raise InputError(
                f"{where}: AutoregressiveNoise needs evenly spaced samples, gaps allowed; take "
                "OrnsteinUhlenbeckNoise() for uneven ones"
            )
        if self.order is None:
            raise InputError(
                f"{where}: the order of AutoregressiveNoise is open; give it, or take the noise of a fit, which "
                "chose it"
            )
        if len(series.rows) < SAMPLES * self.order:
            raise InputError(
                f"{where}: AutoregressiveNoise of order {self.order} needs {SAMPLES * self.order} samples, but there "
                f"are {len(series.rows)}; lower the order"
            )
        return GridWhitening(series.grid, self.order, self._correlations) if self.order else None

    def guess(self, series: Series, residual: np.ndarray, response: np.ndarray) -> dict[str, float]:
        guesses = super().guess(series, residual, response)
        order = self.order or 0
        if self.partial is None and order and np.any(residual):
            assert series.grid is not None
            count, on_grid_values = np.maximum(pairs(series.grid, order), 1), on_grid(series.grid, residual)
            covariances = np.array([lagged(on_grid_values, on_grid_values, lag) for lag in range(order + 1)]) / count
            rows, _ = levinson(covariances, STRONGEST)
            guesses |= {f"partial{k}": float(row[-1]) for k, row in enumerate(rows, start=1)}
        return guesses

    def _correlations(self, values: Mapping[str, np.ndarray], number: int) -> np.ndarray:
        return correlations_of([values[f"partial{k}"] for k in range(1, (self.order or 0) + 1)], number)


@dataclass(frozen=True)
class OrnsteinUhlenbeckNoise(CorrelatedNoise):
    """Noise whose correlation decays exponentially, exp(−Δt/τ), for uneven samples and even ones.

    Parameters
    ----------
    local : bool
        Whether each experiment has its noise parameters.
    deviation : NoiseModel
        Model of the standard deviation σ of the noise e; the process describes e/σ.
    time : float, (float, float) or None
        Correlation time τ in the unit of the coordinate: its value, or bounds between which it is estimated.

    Notes
    -----
    Source: G. E. Uhlenbeck, L. S. Ornstein, On the theory of the Brownian motion, Physical Review 36 (1930).
    """

    name: ClassVar[str] = "ornstein-uhlenbeck"

    time: Known = None

    def __post_init__(self) -> None:
        super().__post_init__()
        check_known(self, "time", self.time)

    def parameters(self, extent: Extent) -> tuple[Parameter, ...]:
        bounds = extent.step / 10, max(extent.length, extent.step)
        time = noise_parameter(self, "time", self.time, bounds, 2 * extent.step, extent.along, log=True)
        return (*self.deviation.parameters(extent), time)

    def guess(self, series: Series, residual: np.ndarray, response: np.ndarray) -> dict[str, float]:
        guesses = super().guess(series, residual, response)
        squares = float(residual @ residual)
        if self.time is None and len(residual) > 1 and squares > 0:
            first = np.clip(float(residual[1:] @ residual[:-1]) / squares, 1 - STRONGEST, STRONGEST)
            guesses["time"] = float(-series.step / np.log(first))
        return guesses

    def whitening(self, series: Series) -> Whitening | None:
        return DecayWhitening(np.diff(series.along)) if len(series.rows) > 1 else None
