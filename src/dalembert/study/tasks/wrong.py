"""What several tasks may find wrong in a study file, in sentences."""

from collections.abc import Collection, Iterable, Mapping
from typing import Any

from dalembert.errors import unknown


def needs_solver(file: Any) -> list[str]:
    """Sentence about a mechanism without a solver."""
    missing = file.model.forward is None and file.solver is None
    return ["the table [solver] is missing; expected at least its step"] if missing else []


def unmatched(given: Mapping[str, Any] | None, channels: Collection[str], what: str, where: str) -> list[str]:
    """Sentences about channels that have no weight, error or the like, and about those that there are not.

    >>> unmatched({"x": 1.0}, ["x", "y"], "weight", "[identify], weights")
    ["[identify], weights: no weight is given for channel 'y'"]
    """
    if given is None:
        return []
    missing = [f"{where}: no {what} is given for channel {name!r}" for name in channels if name not in given]
    return missing + [unknown("channel", name, channels, where) for name in given if name not in channels]


def unnamed(given: Iterable[str], parameters: Collection[str], where: str) -> list[str]:
    """Sentences about names that no parameter has.

    >>> unnamed(["theta3"], ["theta1", "theta2"], "[sweep.over]")
    ["[sweep.over]: unknown parameter 'theta3'; did you mean 'theta2' or 'theta1'?"]
    """
    return [unknown("parameter", name, parameters, where) for name in given if name not in parameters]
