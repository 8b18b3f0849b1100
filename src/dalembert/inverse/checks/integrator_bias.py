"""Whether the error of the integrator matters."""

from collections.abc import Iterator

import numpy as np

from dalembert.findings import Finding
from dalembert.inverse.identification.assess import Optimum

LARGE = 0.5
"""Bias, in deviations of the parameter or of the misfit, from which it is a finding."""


def integrator_bias(optimum: Optimum) -> Iterator[Finding]:
    """Yield findings on the error of the integrator. Data that contain the same error were simulated with the same
    steps. They agree better with the response of these steps than with the converged one, beyond the noise, and leave
    white residuals; then the bias is only a note.
    """
    bias, problem, misfit = optimum.integration, optimum.problem, optimum.end.misfit
    if bias is None or optimum.minimum.explained_by == "arithmetic":
        return
    deviations = optimum.estimate.deviations
    white = not optimum.correlation_is_detected and optimum.minimum.noise is None
    if bias.failed:
        message = f"The error of the integrator was not estimated: {bias.how}."
        yield Finding("integration-bias-unknown", "note", {}, message, "Compare with a fit at finer steps.")
        return
    freedom = max(1, problem.compared - len(deviations))
    variance = 1.0 if optimum.noise_is_known else misfit / freedom
    ratios = np.zeros(len(deviations))
    some = np.isfinite(deviations) & (deviations > 0)
    ratios[some] = np.abs(bias.bias[some]) / deviations[some]
    worst = int(np.argmax(ratios))
    change = (bias.corrected - misfit) / max(variance * np.sqrt(2 * freedom), np.finfo(float).tiny)
    if ratios[worst] <= LARGE and abs(change) <= LARGE:
        return
    name, unit = problem.model.parameters.names[worst], problem.model.parameters.items[worst].unit
    values = {
        "parameter": name,
        "bias": float(bias.bias[worst]),
        "deviations": float(ratios[worst]),
        "misfit": bias.misfit,
        "corrected_misfit": bias.corrected,
    }
    size = (
        f"The integrator biases {name!r} by {f'{bias.bias[worst]:.2g} {unit}'.rstrip()}, {ratios[worst]:.2g} times "
        f"its standard deviation (estimated by one simulation {bias.how})."
    )
    # The part of the response's error that no parameters make up is beyond three deviations of the noise.
    if white and bias.corrected > misfit and bias.remainder > 9 * variance:
        yield Finding(
            "integration-bias", "note", values,
            f"{size} The data contain the same error, as data simulated with the same steps do.",
        )  # fmt: skip
        return
    if ratios[worst] <= LARGE:
        values["change"] = float(change)
        yield Finding(
            "integration-bias", "note", values,
            f"The integrator biases no parameter by more than {LARGE:g} standard deviations. A fit with converged "
            f"steps would change the misfit by {change:.2g} of its standard deviations.",
            "Use a smaller step or a tighter tolerance if the misfit matters.",
        )  # fmt: skip
        return
    ratio = np.sqrt(bias.misfit / max(misfit, np.finfo(float).tiny))
    worse = f" With converged steps the same values leave residuals {ratio:.3g} times as large." if ratio > 1.05 else ""
    advice = "Identify again with a smaller step or a tighter tolerance."
    yield Finding("integration-bias", "warning", values, size + worse, advice)
