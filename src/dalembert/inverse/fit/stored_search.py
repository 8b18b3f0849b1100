"""The steps and starts of a search as variables of a dataset, and back."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from dalembert.inverse.events import SearchIteration, StartEnd
from dalembert.optimize import RegularisedStep
from dalembert.stored_fields import Source, Store

NUMBERS = ("mu", "chosen", "agreement", "residual", "length")
CURVES = ("weights", "residual_norms", "step_norms")
COUNTS = ("start", "iteration", "simulations")
OPTIONAL = {"step_gap": "gap", "step_minimised": "minimised"}


class History:
    """Steps as variables over ``step``; their values lie along the dimension ``over``."""

    def __init__(self, over: str) -> None:
        self.over = over

    def store(self, to: Store, settings: dict[str, Any], name: str, value: Sequence[SearchIteration]) -> None:
        size = len(to.coordinates[self.over][1])
        for count in COUNTS:
            to.variables[f"step_{count}"] = ("step", _column(value, count, np.int64))
        to.variables["step_best"] = ("step", _column(value, "best"))
        to.variables["step_values"] = (("step", self.over), _column(value, "values").reshape(-1, size))
        to.variables.update(_stored_steps(value))
        if any(step.gap is not None for step in value):
            to.variables.update({name: ("step", _column(value, attribute)) for name, attribute in OPTIONAL.items()})
        settings["samples"] = value[-1].samples if value else 0

    def load(self, source: Source, settings: Mapping[str, Any], name: str) -> tuple[SearchIteration, ...]:
        a, number = source.arrays, len(source.arrays["step_start"])
        samples = settings.get("samples", len(a["coordinate"]))
        counts = (a[f"step_{count}"].tolist() for count in COUNTS)
        gaps, sums = (map(_finite, a.get(variable, np.full(number, np.nan))) for variable in OPTIONAL)
        columns = zip(*counts, a["step_best"], a["step_values"], _steps_of(a, number), gaps, sums, strict=True)
        return tuple(
            SearchIteration(start, iteration, simulations, float(best), values, samples, how, gap, least, samples)
            for start, iteration, simulations, best, values, how, gap, least in columns
        )


class Starts:
    """Starts as variables over ``start``; their values lie along the dimension ``over``."""

    def __init__(self, over: str) -> None:
        self.over = over

    def store(self, to: Store, settings: dict[str, Any], name: str, value: Sequence[StartEnd]) -> None:
        size = len(to.coordinates[self.over][1])
        for end in ("start", "end"):
            to.variables[f"{end}_values"] = (("start", self.over), _column(value, end).reshape(-1, size))
        to.variables["end_misfit"] = ("start", _column(value, "misfit"))
        to.variables["start_simulations"] = ("start", _column(value, "simulations", np.int64))
        settings["ends"] = [{"success": start.success, "message": start.message} for start in value]

    def load(self, source: Source, settings: Mapping[str, Any], name: str) -> tuple[StartEnd, ...]:
        names = ("start_values", "end_values", "end_misfit", "start_simulations")
        columns = zip(*(source.arrays[column] for column in names), settings["ends"], strict=True)
        return tuple(
            StartEnd(start, end, float(misfit), bool(how["success"]), str(how["message"]), int(simulations))
            for start, end, misfit, simulations, how in columns
        )


def _column(items: Sequence[object], attribute: str, kind: type = float) -> np.ndarray:
    """An attribute of all items, NaN for None."""
    return np.array([getattr(item, attribute) for item in items], dtype=kind)


def _finite(stored: float) -> float | None:
    return float(stored) if np.isfinite(stored) else None


def _stored_steps(history: Sequence[SearchIteration]) -> dict[str, Any]:
    """Variables over ``step``, and ``curve_point`` for the L-curves, NaN where a step has no such account.

    None at all where no step has one.
    """
    accounts = [step.regularised for step in history]
    if not any(accounts):
        return {}
    points = max(len(account.weights) for account in accounts if account)
    numbers = {name: ("step", np.array([getattr(one, name, np.nan) for one in accounts])) for name in NUMBERS}
    trials = np.array([getattr(one, "trials", 0) for one in accounts], dtype=np.int64)
    curves = {
        name: (("step", "curve_point"), np.array([_padded(account, name, points) for account in accounts]))
        for name in CURVES
    }
    return {f"step_{name}": stored for name, stored in (numbers | {"trials": ("step", trials)} | curves).items()}


def _steps_of(arrays: Mapping[str, np.ndarray], number: int) -> Iterator[RegularisedStep | None]:
    """The account of each of a number of steps."""
    for k in range(number):
        if "step_trials" not in arrays or arrays["step_trials"][k] == 0:
            yield None
            continue
        curves = {name: arrays[f"step_{name}"][k] for name in CURVES}
        finite = np.isfinite(curves["weights"])
        yield RegularisedStep(
            **{name: float(arrays[f"step_{name}"][k]) for name in NUMBERS},
            trials=int(arrays["step_trials"][k]),
            **{name: curve[finite] for name, curve in curves.items()},
        )


def _padded(account: RegularisedStep | None, name: str, points: int) -> np.ndarray:
    curve = getattr(account, name, np.empty(0))
    return np.pad(curve, (0, points - len(curve)), constant_values=np.nan)
