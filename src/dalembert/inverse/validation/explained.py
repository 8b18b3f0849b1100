"""How much of the variation of held-out data a response explains."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from dalembert.inverse.noise.correlation.series import series_of
from dalembert.inverse.noise.correlation.whiteness import LEVEL, p_value
from dalembert.inverse.problem.problem import MisfitProblem

GOOD = 0.9
"""Share of the variation from which a record counts as explained."""


@dataclass(frozen=True)
class Explained:
    """Share of the variation of one channel of a held-out record that the response explains."""

    record: str  # name of the experiment; empty for a single one
    channel: str
    # share: 1 − Σ W (R − data)² / Σ W (data − mean)² over the held-out values; negative where the mean of the data is
    # better than the response, NaN for data that do not vary
    share: float
    variation: float  # σ W (data − mean)²
    ratio: float  # root mean square of the weighted residuals over that of the fitted values
    white: bool  # whether the residuals pass as white noise
    covered: float = np.nan  # share of the held-out values inside their 95 % bands; NaN without bands

    @property
    def poor(self) -> bool:
        """Whether less than 0.9 is explained, and noise as in the fitted values is not the reason."""
        return self.share < GOOD and not (self.white and self.ratio < WORSE)


WORSE = 1.5
"""Ratio of residuals from which a prediction is said to be worse than the fit."""


def explained(
    problem: MisfitProblem, response: np.ndarray, weights: np.ndarray, fitted: float
) -> tuple[Explained, ...]:
    """Return the shares of all channels with held-out values. ``problem``: the whole one. ``response`` (samples,
    channels). ``weights`` (samples, channels): w of the held-out values, 0 for the others. ``fitted``: root mean square
    of the weighted residuals of the fitted values.
    """
    data = problem.data
    values, residual = data.continuous.ravel(), (np.sqrt(weights) * problem.unweighted_residual(response)).ravel()
    series = list(series_of(problem, weights))
    shares = []
    for signal in series:
        left, here, size = residual[signal.rows], values[signal.rows], weights.ravel()[signal.rows]
        variation = float(np.sum(size * (here - np.average(here, weights=size)) ** 2))
        squares = float(left @ left)
        shares.append(
            Explained(
                record=signal.experiment,
                channel=signal.channel,
                share=1 - squares / variation if variation > 0 else np.nan,
                variation=variation,
                ratio=float(np.sqrt(squares / len(left)) / fitted) if fitted > 0 else np.inf,
                white=p_value(signal, left, np.zeros((len(left), 1))) >= LEVEL / len(series),
            )
        )
    return tuple(shares)


def record_shares(shares: Sequence[Explained]) -> dict[str, float]:
    """Return the share of the variation of all channels together, for each record.

    >>> record_shares([Explained("a", "x", 0.5, 3.0, 1.0, True), Explained("a", "y", 1.0, 1.0, 1.0, True)])
    {'a': 0.625}
    """
    by_record = {}
    for record in dict.fromkeys(item.record for item in shares):
        of_record = [item for item in shares if item.record == record and item.variation > 0]
        total = sum(item.variation for item in of_record)
        by_record[record] = sum(item.share * item.variation for item in of_record) / total if total > 0 else np.nan
    return by_record


def percentages(shares: Sequence[Explained]) -> str:
    """Return the shares of records and channels as a sentence; empty without any."""
    parts = []
    for record, share in record_shares(shares).items():
        of_record = [item for item in shares if item.record == record]
        lead = f"{percent(share)} of {record!r}" if record else percent(share)
        channels = [f"{item.channel!r} {percent(item.share)}" for item in of_record]
        parts.append(f"{lead} ({', '.join(channels)})" if len(of_record) > 1 else lead)
    return f"Explained there of the data's variation: {'; '.join(parts)}." if parts else ""


def percent(share: float) -> str:
    """Return a share of a variation in words."""
    if np.isnan(share):
        return "undefined (constant data)"
    return "none" if share < 0 else f"{100 * share:.4g} %"
