"""Correlated residuals as variables of a dataset, and back."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

import numpy as np

from dalembert.inverse.correlation.correlated import CorrelatedResiduals, NoiseProcess


def stored_correlated(correlated: CorrelatedResiduals | None) -> dict[str, Any]:
    """Variables over ``parameter`` and ``combination``; none for independent residuals."""
    if correlated is None:
        return {}
    return {
        "plain_deviations": ("parameter", correlated.deviations),
        "plain_correlation": (("parameter", "parameter_"), correlated.correlation),
        "noise_of_combinations": (("combination", "combination_"), correlated.noise),
    }


def told_correlated(correlated: CorrelatedResiduals | None) -> list[dict[str, Any]] | None:
    """What of correlated residuals is no array, for JSON."""
    return None if correlated is None else [asdict(process) for process in correlated.processes]


def correlated_of(
    arrays: Mapping[str, np.ndarray], told: Sequence[Mapping[str, Any]] | None
) -> CorrelatedResiduals | None:
    """The correlated residuals again."""
    if told is None:
        return None
    processes = tuple(NoiseProcess(**item) for item in told)
    names = ("plain_deviations", "plain_correlation", "noise_of_combinations")
    return CorrelatedResiduals(processes, *(arrays[name] for name in names))
