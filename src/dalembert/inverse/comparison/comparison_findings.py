"""What a comparison of models means, as findings."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from dalembert.errors import counted, listed
from dalembert.findings import Finding
from dalembert.inverse.comparison.model_comparison import ModelComparison

SMALL = 4.0  # difference of elpd up to which its standard deviation is not reliable, and the models predict alike
CLEAR = 2.0  # difference of elpd in standard deviations from which one model predicts better
FEW = 10  # fewest groups with which the standard deviation of a difference is reliable


def comparison_findings(
    comparison: ModelComparison, correlated: Sequence[str], unreliable: Mapping[str, int]
) -> ModelComparison:
    """Return a comparison with its findings; ``unreliable`` counts groups that draws do not predict reliably."""
    findings = (
        _ranking(comparison),
        *_criteria(comparison),
        *_correlated(comparison, correlated),
        *_few(comparison),
        *_unreliable(comparison, unreliable),
    )
    return replace(comparison, findings=findings)


def alike(comparison: ModelComparison) -> np.ndarray:
    """Return which models predict no worse than the first one, as far as the data show; shape (models,)."""
    return (np.abs(comparison.difference) < SMALL) | (
        np.abs(comparison.difference) < CLEAR * comparison.difference_deviation
    )


def _ranking(comparison: ModelComparison) -> Finding:
    first, second = comparison.models[:2]
    difference, deviation = float(-comparison.difference[1]), float(comparison.difference_deviation[1])
    values = {"best": first, "second": second, "difference": difference, "deviation": deviation}
    same = alike(comparison)
    if same[1]:
        names = [name for name, is_alike in zip(comparison.models, same, strict=True) if is_alike]
        counts = comparison.parameters[same]
        simplest = names[int(np.argmin(counts))]
        advice = (
            f"Prefer the simplest, {simplest!r}, or measure where their responses differ."
            if np.all(counts >= 0) and len(set(counts.tolist())) > 1
            else "Measure where their responses differ."
        )
        message = (
            f"The data do not distinguish {listed([repr(name) for name in names])}: the log predictive density of "
            f"{first!r} is larger by {difference:.3g} ± {deviation:.3g}, which means nothing."
        )
        return Finding("equal-models", "warning", values, message, advice)
    message = (
        f"{first!r} predicts best: its log predictive density is larger than that of the next, {second!r}, by "
        f"{difference:.3g} ± {deviation:.3g}."
    )
    return Finding("best-model", "note", values, message)


def _criteria(comparison: ModelComparison) -> Iterator[Finding]:
    """Yield a finding where a criterion prefers another model, which predicts worse."""
    if not np.all(np.isfinite(comparison.bic)):
        return
    chosen = {"AICc": comparison.aicc, "BIC": comparison.bic}
    best = {
        name: comparison.models[int(np.nanargmin(values))]
        for name, values in chosen.items()
        if np.any(np.isfinite(values)) and not alike(comparison)[int(np.nanargmin(values))]
    }
    if best:
        what = listed([f"{name} prefers {model!r}" for name, model in best.items()])
        message = f"{what}, but it predicts worse."
        advice = "Trust the predictions: criteria take all values for independent."
        yield Finding("criteria-disagree", "warning", dict(best), message, advice)


def _correlated(comparison: ModelComparison, names: Sequence[str]) -> Iterator[Finding]:
    if not names:
        return
    message = (
        f"The residuals of {listed([repr(name) for name in names])} are correlated. AIC, AICc and BIC take values for "
        "independent, so their differences are too large."
    )
    blocks = comparison.left_out != "values"
    advice = "" if blocks else "Leave out blocks: leave_out='blocks'."
    values = {"models": ", ".join(names)}
    yield Finding("correlated-comparison", "note" if blocks else "warning", values, message, advice)


def _few(comparison: ModelComparison) -> Iterator[Finding]:
    count = comparison.densities.shape[1]
    if count < FEW:
        message = f"Only {counted(count, 'group')} were left out: the standard deviation of a difference is uncertain."
        yield Finding("few-groups", "note", {"groups": count}, message, "Leave out more, smaller groups.")


def _unreliable(comparison: ModelComparison, counts: Mapping[str, int]) -> Iterator[Finding]:
    if counts:
        group = comparison.left_out.removesuffix("s")
        what = listed([f"{counted(count, group)} of {name!r}" for name, count in counts.items()])
        message = f"PSIS-LOO does not predict {what} reliably (Pareto shape above 0.7)."
        yield Finding(
            "unreliable-densities", "warning", dict(counts), message, "Compare by cross-validation: cross_validate."
        )
