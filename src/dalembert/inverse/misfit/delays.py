"""Delays of sensors that would explain the residuals of a fit."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from dalembert.findings import Finding
from dalembert.inverse.misfit.residuals import Residuals

SIGNIFICANT = 4.0
"""Delay in its standard deviations from which it is suspected."""

EXPLAINS = 0.5
"""Part of the squares of residuals from which a delay explains residuals that stay correlated with it."""

DISTINCT = 1e-6
"""Part of the squares of a response's rate that no parameter makes up for; below, a delay cannot be determined."""

TIME = "s"


@dataclass(frozen=True)
class SuspectDelay:
    """A delay that would explain the residuals of a channel, or of all."""

    channel: str  # its name in every experiment; empty for all channels
    # delay, deviation: s; positive where the data are late
    delay: float
    deviation: float
    explained: float  # part of the squares of its residuals that the delay takes away


def suspect_delays(residuals: Residuals) -> tuple[tuple[SuspectDelay, ...], Residuals]:
    """Return the delays that explain residuals, the most explaining first, and the residuals without them. Data that
    are late by τ leave the residuals R(t) − R(t − τ) ≈ τ dR/dt. The part of W^½ dR/dt that no parameter makes up for is
    the column d; τ = dᵀr/dᵀd. Its deviation allows for the correlation of the residuals that are left.
    """
    suspects: list[SuspectDelay] = []
    rates = _rates(residuals)
    while rates:
        estimates = filter(None, (_estimated(residuals, name, rate) for name, rate in rates.items()))
        best = max(estimates, key=lambda item: item.gain, default=None)
        if best is None or not best.accepted:
            break
        suspects.append(best.suspect)
        residuals = best.left
        rates = {name: rate for name, rate in rates.items() if name and best.suspect.channel not in ("", name)}
    return tuple(suspects), residuals


def delay_findings(delays: tuple[SuspectDelay, ...], time: str) -> Iterator[Finding]:
    """Yield a finding for each suspected delay; ``time`` is the name of the coordinate."""
    for item in delays:
        size, late = f"{abs(item.delay):.2g} s (± {item.deviation:.1g} s)", item.delay > 0
        whose = f"{item.channel!r}" if item.channel else "all channels"
        message = (
            f"The data of {whose} are {'late' if late else 'early'}: a delay of about {'' if late else '−'}{size} "
            f"explains {100 * item.explained:.3g} % of the squares of their residuals."
        )
        bound = f"{2 * item.delay:.1g}"
        advice = (
            f"Identify it: [sensors] {item.channel!r} = {{ delay = [0.0, {bound}] }} in a study file, or Sensors."
            if late and item.channel
            else f"Identify a delay of each sensor, up to {bound} s, or check where the {time} of the data begins."
            if late
            else f"Check where the {time} of the data begins, and the delays of measured inputs."
        )
        values = {"channel": item.channel, "delay": item.delay, "deviation": item.deviation}
        yield Finding("suspect-delay", "warning", {**values, "explained": item.explained}, message, advice)


@dataclass(frozen=True, eq=False)
class _Estimated:
    """A delay, the residuals without it, and the squares that it takes away."""

    suspect: SuspectDelay
    left: Residuals
    gain: float
    accepted: bool


def _rates(residuals: Residuals) -> dict[str, np.ndarray]:
    """W^½ dR/dt (values,) by channel, the same in all experiments, 0 in the others; of all channels by ``""``."""
    rates: dict[str, np.ndarray] = {}
    weights = np.sqrt(residuals.problem.weights).ravel()
    for signal in residuals.series:
        if signal.unit == TIME and len(signal.rows) > 2:
            column = rates.setdefault(signal.channel, np.zeros(len(weights)))
            response = residuals.at.response.ravel()[signal.rows]
            if residuals.problem.data.wrapping[signal.rows[0] % residuals.at.response.shape[1]]:
                response = np.unwrap(response)
            column[signal.rows] = weights[signal.rows] * np.gradient(response, signal.along)
    return {**rates, "": sum(rates.values(), np.zeros(len(weights)))} if len(rates) > 1 else rates


def _estimated(residuals: Residuals, name: str, rate: np.ndarray) -> _Estimated | None:
    """The delay of the channels with a rate (values,); None where other parameters make up for it."""
    column = rate - residuals.basis @ (residuals.basis.T @ rate)
    size = float(column @ column)
    if not size > DISTINCT * float(rate @ rate):
        return None
    delay = float(column @ residuals.values) / size
    left, gain = residuals.without(column, delay), delay**2 * size
    share = gain / float(np.sum(residuals.values[rate != 0] ** 2))
    least = float(left.variances @ column**2) / size  # independent residuals have the least deviation
    if not gain > SIGNIFICANT**2 * least:
        return _Estimated(SuspectDelay(name, delay, np.nan, share), left, gain, accepted=False)
    deviation = float(np.sqrt(left.spread(column[:, None])[0, 0])) / size
    white = not any(np.any(rate[signal.rows]) for signal in left.correlated)
    explains = share >= EXPLAINS or white
    accepted = explains and abs(delay) >= SIGNIFICANT * deviation
    return _Estimated(SuspectDelay(name, delay, deviation, share), left, gain, accepted)
