"""All checks of an identification, in the order of their findings."""

from collections.abc import Callable, Iterator, Sequence
from typing import Any, TypeAlias

import numpy as np

from dalembert.findings import Finding
from dalembert.forward import findings_at
from dalembert.inverse.checks.channel_units import channel_units
from dalembert.inverse.checks.determinism import non_deterministic_model
from dalembert.inverse.checks.equal_minima import equal_minima
from dalembert.inverse.checks.error_growth import growing_errors
from dalembert.inverse.checks.integrator_bias import integrator_bias
from dalembert.inverse.checks.model_misfit import model_misfit
from dalembert.inverse.checks.noise_estimate import noise_estimate
from dalembert.inverse.checks.record_mistakes import record_mistakes
from dalembert.inverse.checks.residual_correlation import correlated_residuals
from dalembert.inverse.checks.rough_misfit import rough_misfit
from dalembert.inverse.checks.search_end import search_end
from dalembert.inverse.checks.too_few_values import too_few_values
from dalembert.inverse.checks.unconfirmed_minimum import unconfirmed_minimum
from dalembert.inverse.identification.assess import Optimum
from dalembert.inverse.plausibility.suspect_times import time_findings
from dalembert.inverse.validation.explained import percent, record_shares


def model_findings(optimum: Optimum) -> Iterator[Finding]:
    """Yield what the model finds at the identified values, such as elements that lock."""
    yield from findings_at(optimum.posed.whole.model, optimum.vector)


def smoothed_noise(optimum: Optimum) -> Iterator[Finding]:
    """Yield the finding that the noise of the data was estimated by local polynomials; none where it was not."""
    noise = optimum.posed.smooth_noise
    if noise is None or optimum.posed.noise is not None:
        return
    values = dict(zip(optimum.posed.whole.data.channels, map(float, noise), strict=True))
    listed = ", ".join(f"{name!r} {deviation:.3g}" for name, deviation in values.items())
    message = f"The data have no deviations. Their noise was estimated by local polynomials: {listed}."
    yield Finding("smoothed-noise", "note", values, message, "Give deviations if you know them.")


def time_units(optimum: Optimum) -> Iterator[Finding]:
    """Yield the findings on the times of the data, or on those of each experiment."""
    posed = optimum.posed
    joint: Any = posed.whole.model  # of experiments, it has their wiring
    vector = posed.problem.search.vectors(posed.first_point)
    if isinstance(posed.model, Sequence):
        for experiment, wiring in zip(posed.model, joint.wiring, strict=True):
            yield from time_findings(experiment.model, experiment.data, vector[wiring])
    elif posed.data is not None:
        yield from time_findings(posed.model, posed.data, vector)


def unexplained_validation(optimum: Optimum) -> Iterator[Finding]:
    """Yield a finding for each record of which too little is explained, though noise is not the reason."""
    shares = () if optimum.validation is None else optimum.validation.explained
    for record, share in record_shares(shares).items():
        poor = [item for item in shares if item.record == record and item.poor]
        if not poor:
            continue
        worst = min(poor, key=lambda item: item.share)
        what = f"the held-out record {record!r}" if record else "the held-out samples"
        yield Finding(
            "validation-unexplained",
            "warning",
            {"record": record, "channel": worst.channel, "explained": share, "channel_explained": worst.share},
            f"The response explains {percent(share)} of the variation of {what}, "
            f"{percent(worst.share)} in {worst.channel!r}.",
            "The model does not predict this motion. Fit such records too, or look for what the model lacks.",
        )


def parameter_drift(optimum: Optimum) -> Iterator[Finding]:
    """Yield a finding where the halves have different parameters."""
    halves = optimum.causes.halves
    if halves is None or not np.any(halves.drifting):
        return
    items = optimum.problem.model.parameters.items
    worst = int(np.nanargmax(np.abs(halves.differences)))
    name, size = items[worst].name, abs(float(halves.differences[worst]))
    first, second = (f"{value:.4g} {items[worst].unit}".rstrip() for value in halves.values[:, worst])
    also = [repr(item.name) for k, item in enumerate(items) if halves.drifting[k] and k != worst]
    more = f" Also different: {', '.join(also)}." if also else ""
    values = {
        "parameter": name,
        "first": float(halves.values[0, worst]),
        "second": float(halves.values[1, worst]),
        "deviations": size,
    }
    message = (
        f"The two halves of the record have different parameters: {name!r} is {first} in the first and {second} in the "
        f"second half, {size:.3g} standard deviations apart.{more}"
    )
    advice = "Look for what changes with time or amplitude, such as friction or a nonlinear stiffness."
    yield Finding("parameters-drift", "warning", values, message, advice)


Check: TypeAlias = Callable[[Optimum], Iterator[Finding]]

CHECKS: tuple[Check, ...] = (
    smoothed_noise,
    non_deterministic_model,
    too_few_values,
    equal_minima,
    time_units,
    channel_units,
    rough_misfit,
    noise_estimate,
    correlated_residuals,
    record_mistakes,
    model_misfit,
    parameter_drift,
    integrator_bias,
    unexplained_validation,
    growing_errors,
    model_findings,
)
"""Checks of the values, the model and the data."""

OUTCOME: tuple[Check, ...] = (search_end, unconfirmed_minimum)
"""Checks of the search, after the others, whose failed simulations count."""
