"""Residuals of one channel of one experiment, as figures show them and tests judge them."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.special import ndtri

from dalembert.inverse.diagnostics.noise_tests import growth
from dalembert.inverse.noise.correlation.series import Series
from dalembert.inverse.noise.correlation.whiteness import lagged, on_grid, p_value_of_period

LAGS = 40
"""Most lags of an autocorrelation."""

FREQUENCIES = 2000
"""Most frequencies of the spectrum of uneven samples."""


@dataclass(frozen=True, eq=False)
class SeriesResiduals:
    """Residuals of the fitted values of one channel.

    Parameters
    ----------
    series : Series
        Where the values stand: experiment, channel, coordinate.
    response, residuals : array, shape (values,)
        Computed values R, and R − data, in the unit of the channel.
    standardised : array, shape (values,)
        Residual over its standard deviation s √(1 − h), with the deviation s of the channel from its residuals and the
        leverage h. NaN where h = 1. If the noise of several channels is not known, the residuals are those of a fit
        that weights each channel by its noise.
    deleted : array, shape (values,)
        The same with the deviation from all other values of the channel (externally studentised).
    leverage, distance : array, shape (values,)
        See :class:`~dalembert.inverse.diagnostics.influence.Influence`. NaN without a Jacobian.
    changes : array, shape (values, parameters)
        DFBETAS; NaN without a Jacobian.
    deviation : float
        Standard deviation s of a weighted residual.
    correlated : bool
        Whether the residuals are correlated, so that only their autocorrelation, a periodic part and their size are
        tested.
    memory : float
        Autocorrelation of neighbours of correlated noise; 0 of independent residuals, NaN of those that are no noise.
    p_values : mapping
        Probability of each test in independent noise, by ``"autocorrelation"``, ``"runs"``, ``"normality"``,
        ``"period"``, ``"size over response"`` and ``"size over coordinate"``. Tests that were not made are left out.
    """

    series: Series
    response: np.ndarray
    residuals: np.ndarray
    standardised: np.ndarray
    deleted: np.ndarray
    leverage: np.ndarray
    distance: np.ndarray
    changes: np.ndarray
    deviation: float
    correlated: bool
    memory: float
    p_values: Mapping[str, float]

    @property
    def name(self) -> str:
        """The channel; with several experiments ``"NAME.channel"``."""
        return self.series.name

    def autocorrelation(self, lags: int = LAGS) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return lags in the unit of the coordinate, autocorrelations, and their 95 % limits, all of shape (lags,).

        Uneven samples count at the nearest multiple of their median interval. Lags without pairs are left out. The
        limit is 1.96 over the root of the number of pairs.

        Examples
        --------
        See :meth:`~dalembert.inverse.Fit.diagnostics`.
        """
        values = np.nan_to_num(self.standardised)
        most = max(1, min(lags, len(values) // 4))
        along = self.series.along / self.series.step if self.series.grid is None else self.series.grid
        sums, count = np.zeros(most + 1), np.zeros(most + 1)
        for apart in range(1, len(values)):
            lag = np.rint(along[apart:] - along[:-apart]).astype(int)
            near = lag <= most
            if not np.any(near):
                break
            np.add.at(sums, lag[near], (values[apart:] * values[:-apart])[near])
            np.add.at(count, lag[near], 1.0)
        there = np.flatnonzero(count[1:] > 0) + 1
        correlations = sums[there] / count[there] * len(values) / max(values @ values, np.finfo(float).tiny)
        return there * self.series.step, correlations, 1.96 / np.sqrt(count[there])

    def spectrum(self) -> tuple[np.ndarray, np.ndarray]:
        """Return frequencies, in cycles per unit of the coordinate, and the power over its mean, both (frequencies,).

        Periodogram of even samples, with zeros in gaps; Lomb–Scargle periodogram of uneven ones, up to half a cycle in
        the median interval.
        """
        values, grid = np.nan_to_num(self.standardised), self.series.grid
        values = values - np.mean(values)
        if grid is not None:
            table = on_grid(grid, values)
            frequencies, power = np.fft.rfftfreq(len(table), self.series.step)[1:], np.abs(np.fft.rfft(table)[1:]) ** 2
        else:
            from scipy.signal import lombscargle

            count = min(FREQUENCIES, len(values) // 2)
            frequencies = np.linspace(1 / self.series.length, 0.5 / self.series.step, count)
            power = lombscargle(self.series.along, values, 2 * np.pi * frequencies)
        return frequencies, power / max(float(np.mean(power)), np.finfo(float).tiny)

    def periodic_part(self, fitted: float = 0.0) -> tuple[float, float, float]:
        """Return the probability of the strongest periodic part in noise, its frequency, and its share of the power.

        Even samples only; ``fitted`` is the number of parameters that the fit took out of the values. Correlated
        residuals are first whitened as noise of first order, so that only what stands out of it counts.
        """
        assert self.series.grid is not None
        table = on_grid(self.series.grid, np.nan_to_num(self.standardised))
        if self.correlated:
            first = max(0.0, lagged(table, table, 1) / lagged(table, table, 0))
            table = table[1:] - first * table[:-1]
        power = np.abs(np.fft.rfft(table - np.mean(table))[1:]) ** 2
        frequency = float(np.fft.rfftfreq(len(table), self.series.step)[1 + np.argmax(power)])
        frequencies, plain = self.spectrum()
        near = int(np.argmin(np.abs(frequencies - frequency)))
        return p_value_of_period(table, fitted), frequency, float(plain[near] / np.sum(plain))

    def growth(self, quantity: np.ndarray) -> tuple[float, float]:
        """Return the correlation of the sizes of residuals with a quantity (values,), and its probability in noise.

        Correlated residuals are whitened as noise of first order.
        """
        values = self.standardised
        if self.memory:
            factors = np.sign(self.memory) * np.abs(self.memory) ** (np.diff(self.series.along) / self.series.step)
            values = np.concatenate([[np.nan], (values[1:] - factors * values[:-1]) / np.sqrt(1 - factors**2)])
        finite = np.isfinite(values)
        return growth(np.abs(values[finite]), quantity[finite])

    def normal_quantiles(self) -> tuple[np.ndarray, np.ndarray]:
        """Return quantiles of the normal distribution, and the sorted standardised residuals, both (values,).

        Source: G. Blom, Statistical Estimates and Transformed Beta-Variables (1958), for the plotting positions.
        """
        values = np.sort(self.standardised[np.isfinite(self.standardised)])
        shares = (np.arange(1, len(values) + 1) - 0.375) / (len(values) + 0.25)
        return ndtri(shares), values
