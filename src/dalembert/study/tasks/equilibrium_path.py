"""Path of equilibria: equilibria of a mechanism along a load, past limit points."""

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any

from pydantic import Field

from dalembert.errors import InputError, require_known
from dalembert.study.run.duration import Effort, repeatedly
from dalembert.study.run.events import Emit
from dalembert.study.tables.study import Study
from dalembert.study.tasks.requirements import needs_mechanism, unnamed
from dalembert.study.tasks.task import Outcome, ResultTask, silent
from dalembert.study.text.numbers import Number
from dalembert.study.text.table import StudyTable, problem


class LoadRangeTable(StudyTable):
    """Where the path begins and ends; the bounds of the parameter if not given."""

    start: Number | None = Field(None, description="load at the first equilibrium; the lower bound if not given")
    end: Number | None = Field(None, description="load at the last equilibrium; the upper bound if not given")


class EquilibriumPathTable(StudyTable):
    """Follow the equilibria of a mechanism along a load, past limit points, the other parameters at first guesses."""

    over: dict[str, LoadRangeTable] = Field(
        min_length=1,
        max_length=1,
        description="the parameter that is the load: { push = {} } between its bounds, or with start and end",
    )
    channels: list[str] = Field(min_length=1, description="what the report draws over the load: 'AB.end.x'")
    steps: int = Field(20, ge=1, description="number of steps of the first length in the range; later ones adapt")
    most_points: int = Field(500, ge=2, description="where the path ends at the latest")

    def _wrong(self) -> list[str]:
        if len(set(self.channels)) < len(self.channels):
            raise problem("channels are repeated; give each once")
        return []


class EquilibriumPathTask(ResultTask):
    """The task ``[equilibrium_path]``."""

    name = "equilibrium_path"
    kind = "dalembert.multibody:EquilibriumPath"
    rank = 14
    schema = EquilibriumPathTable
    needs = (needs_mechanism,)

    def wrong(self, file: Any) -> list[str]:
        wrong = unnamed(file.equilibrium_path.over, file.parameters, "[equilibrium_path.over]")
        if file.model.forward is not None:
            wrong = [*wrong, "[equilibrium_path] needs a mechanism; a forward model has no bodies"]
        return [*wrong, *super().wrong(file)]

    def plan(self, study: Study) -> str:
        name, unit, start, end = _range(study)
        _path(study, 2, silent)
        most = study.table.most_points
        ends = f"{start:g} to {end:g} {unit}".rstrip()
        return f"follows the equilibria over {name} from {ends}: at most {most} simulations"

    def effort(self, study: Study) -> Effort:
        return Effort(repeatedly(lambda: _path(study, 2, silent)), 2, None, None, "the first two equilibria")

    def unknowns(self, study: Study) -> tuple[str, ...]:
        return ()

    def parts(self, study: Study) -> Iterable[Any]:
        """None: the plan checks all."""
        return ()

    def result(self, study: Study, emit: Emit) -> Any:
        return _path(study, study.table.most_points, emit)

    def outcome(self, study: Study, result: Any) -> Outcome:
        """Outcome of a path, with its critical loads."""
        loads = {f"{point.name} {number}": point.load for number, point in enumerate(result.critical, start=1)}
        return Outcome(study, result, {"values": loads})

    def load(self, study: Study, path: Path) -> Outcome:
        """What a run found; drawings need the model again."""
        outcome = super().load(study, path)
        return replace(outcome, result=replace(outcome.result, build=_build(study)))


def _range(study: Study) -> tuple[str, str, float, float]:
    """Name and unit of the load, and where the path begins and ends."""
    ((name, given),) = study.table.over.items()
    parameter = next(item for item in study.parameters if item.name == name)
    start = parameter.lower if given.start is None else float(given.start)
    end = parameter.upper if given.end is None else float(given.end)
    if start == end:
        raise InputError(f"[equilibrium_path.over], {name}: start and end are both {start:g}. Give two different loads")
    return name, parameter.unit, start, end


def _build(study: Study) -> Any:
    """The mechanism as a function of the load."""
    name, along = _range(study)[0], study.along(_range(study)[0])
    return lambda load: along(**{name: load})


def _path(study: Study, most_points: int, emit: Emit) -> Any:
    from dalembert.multibody import equilibrium_path
    from dalembert.multibody.model.observe import channel_names

    (name, unit, start, end), table, points = _range(study), study.table, 0
    known = channel_names(study.system())
    for channel in table.channels:
        require_known("channel", channel, known, "[equilibrium_path], channels")

    def on_point(load: float, stable: bool) -> None:
        nonlocal points
        points += 1
        emit("balanced", parameter=name, value=load, points=points, stable=stable)

    return equilibrium_path(
        _build(study), start, end, table.steps, most_points, channels=table.channels, parameter=name, unit=unit,
        on_point=on_point,
    )  # fmt: skip
