"""All checks of an identification, in the order of their findings."""

from collections.abc import Callable, Iterator
from typing import TypeAlias

from dalembert.findings import Finding
from dalembert.inverse.checks.channel_units import channel_units
from dalembert.inverse.checks.determinism import non_deterministic_model
from dalembert.inverse.checks.equal_minima import equal_minima
from dalembert.inverse.checks.error_growth import growing_errors
from dalembert.inverse.checks.integrator_bias import integrator_bias
from dalembert.inverse.checks.model_findings import model_findings
from dalembert.inverse.checks.model_misfit import model_misfit
from dalembert.inverse.checks.noise_estimate import noise_estimate
from dalembert.inverse.checks.parameter_drift import parameter_drift
from dalembert.inverse.checks.record_mistakes import record_mistakes
from dalembert.inverse.checks.residual_correlation import correlated_residuals
from dalembert.inverse.checks.rough_misfit import rough_misfit
from dalembert.inverse.checks.search_end import search_end
from dalembert.inverse.checks.smoothed_noise import smoothed_noise
from dalembert.inverse.checks.time_units import time_units
from dalembert.inverse.checks.too_few_values import too_few_values
from dalembert.inverse.checks.unconfirmed_minimum import unconfirmed_minimum
from dalembert.inverse.checks.unexplained_validation import unexplained_validation
from dalembert.inverse.identification.assess import Optimum

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
