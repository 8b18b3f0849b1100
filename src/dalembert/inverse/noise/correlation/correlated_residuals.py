"""What is known of correlated residuals of a fit."""

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from dalembert.stored_fields import Over

LONG = 0.3
"""Part of the motion's period from which a correlation time is that of the motion, which decorrelates in a quarter."""


CLEAR = 0.001
"""Probability in white noise from which correlated residuals may be systematic."""


@dataclass(frozen=True)
class NoiseProcess:
    """The autoregressive process fitted to the residuals of one channel.

    Parameters
    ----------
    channel : str
    p_value : float
        Probability of such correlations in white noise.
    first : float
        Autocorrelation of neighbouring samples; of uneven samples at their median interval.
    order : int
        Of the process, by AICc; 1 for the Ornstein–Uhlenbeck process of uneven samples.
    even : bool
        Whether the samples are even, gaps left out.
    variance : float
        Of a weighted residual.
    time : float
        Correlation time: that in which the slowest part of the autocorrelation of the process, or of that of first
        order if it leaves white noise, decays by e; at most the length of the record, in the coordinate's unit.
    period : float
        Of the response, 2π times its deviation over that of its rate, at most a third of the record, in the
        coordinate's unit.
    unit : str
        Of the coordinate.
    first_order : bool
        Whether a process of first order leaves white noise.
    detected : bool
        Whether the tests take the channel for correlated. Weaker signs only enter the standard deviations.
    degrees : float
        Degrees of freedom of the variance of a slow combination of the samples, which the process predicts.
    """

    channel: str
    p_value: float
    first: float
    order: int
    even: bool
    variance: float
    time: float
    period: float
    unit: str
    first_order: bool = False
    detected: bool = True
    degrees: float = np.inf

    @property
    def systematic(self) -> bool:
        """Whether the correlation lasts as long as the motion's own, so that the residuals are no noise.

        Noise of first order may be correlated that long, but not over a period.
        """
        return self.p_value < CLEAR and self.time >= (self.period if self.first_order else LONG * self.period)


@dataclass(frozen=True, eq=False)
class CorrelatedResiduals:
    """Noise processes of the channels whose residuals are correlated, and the deviations without the correction.

    Parameters
    ----------
    processes : tuple of NoiseProcess
    deviations : array, shape (parameters,)
        For independent residuals: plain standard deviations from s² (JᵀWJ)⁻¹.
    correlation : array, shape (parameters, parameters)
        For independent residuals.
    noise : array, shape (parameters, parameters)
        Covariance UᵀΣU of the weighted noise along the left singular vectors U of W^½ ∂R/∂p · scale; s² times the unit
        matrix where residuals are independent.
    """

    processes: tuple[NoiseProcess, ...]
    deviations: Annotated[np.ndarray, Over("parameter", name="plain_deviations")]
    correlation: Annotated[np.ndarray, Over("parameter", "parameter_", name="plain_correlation")]
    noise: Annotated[np.ndarray, Over("combination", "combination_", name="noise_of_combinations")]

    @property
    def detected(self) -> tuple[NoiseProcess, ...]:
        """Processes of the channels that the tests take for correlated."""
        return tuple(process for process in self.processes if process.detected)
