"""The accounts of regularised steps as variables of a dataset, and back."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from dalembert.inverse.events import Step
from dalembert.optimize import RegularisedStep

NUMBERS = ("mu", "chosen", "agreement", "residual", "length")
CURVES = ("weights", "residual_norms", "step_norms")


def stored_steps(history: Sequence[Step]) -> dict[str, Any]:
    """Variables over ``step``, and ``curve_point`` for the L-curves, NaN where a step has no such account.

    None at all where no step has one.
    """
    accounts = [step.regularised for step in history]
    if not any(accounts):
        return {}
    points = max(len(account.weights) for account in accounts if account)
    numbers = {name: ("step", np.array([_number(account, name) for account in accounts])) for name in NUMBERS}
    trials = np.array([account.trials if account else 0 for account in accounts], dtype=np.int64)
    curves = {
        name: (("step", "curve_point"), np.array([_padded(account, name, points) for account in accounts]))
        for name in CURVES
    }
    return {f"step_{name}": stored for name, stored in (numbers | {"trials": ("step", trials)} | curves).items()}


def steps_of(arrays: Mapping[str, np.ndarray], number: int) -> Iterator[RegularisedStep | None]:
    """The account of each of a number of steps."""
    for k in range(number):
        if "step_trials" not in arrays or arrays["step_trials"][k] == 0:
            yield None
            continue
        curves = {name: arrays[f"step_{name}"][k] for name in CURVES}
        there = np.isfinite(curves["weights"])
        yield RegularisedStep(
            **{name: float(arrays[f"step_{name}"][k]) for name in NUMBERS},
            trials=int(arrays["step_trials"][k]),
            **{name: curve[there] for name, curve in curves.items()},
        )


def _number(account: RegularisedStep | None, name: str) -> float:
    return getattr(account, name) if account else np.nan


def _padded(account: RegularisedStep | None, name: str, points: int) -> np.ndarray:
    curve = getattr(account, name) if account else np.empty(0)
    return np.pad(curve, (0, points - len(curve)), constant_values=np.nan)
