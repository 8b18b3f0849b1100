"""The steps and starts of a search as variables of a dataset, and back."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from dalembert.inverse.events import StartEnd, Step
from dalembert.inverse.fit.stored_steps import steps_of, stored_steps


def stored_search(history: Sequence[Step], starts: Sequence[StartEnd], over: str, size: int) -> dict[str, Any]:
    """Variables over ``step`` and ``start``; the dimension of their values is named ``over``, of the given size."""
    return {
        "step_start": ("step", np.array([step.start for step in history], dtype=np.int64)),
        "step_iteration": ("step", np.array([step.iteration for step in history], dtype=np.int64)),
        "step_simulations": ("step", np.array([step.simulations for step in history], dtype=np.int64)),
        "step_best": ("step", np.array([step.best for step in history], dtype=float)),
        "step_values": (("step", over), np.array([step.values for step in history]).reshape(-1, size)),
        "start_values": (("start", over), np.array([start.start for start in starts]).reshape(-1, size)),
        "end_values": (("start", over), np.array([start.end for start in starts]).reshape(-1, size)),
        "end_fitness": ("start", np.array([start.fitness for start in starts], dtype=float)),
        "start_simulations": ("start", np.array([start.simulations for start in starts], dtype=np.int64)),
        **stored_steps(history),
        **_stored_gaps(history),
    }


def stored_ends(starts: Sequence[StartEnd]) -> list[dict[str, Any]]:
    """What of the starts is no array, for JSON."""
    return [{"success": start.success, "message": start.message} for start in starts]


def search_of(
    arrays: Mapping[str, np.ndarray], ends: Sequence[Mapping[str, Any]], samples: int
) -> tuple[tuple[Step, ...], tuple[StartEnd, ...]]:
    """History and starts of a search over ``samples`` samples."""
    a = arrays
    regularised = steps_of(a, len(a["step_start"]))
    columns = ("step_start", "step_iteration", "step_simulations", "step_best", "step_values")
    gaps = a.get("step_gap", np.full(len(a["step_start"]), np.nan))
    least = a.get("step_minimised", np.full(len(gaps), np.nan))
    history = zip(*(a[column] for column in columns), regularised, gaps, least, strict=True)
    starts = zip(a["start_values"], a["end_values"], a["end_fitness"], ends, a["start_simulations"], strict=True)
    return (
        tuple(
            Step(
                int(start),
                int(iteration),
                int(simulations),
                float(best),
                values,
                samples,
                how,
                _gap(gap),
                _gap(sum_),
                samples,
            )
            for start, iteration, simulations, best, values, how, gap, sum_ in history
        ),
        tuple(
            StartEnd(start, end, float(fitness), bool(how["success"]), str(how["message"]), int(simulations))
            for start, end, fitness, how, simulations in starts
        ),
    )


def _stored_gaps(history: Sequence[Step]) -> dict[str, Any]:
    """Gaps of multiple shooting over ``step``, NaN where a step has none; no variable where none has one."""
    gaps = [step.gap for step in history]
    if all(gap is None for gap in gaps):
        return {}
    sums = [step.minimised for step in history]
    return {
        "step_gap": ("step", np.array([np.nan if gap is None else gap for gap in gaps])),
        "step_minimised": ("step", np.array([np.nan if one is None else one for one in sums])),
    }


def _gap(stored: float) -> float | None:
    return float(stored) if np.isfinite(stored) else None
