"""Findings on correlated residuals."""

from collections.abc import Iterator, Sequence

import numpy as np

from dalembert.errors import listed
from dalembert.findings import Finding
from dalembert.inverse.identification.assess import Optimum
from dalembert.inverse.noise.correlation.correlated_residuals import NoiseProcess


def correlated_residuals(optimum: Optimum) -> Iterator[Finding]:
    """Yield that residuals are correlated, and that the model lacks something; notes where rounding explains them."""
    correlated, deviations = optimum.correlated, optimum.estimate.deviations
    if correlated is None or not correlated.detected:
        return
    explained = optimum.minimum.explained_by == "rounded"
    systematic = [process for process in correlated.detected if process.systematic and not explained]
    worst = max(correlated.detected, key=lambda process: abs(process.first))
    seen = np.isfinite(deviations) & (correlated.deviations > 0)
    ratios = deviations[seen] / correlated.deviations[seen]
    factors, sentence = {}, ""
    if len(ratios):
        factors = {"smallest_factor": float(np.min(ratios)), "largest_factor": float(np.max(ratios))}
        shown = dict.fromkeys(f"{factor:.2g}" for factor in factors.values())
        sentence = (
            " The standard deviations allow for this: they are "
            f"{' to '.join(shown)} times those for independent residuals."
        )
    names = listed([repr(process.channel) for process in correlated.detected])
    note = explained or len(systematic) == len(correlated.detected)
    yield Finding(
        "correlated-residuals",
        "note" if note else "warning",
        {
            "channel": worst.channel,
            "channels": len(correlated.detected),
            "autocorrelation": worst.first,
            "order": worst.order,
            "p_value": worst.p_value,
            **factors,
        },
        f"The residuals of {names} are correlated (lag-1 autocorrelation {worst.first:.2f}, process of order "
        f"{worst.order}).{sentence}",
        "" if note else "Check the model structure and the bounds, or increase `starts`.",
    )
    yield from systematic_findings(systematic)


def systematic_findings(systematic: Sequence[NoiseProcess]) -> Iterator[Finding]:
    """Yield a finding that residuals with these processes are no noise; none without a process."""
    if systematic:
        slow = max(systematic, key=lambda process: process.time / process.period)
        yield Finding(
            "systematic-residuals",
            "warning",
            {"channel": slow.channel, "correlation_time": slow.time, "period": slow.period},
            f"The residuals of {slow.channel!r} stay correlated over {_shown(slow.time, slow.unit)}; the response "
            f"changes within {_shown(slow.period, slow.unit)}. They are not noise: the model lacks something.",
            "Add what the model lacks, for example friction, compliance or an offset. Until then the standard "
            "deviations do not show how far the values are from the truth.",
        )


def _shown(value: float, unit: str) -> str:
    return f"{value:.3g} {unit}".rstrip()
