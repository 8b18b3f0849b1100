"""The covariance of weighted residuals, as far as they are correlated."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from dalembert.inverse.least_squares.estimate import estimate, left_vectors, unknown_estimate
from dalembert.inverse.noise.correlation.autoregression import Autoregression, moments
from dalembert.inverse.noise.correlation.balanced import balanced
from dalembert.inverse.noise.correlation.correlated_residuals import CorrelatedResiduals, NoiseProcess
from dalembert.inverse.noise.correlation.ornstein_uhlenbeck import OrnsteinUhlenbeck, ornstein_uhlenbeck
from dalembert.inverse.noise.correlation.series import Series, series_of
from dalembert.inverse.noise.correlation.whiteness import LEVEL, is_first_order, p_value
from dalembert.inverse.problem.problem import MisfitProblem

ROUNDS = 4
"""Corrections of the autocovariances for the parameters that were fitted; each reduces the bias by an order of 1/n."""

SMALL = 0.5
"""Part of the given variance below which residuals are small: the remainder then counts as independent noise."""

WEAK = 0.05
"""Probability with which white noise shows signs of correlation that enter the covariance, over all series of a fit."""

SLIGHT = 1.1
"""Ratio of corrected to plain deviations up to which small residuals are not corrected for."""

Process = Autoregression | OrnsteinUhlenbeck


def correlation(
    problem: MisfitProblem,
    response: np.ndarray,
    slopes: np.ndarray | None,
    residual: np.ndarray,
    variance: float,
    *,
    known: bool,
) -> CorrelatedResiduals | None:
    """Return what is known of correlated residuals at a minimum; None where the tests take them for white noise.

    Parameters
    ----------
    problem : MisfitProblem
    response : array, shape (samples, channels)
    slopes : array, shape (values + priors, parameters)
        W^½ ∂R/∂p · scale, one row a value of (samples, channels), then one a prior. None without a jacobian.
    residual : array, shape (values,)
        Weighted residuals; with a robust loss their influence.
    variance : float
        s² of a weighted residual.
    known : bool
        Whether it follows from given deviations.

    Notes
    -----
    The covariance of the estimate is (JᵀWJ)⁻¹ JᵀW Σ W J (JᵀWJ)⁻¹, with the covariance Σ of processes fitted to each
    correlated channel, and s² for the others. The tests together take white noise for correlated once in a hundred
    fits. Short records hide correlation from them, so that weaker signs, which white noise shows in one of twenty fits,
    enter the covariance, too.

    Source: H. White, I. Domowitz, Nonlinear regression with dependent observations, Econometrica 52 (1984).
    """
    if not variance > 0:
        return None
    scale = problem.model.parameters.scale
    number = len(scale)
    basis = np.zeros((len(residual), number)) if slopes is None else left_vectors(slopes)
    series = list(series_of(problem))
    equal = known or problem.loss is not None
    tested = (residual, basis) if equal else balanced(series, residual, basis)
    correlated = correlated_series(series, *tested, WEAK)
    if not correlated:
        return None
    fitted = fitted_processes(list(correlated), residual, basis, variance)
    processes = tuple(
        replace(process, detected=process.p_value < LEVEL / len(series))
        for process in summaries(correlated, fitted, response, *tested)
    )
    if slopes is None:
        nothing = unknown_estimate(number)
        return CorrelatedResiduals(processes, nothing.deviations, nothing.correlation, nothing.correlation)
    noise = noise_along(fitted, basis, variance)
    for (signal, process), summary in zip(fitted, processes, strict=True):
        noise += _remainder(
            process.product(signal, basis[signal.rows]), basis[signal.rows], variance, summary, known=known
        )
    plain, corrected = estimate(slopes, scale, variance), estimate(slopes, scale, noise)
    if known and all(process.variance < SMALL * variance for _, process in fitted):
        seen = np.isfinite(plain.deviations)
        if np.all(corrected.deviations[seen] <= SLIGHT * plain.deviations[seen]):
            return None
    return CorrelatedResiduals(processes, plain.deviations, plain.correlation, noise)


def correlated_series(
    series: Sequence[Series], residual: np.ndarray, basis: np.ndarray, level: float = LEVEL
) -> dict[Series, float]:
    """Return the series that tests of a level do not take for white noise, with their probabilities.

    ``residual`` (values,) are weighted, ``basis`` (values, columns) is orthonormal and spans what was fitted.
    """
    tested = {signal: p_value(signal, residual[signal.rows], basis[signal.rows]) for signal in series}
    return {signal: p for signal, p in tested.items() if p < level / len(tested)}


def fitted_processes(
    series: Sequence[Series], residual: np.ndarray, basis: np.ndarray, variance: float
) -> list[tuple[Series, Process]]:
    """Return a noise process for each series, from weighted residuals (values,); all others have ``variance``."""
    parts = {signal: (signal, residual[signal.rows], basis[signal.rows]) for signal in series}
    even = {signal: moments(*part) for signal, part in parts.items() if signal.grid is not None}
    uneven = {signal: ornstein_uhlenbeck(*part) for signal, part in parts.items() if signal.grid is None}
    processes: dict[Series, Process] = {
        signal: uneven[signal] if signal in uneven else even[signal].process for signal in series
    }
    for _ in range(ROUNDS):
        common = noise_along(list(processes.items()), basis, variance)
        even = {signal: table.corrected(common) for signal, table in even.items()}
        processes |= {signal: table.process for signal, table in even.items()}
    return list(processes.items())


def noise_along(
    processes: Sequence[tuple[Series, Process]], basis: np.ndarray, variance: float | np.ndarray
) -> np.ndarray:
    """Return BᵀΣB, (columns, columns), for a basis B (values, columns).

    ``variance``, a number or (values,), is that of values without a process.
    """
    rest = np.ones(len(basis), dtype=bool)
    for signal, _ in processes:
        rest[signal.rows] = False
    total = np.broadcast_to(variance, len(basis))[rest] * basis[rest].T @ basis[rest]
    return total + sum(process.product(signal, basis[signal.rows]) for signal, process in processes)


def _remainder(
    product: np.ndarray, rows: np.ndarray, variance: float, process: NoiseProcess, *, known: bool
) -> np.ndarray:
    """What the noise of a series has beyond its process, (parameters, parameters). Where the variance is ``known`` and
    the process has less than half of it, the remainder counts as independent. Systematic residuals make no combination
    of parameters better known than independent ones would.
    """
    if known and process.variance < SMALL * variance:
        return (variance - process.variance) * rows.T @ rows
    if not process.systematic:
        return np.zeros_like(product)
    values, vectors = np.linalg.eigh(variance * rows.T @ rows - product)
    return (vectors * np.maximum(values, 0.0)) @ vectors.T


def summaries(
    probabilities: Mapping[Series, float],
    fitted: Sequence[tuple[Series, Process]],
    response: np.ndarray,
    residual: np.ndarray,
    basis: np.ndarray,
) -> tuple[NoiseProcess, ...]:
    """Return what is known of fitted processes; ``probabilities`` has the series' probabilities to be white noise."""
    result = []
    for signal, process in fitted:
        first_order = is_first_order(signal, process.first, residual[signal.rows], basis[signal.rows])
        time = -signal.step / np.log(process.first) if first_order else process.decay(signal.step)
        result.append(
            NoiseProcess(
                channel=signal.name,
                p_value=probabilities[signal],
                first=process.first,
                order=process.order,
                even=signal.grid is not None,
                variance=process.variance,
                time=float(min(time, signal.length)),
                period=period_of(signal, response.ravel()[signal.rows]),
                unit=signal.unit,
                first_order=first_order,
                degrees=degrees_of_freedom(len(signal.rows), process.first),
            )
        )
    return tuple(result)


