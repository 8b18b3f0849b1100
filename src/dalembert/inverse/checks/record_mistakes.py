"""Findings on mistakes in records that explain the misfit of a fit."""

from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from dalembert.errors import SolveError
from dalembert.findings import Finding
from dalembert.inverse.identification.assess import Optimum
from dalembert.inverse.misfit.delays import SuspectDelay, delay_findings
from dalembert.inverse.mistakes.clocks import RESOLUTION, clocks
from dalembert.inverse.mistakes.hypotheses import HYPOTHESES
from dalembert.inverse.mistakes.record import NONE, FittedRecord, Mistake, Verdict
from dalembert.inverse.mistakes.supposed import LEAST, Supposed, linear, refitted
from dalembert.inverse.noise.correlation.correlation import correlated_series
from dalembert.inverse.problem.problem import Linearisation

EXPLAINS = 0.35
"""Part of the mean square of the residuals that a mistake must explain. It is a half, and by chance less, where the
mistake doubles the mean square."""

CLEAR = 8.0
"""Gain in log-likelihood from which noise is not the reason: some hundred mistakes are tried."""

ALIKE = 5.0
"""Loss in log-likelihood against the best mistake up to which another one explains the same."""

POOR = 1.3
"""Variance of a weighted residual, where 1 is known, from which a fit is poor."""

MOST = 4
"""Mistakes with which the parameters are identified again."""

PROMISING = 0.85
"""Mean square of residuals that a linear estimate may leave, relative to that of the fit."""

CLOCKS = {"suspect-clock", "suspect-clock-rate"}
"""Codes of findings on times."""

BETTER = 0.5
"""Part of the squares that a small delay leaves, which another error of the times must leave at most."""

POINTS = 3
"""Most points at which the response is linearised."""


def record_mistakes(optimum: Optimum) -> Iterator[Finding]:
    """Yield delays that explain the residuals, and mistakes in the record that explain them better. A small delay
    leaves residuals that are proportional to the rate of the response. There a shift by whole periods explains as much.
    Residuals away from a minimum show the search, not the record.
    """
    problem, causes, at = optimum.problem, optimum.causes, optimum.linearisation
    delays = tuple(delay_findings(causes.delays, problem.data.coordinate.name))
    if at is None or not optimum.minimum.shows_model or not (optimum.by_squares or optimum.end.stationary):
        yield from delays
        return
    record = FittedRecord(problem, at, optimum.noise_is_known)
    journal = problem.journal
    ends = sorted((start for start in journal.starts if np.isfinite(start.misfit)), key=lambda start: start.misfit)
    vectors = [*([] if journal.first is None else [journal.first.vector]), *(start.end for start in ends)]
    mistakes = tuple(mistake_findings(record, vectors))
    late = [finding for finding in mistakes if finding.code in CLOCKS]
    if late:
        period = min(clock.period for clock in clocks(record, channels=False))
        linear_range = period / RESOLUTION
        left = min((1 - item.explained for item in causes.delays if abs(item.delay) < linear_range), default=np.inf)
        late = [finding for finding in late if not _is_alias(finding, causes.delays, period)]
        if any(1 - finding.values["explained"] < BETTER * left for finding in late):
            delays = ()
        else:
            mistakes = tuple(finding for finding in mistakes if finding.code not in CLOCKS)
    yield from (*mistakes, *delays)


def mistake_findings(record: FittedRecord, vectors: Sequence[np.ndarray]) -> Iterator[Finding]:
    """Yield findings on the mistake that explains a poor fit best, and on others that explain it as well.

    Near ``vectors`` (parameters,) the parameters may be without the mistake: first guesses, ends of other starts.
    """
    if not len(record.series):
        return
    mistakes = [mistake for hypothesis in HYPOTHESES for mistake in hypothesis(record)]
    mistakes = mistakes if _poor(record) else [mistake for mistake in mistakes if mistake.visible]
    if not mistakes:
        return
    points = [record.at, *_linearised(record, vectors)]
    estimates = [
        min((linear(record, mistake, at) for at in points), key=lambda supposed: supposed.ratio) for mistake in mistakes
    ]
    hopeful = sorted(
        (supposed for supposed in estimates if supposed.ratio < PROMISING), key=lambda supposed: supposed.ratio
    )[:MOST]
    explaining = [supposed for supposed in (refitted(record, item) for item in hopeful) if _explains(supposed, 1.0)]
    if not explaining:
        return
    best = max(explaining, key=lambda supposed: supposed.gain)
    nothing = Mistake(_unchanged, best.mistake.finding, NONE)
    again = refitted(record, Supposed(nothing, best.at, np.nan, 1.0, best.values, np.zeros(0)))
    usual = min(1.0, again.ratio)  # a start near the end of this fit may lead to a better minimum without a mistake
    order = [supposed for mistake in mistakes for supposed in explaining if supposed.mistake is mistake]
    alike = [supposed for supposed in order if best.better_than(supposed) < ALIKE and _explains(supposed, usual)]
    for supposed in alike[:2]:
        if np.isfinite(supposed.number) and abs(supposed.number) < supposed.mistake.least:
            continue
        yield supposed.mistake.finding(Verdict(supposed.number, 1 - supposed.ratio))


def _is_alias(finding: Finding, delays: Sequence[SuspectDelay], period: float) -> bool:
    """Return True if a shift of the times differs by whole periods from a delay that explains the residuals."""
    shift = finding.values.get("delay", np.nan)
    periods = [(shift - item.delay) / period for item in delays if item.explained > EXPLAINS]
    return any(abs(number - round(number)) < 1 / RESOLUTION for number in periods if abs(number) > 0.5)


def _explains(supposed: Supposed, usual: float) -> bool:
    """Return True if a mistake explains enough of the residuals, and noise cannot be the reason."""
    return (
        supposed.ratio < (1 - EXPLAINS) * usual
        and supposed.gain + supposed.values / 2 * np.log(max(usual, LEAST)) > CLEAR
    )


def _unchanged(response: np.ndarray, _: float) -> np.ndarray:
    return response


def _poor(record: FittedRecord) -> bool:
    """Return True if the residuals are correlated, or far above the noise that is known."""
    values = record.residual
    count = np.count_nonzero(record.problem.weights)
    if record.known and float(values @ values) > POOR * count:
        return True
    return bool(correlated_series(record.series, values, np.zeros((len(values), 0))))


def _linearised(record: FittedRecord, vectors: Iterable[np.ndarray]) -> Iterator[Linearisation]:
    """Yield the response at up to some of other vectors that differ."""
    problem, known = record.problem, [record.at.vector]
    for vector in vectors:
        if len(known) == POINTS:
            return
        if any(np.allclose(vector, other, rtol=1e-2) for other in known):
            continue
        known.append(vector)
        try:
            yield problem.linearise(vector)
        except SolveError:
            continue
