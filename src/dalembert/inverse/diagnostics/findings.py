"""Findings of residual diagnostics."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from dalembert.errors import counted, listed
from dalembert.findings import Finding
from dalembert.inverse.diagnostics.channel_pairs import ChannelPair
from dalembert.inverse.diagnostics.noise_tests import runs
from dalembert.inverse.diagnostics.series_residuals import SeriesResiduals
from dalembert.inverse.noise.correlation.correlation import SLIGHT

LEVEL = 0.001
"""Probability with which a test takes independent noise for something else, over all channels of a fit."""

DECIDES = 1.0
"""Cook's distance from which one sample decides a fit: without it the parameters leave their 50 % confidence region."""

FREEDOM = 10
"""Fewest degrees of freedom with which a single sample that decides is reported: of few samples each one does."""

PERIODIC = 0.01
"""Share of the power from which a periodic part is reported: it adds 0.5 % to the root mean square of the residuals.

Of many samples, a much smaller part is significant as well.
"""

PROPOSED = "mixed"
"""Noise model of residuals that grow with the response: proportional noise alone has none where the response is 0."""

SHOWN = 3
"""Outliers that a message lists."""


@dataclass(frozen=True)
class Outlier:
    """A value that the noise of its channel does not explain.

    Parameters
    ----------
    experiment : str
        Empty for a single one.
    channel : str
    at : float
        Coordinate, in ``unit``.
    unit : str
    size : float
        Residual R − data in standard deviations of the channel's other residuals.
    p_value : float
        Probability that noise has any value as far out, over all values of the fit.
    parameter : str
        The parameter that the value moves most.
    change : float
        Its identified value less that without this one, in standard deviations; 0 where it is not known.
    """

    experiment: str
    channel: str
    at: float
    unit: str
    size: float
    p_value: float
    parameter: str
    change: float

    def __str__(self) -> str:
        record = f" of {self.experiment!r}" if self.experiment else ""
        return f"{self.channel!r}{record} at {self.at:.4g} {self.unit}".rstrip()


def diagnostic_findings(
    names: Sequence[str], series: Sequence[SeriesResiduals], outliers: Sequence[Outlier], *, robust: bool, plain: bool
) -> Iterator[Finding]:
    """Yield what the tests conclude, at most one finding for each test. ``names``: of the parameters. ``outliers``:
    largest first. ``robust``: whether the loss makes outliers count less. ``plain``: whether a noise model can be
    given: there is none yet, and no other loss or segments.
    """
    if outliers:
        yield _of_outliers(outliers, robust=robust)
    if (worst := _worst(series, "runs")) is not None:
        yield _of_runs(worst)
    if (worst := _worst(series, "period", enough=_strongly_periodic)) is not None:
        _, frequency, share = worst.periodic_part()
        values = {"channel": worst.name, "period": 1 / frequency, "share": share, "p_value": worst.p_values["period"]}
        size = f"{1 / frequency:.3g} {worst.series.unit}".rstrip()
        power = f"{100 * share:.2g} % of their power has the period {size}"
        message = f"The residuals of {worst.name!r} have a periodic part: {power}."
        advice = "Look for its source, such as mains voltage, a motor, or a mode that the model lacks."
        yield Finding("periodic-residuals", "note" if worst.correlated else "warning", values, message, advice)
    over = [(item, key) for key in ("size over response", "size over coordinate") if (item := _worst(series, key, 2))]
    if over:
        yield _of_size(*min(over, key=lambda pair: pair[0].p_values[pair[1]]), plain=plain)
    if (worst := _worst(series, "normality")) is not None:
        yield _of_normality(worst)
    yield from _of_influence(names, series)


def _worst(
    series: Sequence[SeriesResiduals],
    test: str,
    tests: int = 1,
    enough: Callable[[SeriesResiduals], bool] = lambda item: True,
) -> SeriesResiduals | None:
    """Return the series of the least probability that is significant among all series and ``tests``, and ``enough``."""
    tried = [item for item in series if test in item.p_values]
    significant = [item for item in tried if item.p_values[test] < LEVEL / (len(tried) * tests) and enough(item)]
    return min(significant, key=lambda item: item.p_values[test], default=None)


def _strongly_periodic(item: SeriesResiduals) -> bool:
    return item.periodic_part()[2] >= PERIODIC


def _of_outliers(outliers: Sequence[Outlier], *, robust: bool) -> Finding:
    first, number = outliers[0], len(outliers)
    names = listed([f"{item} ({abs(item.size):.2g} standard deviations)" for item in outliers[:SHOWN]])
    more = f", and {number - SHOWN} more" if number > SHOWN else ""
    moved = (
        f" Without the largest, {first.parameter!r} changes by {abs(first.change):.2g} standard deviations."
        if abs(first.change) >= 0.1
        else ""
    )
    values = {
        "outliers": number,
        "experiment": first.experiment,
        "channel": first.channel,
        "at": first.at,
        "size": first.size,
        "p_value": first.p_value,
        "parameter": first.parameter,
        "change": first.change,
    }
    message = f"{counted(number, 'sample')} {'is an outlier' if number == 1 else 'are outliers'}: {names}{more}.{moved}"
    advice = "Check these samples. Leave out wrong ones, or use a robust loss such as 'huber'."
    return Finding("outlying-samples", "note" if robust else "warning", values, message, "" if robust else advice)


