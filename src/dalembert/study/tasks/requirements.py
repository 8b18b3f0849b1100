"""What several tasks may find wrong in a study file, in sentences."""

from collections.abc import Collection, Iterable, Mapping
from typing import Any

import numpy as np

from dalembert.errors import unknown
from dalembert.study.text.numbers import wrong_units


def needs_solver(file: Any, task: str) -> list[str]:
    """Sentence about a mechanism without a solver."""
    missing = file.model.forward is None and file.solver is None and not file.vibrates
    return ["the table [solver] is missing; expected at least its step"] if missing else []


def needs_mechanism(file: Any, task: str) -> list[str]:
    """Sentence about a model that does not move in time."""
    sentence = f"[{task}] needs a mechanism, and there is a structure; its task is [frequency_response]"
    return [sentence] if file.vibrates else []


def needs_structure(file: Any, task: str) -> list[str]:
    """Sentence about a model that is no structure over frequency."""
    sentence = (
        f"[{task}] needs a structure: [[model.mass]] tables, matrices in [model.structure], or a function that returns "
        "a VibrationSystem"
    )
    return [] if file.vibrates else [sentence]


def needs_robot(file: Any, task: str) -> list[str]:
    """Sentence about a model that is no robot."""
    if file.model.robot_table is not None:
        return []
    return [f"[{task}] needs a robot; name its URDF or MJCF file by [model.robot], file"]


def needs_data(file: Any, task: str) -> list[str]:
    """Sentence about a study without measured data."""
    return [] if file.data else [f"[{task}] needs a [data] table"]


def needs_bands(file: Any, task: str) -> list[str]:
    """Sentence about a study without bands."""
    return [] if file.bands else [f"[{task}] needs a [bands] table"]


def needs_samples(file: Any, task: str) -> list[str]:
    """Sentences about samples and channels of a response: of a mechanism over time, of a structure over frequency."""
    table, forward = getattr(file, task), file.model.forward is not None
    right, other = ("frequencies", "times") if file.vibrates else ("times", "frequencies")
    model = "a structure" if file.vibrates else "a mechanism"
    wrong = []
    for key in (right, "channels"):
        is_stated = getattr(table, key) is not None
        if not forward and not is_stated:
            wrong.append(f"[{task}]: the key {key!r} is missing; {model} needs it")
        if forward and is_stated:
            wrong.append(f"[{task}], {key}: a forward model has its own; leave the key out")
    if getattr(table, other) is not None:
        why = "a forward model has its own" if forward else f"the response of {model} lies along {right}"
        wrong.append(f"[{task}], {other}: {why}; leave the key out")
    return wrong


def response(study: Any) -> Any:
    """The forward model at the samples and channels that the task's table names."""
    table = study.table
    return study.forward(table.channels or (), np.array(table.times or table.frequencies or ()))


def unmatched(stated: Mapping[str, Any] | None, channels: Collection[str], what: str, where: str) -> list[str]:
    """Sentences about channels that have no weight, error or the like, and about those that there are not.

    >>> unmatched({"x": 1.0}, ["x", "y"], "weight", "[identify], weights")
    ["[identify], weights: no weight is given for channel 'y'"]
    """
    if stated is None:
        return []
    missing = [f"{where}: no {what} is given for channel {name!r}" for name in channels if name not in stated]
    return missing + [unknown("channel", name, channels, where) for name in stated if name not in channels]


def unnamed(names: Iterable[str], parameters: Collection[str], where: str) -> list[str]:
    """Sentences about names that no parameter has, or only a fixed one, and about units that are not theirs.

    >>> unnamed(["theta3"], ["theta1", "theta2"], "[sweep.over]")
    ["[sweep.over]: unknown parameter 'theta3'; did you mean 'theta2' or 'theta1'?"]
    """
    tables = parameters if isinstance(parameters, Mapping) else {}
    wrong = []
    if isinstance(names, Mapping):
        wrong += wrong_units(names, {name: table.symbol for name, table in tables.items()}, where)
    names = tuple(names)
    wrong += [unknown("parameter", name, parameters, where) for name in names if name not in parameters]
    return wrong + [
        f"{where}: parameter {name!r} is fixed by equal bounds; leave it out here, or give bounds that differ"
        for name in names
        if name in tables and tables[name].parameter(name).is_fixed
    ]


def needs_parameters(file: Any, task: str) -> list[str]:
    """Sentence about a study without a parameter that its task could vary."""
    if any(not table.parameter(name).is_fixed for name, table in file.parameters.items()):
        return []
    differ = " whose bounds differ" if file.parameters else ""
    return [f"[{task}] needs at least one [parameters.NAME] table{differ}"]
