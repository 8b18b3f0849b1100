"""Diagnostics of the residuals of a fit: what is standardised, tested and listed."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.special import ndtr, stdtr

from dalembert.findings import Finding
from dalembert.inverse.diagnostics.channel_pairs import ChannelPair, correlated_pairs, factors
from dalembert.inverse.diagnostics.diagnostic_tables import diagnostic_tables
from dalembert.inverse.diagnostics.findings import LEVEL, Outlier, diagnostic_findings, pair_findings
from dalembert.inverse.diagnostics.influence import ALONE, Influence, influence
from dalembert.inverse.diagnostics.noise_tests import normality, runs
from dalembert.inverse.diagnostics.series_residuals import SeriesResiduals
from dalembert.inverse.least_squares.estimate import left_vectors
from dalembert.inverse.noise.correlation.balanced import balanced
from dalembert.inverse.noise.correlation.correlated_residuals import NoiseProcess
from dalembert.inverse.noise.correlation.correlation import SMALL
from dalembert.inverse.noise.correlation.series import Series, series_of_record
from dalembert.inverse.noise.correlation.whiteness import LEAST, p_value
from dalembert.inverse.problem.prior import prior_slopes
from dalembert.inverse.problem.search_coordinates import off_bounds
from dalembert.tables import Table

if TYPE_CHECKING:
    from dalembert.inverse.fit.fit import Fit


_MEDIAN = 0.6745  # of the size of a standard normal variable


@dataclass(frozen=True, eq=False)
class ResidualDiagnostics:
    """Standardised residuals of a fit, tests of them, outliers, and the influence of single samples.

    Parameters
    ----------
    parameters : tuple of str
    series : tuple of SeriesResiduals
        One for each channel of each experiment with at least two fitted values.
    outliers : tuple of Outlier
        Largest first.
    findings : tuple of Finding
        What the tests conclude; those of the fit have the same ones.
    tested : bool
        Whether the residuals are tested: they are not where rounding explains them, or where the search did not
        converge.

    Notes
    -----
    Each test takes independent noise for something else in one of a thousand fits, over all channels and values.
    """

    parameters: tuple[str, ...]
    series: tuple[SeriesResiduals, ...]
    outliers: tuple[Outlier, ...]
    findings: tuple[Finding, ...]
    tested: bool

    def tables(self) -> tuple[Table, ...]:
        """Return the tests of each channel, the outliers, and the samples of the largest influence."""
        return tuple(diagnostic_tables(self.series, self.outliers, self.parameters))

    def __str__(self) -> str:
        return "\n".join(map(str, self.findings)) or "The tests find nothing against independent normal residuals."


def residual_diagnostics(fit: "Fit") -> ResidualDiagnostics:
    """Return the diagnostics of a fit; :meth:`Fit.diagnostics` is the public name.

    Where noise was estimated, they are of whitened residuals.
    """
    robust, tested = "loss" in fit.provenance, _tested(fit)
    everything = list(series_of_record(fit.data, fit.weights, fit.parts))
    residual, slopes = _weighted(fit, everything)
    free = off_bounds(fit.parameters, fit.values)
    variance = _variance(residual[fit.weights.ravel() > 0]) if robust and not _given(fit) else fit.residual_variance
    freedom = None if fit.noise_is_known or robust else float(fit.degrees_of_freedom)
    known = _unknown(fit) if slopes is None else influence(slopes, residual, free, variance, freedom)
    basis = np.zeros((len(residual), 0)) if slopes is None else left_vectors(slopes[:, free])[: len(residual)]
    left, used = residual, known.leverage
    if not (fit.noise_is_known or fit.noise is not None or robust or slopes is None or len(everything) < 2):
        left, basis = balanced(everything, residual, basis)
        used = np.sum(basis**2, axis=1)
    correlated = {} if fit.correlated is None else {item.channel: item for item in fit.correlated.detected}
    results = []
    for signal in everything:
        standardised = _standardised(
            fit, signal, left[signal.rows], used[signal.rows], known, robust=robust, process=correlated.get(signal.name)
        )
        tests = _tests(standardised, left, basis) if tested and _can_be_tested(fit, standardised) else {}
        results.append(replace(standardised, p_values=tests))
    outliers, findings = (), ()
    if tested:
        plain = fit.noise is None and not robust and fit.nodes is None
        outliers = _outliers(fit, results, robust=robust)
        findings = diagnostic_findings(fit.parameters.names, results, outliers, robust=robust, plain=plain)
    judged = [item for item in results if item.p_values]
    pairs = correlated_pairs(judged, left, basis, fit.weights.shape[1], correlated, LEVEL)
    grown = _grown(pairs, judged, None if slopes is None else slopes[:, free], fit.weights.shape)
    findings = (*findings, *pair_findings(pairs, grown))
    return ResidualDiagnostics(fit.parameters.names, tuple(results), outliers, findings, tested)


def _weighted(fit: "Fit", series: Sequence[Series]) -> tuple[np.ndarray, np.ndarray | None]:
    """Weighted residuals (values,) and slopes (values + priors, parameters), whitened where noise was estimated."""
    slopes = _slopes(fit)
    if fit.noise is None:
        return np.where(fit.weights > 0, np.sqrt(fit.weights) * np.nan_to_num(fit.residuals), 0.0).ravel(), slopes
    return np.nan_to_num(fit.noise.whitened).ravel(), None if slopes is None else fit.noise.whiten(series, slopes)


def _can_be_tested(fit: "Fit", standardised: SeriesResiduals) -> bool:
    """Whether a series has enough values, which are not far below a noise that is known."""
    enough = len(standardised.series.rows) >= LEAST
    return enough and not (fit.noise_is_known and standardised.deviation**2 < SMALL)


def _grown(
    pairs: Sequence[ChannelPair], judged: Sequence[SeriesResiduals], slopes: np.ndarray | None, shape: tuple[int, ...]
) -> np.ndarray:
    """Standard deviations with correlated channels over those without, (parameters,); empty without a Jacobian."""
    if not pairs or slopes is None:
        return np.zeros(0)
    sizes = np.ones(int(np.prod(shape)))
    for item in judged:
        sizes[item.series.rows] = item.deviation
    return factors(pairs, slopes, sizes, shape[1])


ROUNDED = ("arithmetic", "rounded")
"""Sources of noise that is none."""

OUTSIDE = 5.0
"""Standardised residual beyond which a value is an outlier, and does not count for the shape of the distribution."""


def _tested(fit: "Fit") -> bool:
    """Whether the residuals are those of a minimum, and more than rounding."""
    rounded = any(item.code == "misfit-at-noise" and item.values["source"] in ROUNDED for item in fit.outcome)
    apart = fit.nodes is not None and fit.nodes.segments > 1
    return fit.success and not rounded and not apart


def _given(fit: "Fit") -> bool:
    return fit.data.deviations is not None and fit.provenance.get("weights") == "data"


def _slopes(fit: "Fit") -> np.ndarray | None:
    """W^½ ∂R/∂p · scale of all values, then of priors, (values + priors, parameters); None without a Jacobian."""
    if fit.jacobian is None or not len(fit.values):
        return None
    scale = fit.parameters.scale
    fitted = fit.weights[..., None] > 0
    rows = np.where(fitted, np.sqrt(fit.weights)[..., None] * fit.jacobian * scale, 0.0).reshape(-1, len(scale))
    return np.concatenate([rows, prior_slopes(fit.parameters, fit.values, scale)])


def _unknown(fit: "Fit") -> Influence:
    """Influence without a Jacobian."""
    number = fit.weights.size
    lost = np.full(number, np.nan)
    return Influence(lost, lost, np.full((number, len(fit.values)), np.nan))


def _variance(values: np.ndarray) -> float:
    """Variance from the median size, which outliers hardly change."""
    return float(np.median(np.abs(values)) / _MEDIAN) ** 2


def _standardised(
    fit: "Fit",
    signal: Series,
    values: np.ndarray,
    leverage: np.ndarray,
    known: Influence,
    *,
    robust: bool,
    process: NoiseProcess | None,
) -> SeriesResiduals:
    """Residuals of one series, without tests, from weighted ones and their leverage, both (values,).

    Without a Jacobian each value has an equal share of the parameters.
    """
    share = min(1.0, len(fit.values) / max(1, np.count_nonzero(fit.weights)))
    used = np.where(np.isnan(leverage), share, leverage)
    freedom = len(values) - float(np.sum(used))
    if robust:
        variance = _variance(values) * len(values) / freedom if freedom > 0 else np.nan
    else:
        variance = float(values @ values) / freedom if freedom > 1 else np.nan
    standardised = np.full(len(values), np.nan)
    usable = (1 - used > ALONE) & (variance > 0)
    standardised[usable] = values[usable] / np.sqrt(variance * (1 - used[usable]))
    deleted = standardised
    if not robust and freedom > 1:
        deleted = standardised * np.sqrt((freedom - 1) / np.maximum(freedom - standardised**2, ALONE * freedom))
    return SeriesResiduals(
        series=signal,
        response=fit.response.ravel()[signal.rows],
        residuals=fit.residuals.ravel()[signal.rows],
        standardised=standardised,
        deleted=deleted,
        leverage=known.leverage[signal.rows],
        distance=known.distance[signal.rows],
        changes=known.changes[signal.rows],
        deviation=float(np.sqrt(variance)),
        correlated=process is not None,
        memory=0.0 if process is None else _memory(process),
        p_values={},
    )


FAINT = 0.3
"""Autocorrelation of neighbours up to which that of their sizes, nearly its square, does not matter to the tests."""


def _memory(process: NoiseProcess) -> float:
    """Autocorrelation of neighbours by which residuals are whitened; NaN where that leaves no independent ones."""
    white = process.first_order or abs(process.first) < FAINT
    return process.first if white and not process.systematic else np.nan


def _tests(item: SeriesResiduals, residual: np.ndarray, basis: np.ndarray) -> dict[str, float]:
    """Probabilities of the tests; correlated residuals are not tested for what needs independence.

    Their size is tested where they are noise: noise that grows is taken for correlated more often than others.
    """
    signal, values = item.series, item.standardised
    p_values = {"autocorrelation": p_value(signal, residual[signal.rows], basis[signal.rows])}
    finite = np.isfinite(values)
    if np.count_nonzero(finite) < LEAST or not np.std(values[finite]) > 0:
        return p_values
    if signal.grid is not None:
        p_values["period"] = item.periodic_part(float(np.sum(basis[signal.rows] ** 2)))[0]
    if np.isfinite(item.memory):
        p_values["size over response"] = item.growth(np.abs(item.response))[1]
        p_values["size over coordinate"] = item.growth(signal.along)[1]
    if item.correlated:
        return p_values
    kept = values[finite]
    usual = kept[np.abs(item.deleted[finite]) < OUTSIDE]
    p_values["runs"] = runs(kept)[2]
    p_values["normality"] = normality(usual) if len(usual) >= LEAST else 1.0
    return p_values


def _outliers(fit: "Fit", results: list[SeriesResiduals], *, robust: bool) -> tuple[Outlier, ...]:
    """Values that no normal noise explains, largest first; correlated residuals are not searched."""
    searched = [one for one in results if one.p_values and not one.correlated]
    total = sum(len(one.residuals) for one in searched)
    outliers = []
    for one in searched:
        freedom = len(one.residuals) - np.nansum(one.leverage) - 1
        size = np.abs(np.nan_to_num(one.deleted))
        probability = 2 * (ndtr(-size) if robust else stdtr(freedom, -size))
        for row in np.flatnonzero(probability < LEVEL / total):
            change = np.nan_to_num(one.changes[row])
            worst = int(np.argmax(np.abs(change))) if len(change) else 0
            outliers.append(
                Outlier(
                    experiment=one.series.experiment,
                    channel=one.series.channel,
                    at=float(one.series.along[row]),
                    unit=one.series.unit,
                    size=float(one.deleted[row]),
                    p_value=float(min(1.0, total * probability[row])),
                    parameter=fit.parameters.names[worst] if len(change) else "",
                    change=float(change[worst]) if len(change) else 0.0,
                )
            )
    return tuple(sorted(outliers, key=lambda item: -abs(item.size)))