def _of_runs(item: SeriesResiduals) -> Finding:
    count, expected, probability = runs(item.standardised[np.isfinite(item.standardised)])
    values = {"channel": item.name, "runs": count, "expected": expected, "p_value": probability}
    how = "rarely" if count < expected else "often"
    message = (
        f"The residuals of {item.name!r} change their sign too {how}: {count} runs of equal signs, {expected:.0f} are "
        "expected of independent noise."
    )
    advice = "Look at the residuals over time for what the model lacks."
    return Finding("runs-of-signs", "warning", values, message, advice)


def _of_size(item: SeriesResiduals, test: str, *, plain: bool) -> Finding:
    over_response = test == "size over response"
    correlation, probability = item.growth(np.abs(item.response) if over_response else item.series.along)
    what = "the size of the response" if over_response else "the coordinate"
    how = "grow" if correlation > 0 else "shrink"
    values = {"channel": item.name, "over": what, "correlation": correlation, "p_value": probability}
    message = f"The residuals of {item.name!r} {how} with {what} (correlation of ranks {correlation:.2f})."
    advice = "Weight the samples by their noise: the standard deviations assume that it is constant in a channel."
    if plain and over_response and correlation > 0:
        values["noise"] = PROPOSED
        advice = (
            "The standard deviations assume that the noise is constant in a channel. Estimate how it grows: give "
            f'`identify` the argument `noise="{PROPOSED}"`, or write `noise = "{PROPOSED}"` under `[identify]` in a '
            "study file."
        )
    return Finding("unequal-variance", "warning", values, message, advice)


def _of_normality(item: SeriesResiduals) -> Finding:
    values = {"channel": item.name, "p_value": item.p_values["normality"]}
    message = f"The residuals of {item.name!r} are not normally distributed (Anderson–Darling test)."
    advice = "Look at the normal quantiles. A robust loss is more exact where large residuals are frequent."
    return Finding("non-normal-residuals", "note", values, message, advice)


def pair_findings(pairs: Sequence[ChannelPair], grown: np.ndarray) -> Iterator[Finding]:
    """Yield that channels are correlated with each other, if there are such pairs. ``grown`` are the standard
    deviations (parameters,) that allow for it, over those of the fit; empty without a Jacobian.
    """
    if not pairs:
        return
    worst, seen = pairs[0], grown[np.isfinite(grown)]
    more = f", and those of {counted(len(pairs) - 1, 'more pair')}" if len(pairs) > 1 else ""
    values = {
        "first": worst.first.name,
        "second": worst.second.name,
        "correlation": worst.correlation,
        "p_value": worst.p_value,
        "pairs": len(pairs),
    }
    effect = " The standard deviations are those for independent channels."
    if len(seen):
        values |= {"smallest_factor": float(np.min(seen)), "largest_factor": float(np.max(seen))}
        shown = dict.fromkeys(f"{factor:.2g}" for factor in (np.min(seen), np.max(seen)))
        effect += f" With this correlation they are {' to '.join(shown)} times as large."
    message = (
        f"The residuals of {worst.first.name!r} and {worst.second.name!r} are correlated with each other (correlation "
        f"{worst.correlation:.2f}){more}.{effect}"
    )
    matters = not len(seen) or np.max(seen) > SLIGHT
    advice = (
        "If a channel is a copy of another, or is calculated from it, leave it out. If they share their noise, "
        "multiply the standard deviations by this factor."
    )
    yield Finding("correlated-channels", "warning" if matters else "note", values, message, advice if matters else "")


def _of_influence(names: Sequence[str], series: Sequence[SeriesResiduals]) -> Iterator[Finding]:
    """Yield the sample that decides the fit, if there is one."""
    known = [item for item in series if np.any(np.isfinite(item.distance))]
    freedom = sum(len(item.residuals) for item in known) - len(names)
    if not known or freedom < FREEDOM:
        return
    worst = max(known, key=lambda item: float(np.nanmax(item.distance)))
    row = int(np.nanargmax(worst.distance))
    distance = float(worst.distance[row])
    if not distance > DECIDES:
        return
    change = np.nan_to_num(worst.changes[row])
    most = int(np.argmax(np.abs(change)))
    at, unit = float(worst.series.along[row]), worst.series.unit
    values = {
        "channel": worst.name,
        "at": at,
        "distance": distance,
        "leverage": float(worst.leverage[row]),
        "parameter": names[most],
        "change": float(change[most]),
    }
    effect = (
        f": without it {names[most]!r} changes by {abs(change[most]):.2g} standard deviations" if change.any() else ""
    )
    where = f"{at:.4g} {unit}".rstrip()
    message = f"The sample of {worst.name!r} at {where} decides the fit (Cook's distance {distance:.3g}){effect}."
    advice = "Check this sample for a mistake, and measure more samples under similar conditions."
    yield Finding("influential-sample", "note", values, message, advice)