def degrees_of_freedom(number: int, first: float) -> float:
    """Return the degrees of freedom of the variance of a slow combination of ``number`` samples of a process.

    With innovations of variance s² that variance is V = s²/(1 − φ)². The relative variance of its estimate is that of
    s², 2/n, and that of φ, 4 (1 + φ)/(n (1 − φ)). By Satterthwaite it has 2/(relative variance) degrees of freedom,
    n/(1 + 2 (1 + φ)/(1 − φ)). Two remain at least. Faster combinations have more. Source: F. E. Satterthwaite, An
    approximate distribution of estimates of variance components, Biometrics Bulletin 2 (1946).

    >>> [round(degrees_of_freedom(60, first), 1) for first in (0.0, 0.4, 0.8)]
    [20.0, 10.6, 3.2]
    """
    slow = min(max(first, 0.0), 1 - 1 / number)
    return max(2.0, number / (1 + 2 * (1 + slow) / (1 - slow)))


def period_of(series: Series, response: np.ndarray) -> float:
    """Return the period of a response (values,), 2π times its deviation over that of its rate.

    It is at most a third of the record.
    """
    rate = np.sqrt(np.mean(np.gradient(response, series.along) ** 2))
    period = 2 * np.pi * np.std(response) / rate if rate > 0 else np.inf
    return float(min(period, series.length / 3))
