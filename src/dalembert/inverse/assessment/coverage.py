"""How many of the values that were not fitted lie inside the bands of their prediction."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from dalembert.findings import Finding
from dalembert.inverse.assessment.predict import band_end, noise_deviations, response_deviations
from dalembert.inverse.fit.fit import Fit
from dalembert.inverse.noise.correlation.series import series_of
from dalembert.inverse.problem.problem import MisfitProblem
from dalembert.inverse.validation.validation import Validation

LEVEL = 0.95

LEAST = 0.7
"""Share of the values below which 95 % bands are too narrow. Of 200 right models with white and with correlated noise,
none covered less than 0.86 of an unseen record (tests/unseen_records.py)."""


def with_coverage(fit: Fit, problem: MisfitProblem) -> Fit:
    """Return the fit with the shares of held-out values inside their 95 % bands, in all and for each channel.

    A value is inside where \\|R − data\\| ≤ z (σ_R² + σ²)^½ with the deviations of the response and of the noise. Where
    a band has grown as wide as the motion, it has ended and holds nothing. ``problem``: the whole one, with the
    validation.
    """
    validation = fit.validation
    at = None if validation is None else problem.linearised(fit.values)
    if validation is None or at is None:
        return fit
    deviations, width = response_deviations(fit, at.jacobian).ravel(), fit.quantile(LEVEL)
    apart, response = np.abs(problem.unweighted_residual(at.response)).ravel(), at.response.ravel()
    inside: list[np.ndarray] = []
    for signal in series_of(problem, validation.weights):
        wraps = signal.name in problem.data.wraps
        end = band_end(width * deviations[signal.rows], response[signal.rows], wraps=wraps)
        rows = signal.rows[:end]
        noise = noise_deviations(fit, signal.name, response[rows])
        inside.append(apart[rows] <= width * np.hypot(deviations[rows], noise))
    shares = [float(np.mean(here)) if len(here) else np.nan for here in inside]
    together = np.concatenate([*inside, np.zeros(0, dtype=bool)])
    validation = replace(
        validation,
        explained=tuple(replace(item, covered=share) for item, share in zip(validation.explained, shares, strict=True)),
        covered=float(np.mean(together)) if len(together) else np.nan,
    )
    findings = (*fit.findings, *_findings(validation))
    return replace(
        fit,
        validation=validation,
        findings=findings,
        simulations=problem.journal.simulations,
        jacobian=None if fit.jacobian is None else at.jacobian,
    )


def _findings(validation: Validation) -> Iterator[Finding]:
    """Yield a finding where 95 % bands contain too few of the values that were not fitted."""
    if not validation.covered < LEAST:
        return
    worst = min(validation.explained, key=lambda item: item.covered)
    what = f"{worst.channel!r} of {worst.record!r}" if worst.record else repr(worst.channel)
    yield Finding(
        "narrow-bands",
        "warning",
        {"covered": validation.covered, "record": worst.record, "channel": worst.channel, "lowest": worst.covered},
        f"The 95 % bands contain {100 * validation.covered:.3g} % of the values that were not fitted, "
        f"{100 * worst.covered:.3g} % in {what}.",
        "The bands assume that the model is right. Look for what it lacks, or fit such records too.",
    )
