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
    made: ModelComparison, correlated: Sequence[str], unreliable: Mapping[str, int]
) -> ModelComparison:
    """Return a comparison with its findings; ``unreliable`` counts groups that draws do not predict reliably."""
    found = (
        _ranking(made),
        *_criteria(made),
        *_correlated(made, correlated),
        *_few(made),
        *_unreliable(made, unreliable),
    )
    return replace(made, findings=found)


def alike(made: ModelComparison) -> np.ndarray:
    """Return which models predict no worse than the first one, as far as the data show; shape (models,)."""
    return (np.abs(made.difference) < SMALL) | (np.abs(made.difference) < CLEAR * made.difference_deviation)


def _ranking(made: ModelComparison) -> Finding:
    first, second = made.models[:2]
    difference, deviation = float(-made.difference[1]), float(made.difference_deviation[1])
    values = {"best": first, "second": second, "difference": difference, "deviation": deviation}
    same = alike(made)
    if same[1]:
        names = [name for name, one in zip(made.models, same, strict=True) if one]
        counts = made.parameters[same]
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


def _criteria(made: ModelComparison) -> Iterator[Finding]:
    """Yield a finding where a criterion prefers another model, which predicts worse."""
    if not np.all(np.isfinite(made.bic)):
        return
    chosen = {"AICc": made.aicc, "BIC": made.bic}
    others = {
        name: made.models[int(np.nanargmin(values))]
        for name, values in chosen.items()
        if np.any(np.isfinite(values)) and not alike(made)[int(np.nanargmin(values))]
    }
    if others:
        what = listed([f"{name} prefers {model!r}" for name, model in others.items()])
        message = f"{what}, but it predicts worse."
        advice = "Trust the predictions: criteria take all values for independent."
        yield Finding("criteria-disagree", "warning", dict(others), message, advice)


def _correlated(made: ModelComparison, names: Sequence[str]) -> Iterator[Finding]:
    if not names:
        return
    message = (
        f"The residuals of {listed([repr(name) for name in names])} are correlated. AIC, AICc and BIC take values for "
        "independent, so their differences are too large."
    )
    blocks = made.left_out != "values"
    advice = "" if blocks else "Leave out blocks: leave_out='blocks'."
    values = {"models": ", ".join(names)}
    yield Finding("correlated-comparison", "note" if blocks else "warning", values, message, advice)


def _few(made: ModelComparison) -> Iterator[Finding]:
    count = made.densities.shape[1]
    if count < FEW:
        message = f"Only {counted(count, 'group')} were left out: the standard deviation of a difference is uncertain."
        yield Finding("few-groups", "note", {"groups": count}, message, "Leave out more, smaller groups.")


def _unreliable(made: ModelComparison, counts: Mapping[str, int]) -> Iterator[Finding]:
    if counts:
        group = made.left_out.removesuffix("s")
        what = listed([f"{counted(count, group)} of {name!r}" for name, count in counts.items()])
        message = f"PSIS-LOO does not predict {what} reliably (Pareto shape above 0.7)."
        yield Finding(
            "unreliable-densities", "warning", dict(counts), message, "Compare by cross-validation: cross_validate."
        )
